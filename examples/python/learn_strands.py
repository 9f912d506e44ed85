#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Learns to divide the strands of the Sylvian fissure with the right hand, and compares with chance and with a script.

    python learn_strands.py --curve curve.csv [--generations 6] [--population 12] [--workers 2] [--plot curve.svg]

The left hand follows the exercise's motion and holds the lips apart. The policy has seven numbers: the velocity of the
right hand is a gain times the way to the nearest strand, an amplitude (3) times a sine of time, and a constant (3). The
cross-entropy method begins without any skill: it draws the numbers from a normal distribution about zero, and takes
mean and deviation of the best quarter for the next generation. Needs gymnasium; --plot needs matplotlib.
"""

import argparse
import csv
import multiprocessing
import time

import gymnasium
import numpy as np

ENVIRONMENT = "insula/SylvianFissureRight-v0"
PERIOD = 8  # decisions of the oscillation that the policy may use
SPREAD = np.array([2, 0.5, 0.5, 0.5, 0.3, 0.3, 0.3])  # of the first generation: gain, amplitude, constant
_env = None


def environment():
    """The environment of this process."""
    global _env
    if _env is None:
        import insula  # noqa: F401  registers it

        _env = gymnasium.make(ENVIRONMENT).unwrapped
    return _env


def velocity(seen, k, gain, amplitude, constant):
    """An action of the right hand that turns nothing and presses no button."""
    aim = seen[environment().task.layout["right.aim"]]
    wanted = gain * aim + amplitude * np.sin(2 * np.pi * k / PERIOD) + constant
    return np.concatenate((np.clip(wanted, -1, 1), np.zeros(5)))


def numbers(n):
    """The policy with these seven numbers."""
    return lambda seen, k, rng: velocity(seen, k, n[0], n[1:4], n[4:])


def chance(seen, k, rng):
    return rng.uniform(-1, 1, 8)


def script(seen, k, rng):
    """To the nearest strand, with a sweep along the fissure."""
    return velocity(seen, k, 3, np.array([0.5, 0, 0.5]), 0)


POLICIES = {"chance": chance, "script": script}


def episode(job):
    """Reward, share of the strands that are divided, and number of faults of an episode."""
    policy, seed, decisions = job
    act = POLICIES[policy] if isinstance(policy, str) else numbers(policy)
    env, rng, total = environment(), np.random.default_rng(seed), 0.0
    seen, info = env.reset(seed=seed)
    for k in range(decisions):
        seen, reward, ended, _, info = env.step(act(seen, k, rng))
        total += reward
        if ended:
            break
    return total, env.task.simulation.channels["divide.divided"], sum(info["faults"].values())


def learn(pool, options, write):
    """The mean of the last generation."""
    rng = np.random.default_rng(options.seed)
    mean, deviation = np.zeros(len(SPREAD)), SPREAD
    best = max(2, options.population // 4)
    start = time.monotonic()
    for generation in range(options.generations):
        drawn = [mean + deviation * rng.normal(size=len(SPREAD)) for _ in range(options.population)]
        found = np.array(pool.map(episode, [(n, 1, options.decisions) for n in drawn], chunksize=1))
        order = np.argsort(-found[:, 0])[:best]
        elite = np.array([drawn[i] for i in order])
        mean, deviation = elite.mean(axis=0), elite.std(axis=0) + 0.05 * SPREAD
        (at_mean,) = pool.map(episode, [(mean, 1, options.decisions)])
        write(generation + 1, (generation + 1) * (options.population + 1), time.monotonic() - start, found, at_mean)
    return mean


def summary(name, results):
    rewards, divided, faults = np.array(results).T
    print("%-8s reward %6.2f +- %.2f, strands divided %3.0f %%, faults %.1f"
          % (name, rewards.mean(), rewards.std(), 100 * divided.mean(), faults.mean()), flush=True)


def plot(file, rows, baselines):
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    episodes, best, mean = (np.array([float(r[c]) for r in rows]) for c in (1, 3, 5))
    figure, axes = pyplot.subplots(figsize=(6, 3.2))
    axes.plot(episodes, mean, marker="o", label="mean of the distribution")
    axes.plot(episodes, best, marker=".", linestyle=":", label="best of a generation")
    for style, (name, value) in zip(("--", "-."), baselines.items()):
        axes.axhline(value, color="grey", linestyle=style, label=name)
    axes.set_xlabel("episodes of 15 s")
    axes.set_ylabel("reward")
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(file, metadata={"Date": None})


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    options.add_argument("--curve", required=True, help="CSV file that gets the curve")
    options.add_argument("--plot", help="SVG file that gets a picture of it")
    options.add_argument("--generations", type=int, default=6)
    options.add_argument("--population", type=int, default=12)
    options.add_argument("--workers", type=int, default=2)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--chance", type=int, default=8, help="episodes by chance")
    options.add_argument("--decisions", type=int, default=150, help="of an episode, ten a second")
    o = options.parse_args()
    rows = []
    with multiprocessing.get_context("spawn").Pool(o.workers) as pool, open(o.curve, "w", newline="") as f:
        table = csv.writer(f)
        table.writerow(["generation", "episodes", "wall_s", "best", "median", "mean_policy", "mean_divided"])

        def write(generation, episodes, seconds, found, at_mean):
            row = [generation, episodes, "%.0f" % seconds, "%.2f" % found[:, 0].max(), "%.2f" % np.median(found[:, 0])]
            rows.append([*row, "%.2f" % at_mean[0], "%.3f" % at_mean[1]])
            table.writerow(rows[-1])
            f.flush()
            print("generation %d: %s" % (generation, rows[-1]), flush=True)

        by_chance = pool.map(episode, [("chance", seed, o.decisions) for seed in range(o.chance)])
        by_script = pool.map(episode, [("script", 1, o.decisions)])
        learned = pool.map(episode, [(learn(pool, o, write), 1, o.decisions)])
    summary("chance", by_chance)
    summary("script", by_script)
    summary("learned", learned)
    if o.plot:
        plot(o.plot, rows, {"script": by_script[0][0], "chance": np.mean(by_chance, axis=0)[0]})


if __name__ == "__main__":
    main()
