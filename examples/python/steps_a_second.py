#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How many steps a second Python makes of a scene whose hands it moves, and what Python itself costs.

    python steps_a_second.py [--scene sylvian_fissure] [--steps 2400] [--workers 2] [--threads]

Each worker has a simulation of its own, in a process or with --threads in a thread. It sets both hands in each step to
the poses of the exercise's motion, reads the channels and a force, and steps.
"""

import argparse
import multiprocessing
import threading
import time

import insula


def run(scene, steps, ready, results):
    simulation = insula.load(scene)
    motion = simulation.motion(simulation.motions[0])
    hands = [h for h in ("left", "right") if motion.moves(h)]
    values = simulation.channels.values
    simulation.step()
    engine_ms = 0.0
    ready.wait()
    start = time.perf_counter()
    for k in range(steps):
        at = k * simulation.time_step % motion.duration
        if k and at < simulation.time_step:
            simulation.reset()
        for hand in hands:
            position, orientation, button1, button2 = motion.at(hand, at)
            simulation.set_hand(hand, position, orientation, button1, button2)
        simulation.step()
        engine_ms += simulation.step_ms
        values.sum()
        simulation.contact_force("right")
    results.put((time.perf_counter() - start, engine_ms / 1000))


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    options.add_argument("--scene", default="sylvian_fissure")
    options.add_argument("--steps", type=int, default=2400, help="of each worker")
    options.add_argument("--workers", type=int, default=2)
    options.add_argument("--threads", action="store_true", help="threads of one process in place of processes")
    o = options.parse_args()
    kind = threading.Thread if o.threads else multiprocessing.get_context("spawn").Process
    ready = threading.Barrier(o.workers) if o.threads else multiprocessing.get_context("spawn").Barrier(o.workers)
    results = multiprocessing.get_context("spawn").SimpleQueue()
    workers = [kind(target=run, args=(o.scene, o.steps, ready, results)) for _ in range(o.workers)]
    for w in workers:
        w.start()
    found = [results.get() for _ in workers]
    for w in workers:
        w.join()
    longest = max(wall for wall, _ in found)
    engine = sum(e for _, e in found)
    print("%.0f steps a second of %d %s; Python takes %.2f %% of the time"
          % (o.workers * o.steps / longest, o.workers, "threads" if o.threads else "processes",
             100 * (1 - engine / sum(wall for wall, _ in found))))


if __name__ == "__main__":
    main()
