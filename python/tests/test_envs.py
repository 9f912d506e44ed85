# SPDX-License-Identifier: GPL-3.0-or-later
"""Environments: the checkers of Gymnasium and PettingZoo, rewards, repetition, pictures, several processes."""

import warnings

import insula
import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium")
pytest.importorskip("pettingzoo")
from gymnasium.utils.env_checker import check_env  # noqa: E402
from pettingzoo.test import parallel_api_test  # noqa: E402

from insula import envs  # noqa: E402

NAMES = ["insula/%s%s-v0" % (name, hands) for name in envs.EXERCISES for hands in ("", "Right")]
FOUR = ["insula/%s-v0" % n for n in ("SylvianFissure", "AneurysmDissection", "Clipping", "Rupture")]


@pytest.mark.parametrize("name", [*FOUR, NAMES[1], "insula/ClippingBasilarTip-v0"])
def test_check_env(name):
    env = gymnasium.make(name, render_mode="rgb_array")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        check_env(env.unwrapped)
    assert not [str(w.message) for w in said if "WARN" in str(w.message)]
    assert env.spec.max_episode_steps == 600


def test_the_names_of_the_manual_are_registered():
    assert set(FOUR) < set(NAMES) and set(NAMES) <= set(gymnasium.registry)
    with pytest.raises(KeyError):
        envs.ExerciseEnv("Clippin")
    with pytest.raises(ValueError, match="middle"):
        envs.ExerciseEnv("Clipping", hands=("middle",))


def test_parallel_api():
    env = envs.parallel_env("SylvianFissure")
    env.most_steps = 8
    parallel_api_test(env, num_cycles=20)


def test_two_agents_move_their_own_hands():
    env = envs.parallel_env("SylvianFissure")
    env.reset(seed=1)
    before = {h: np.array(env.task.simulation.hand_pose(h)[0]) for h in env.agents}
    still, along = np.zeros(8), np.array([0, 0, 1, 0, 0, 0, 0, 0.0])
    for _ in range(3):
        env.step({"left": still, "right": along})
    moved = {h: np.array(env.task.simulation.hand_pose(h)[0]) - before[h] for h in env.agents}
    assert np.abs(moved["left"]).max() < 1e-12
    assert moved["right"] == pytest.approx([0, 0, 0.05 * 18 / 60], rel=1e-4)  # 0.05 m/s for 18 steps


def test_the_same_actions_give_the_same():
    env = gymnasium.make("insula/SylvianFissure-v0")
    env.action_space.seed(3)
    actions = [env.action_space.sample() for _ in range(15)]

    def run():
        seen = [env.reset(seed=5)[0]]
        for a in actions:
            o, reward, *_ = env.step(a)
            seen.append(np.append(o, np.float32(reward)))
        return np.concatenate(seen), env.unwrapped.task.simulation.state_hash

    first, second = run(), run()
    assert np.array_equal(first[0], second[0]) and first[1] == second[1]


def test_a_demonstration_is_worth_more_than_rest():
    """The scripted hands reach goals without a fault, and the reward says so."""
    task = envs.Task("SylvianFissure", ("left", "right"), 6, None, None)
    steady = task.simulation.motion("steady")
    still = {h: np.zeros(8) for h in task.hands}

    def run(move, decisions):
        task.begin(None)
        for hand in task.hands.values():
            hand.move = (lambda s, a, t, m, name=hand.name: s.set_hand(name, *steady.at(name, s.time + s.time_step))) \
                if move else (lambda *_: None)
        return sum(task.act(still)[0] for _ in range(decisions)), task.info()

    rest, _ = run(False, 100)
    shown, info = run(True, 250)
    assert rest == pytest.approx(-1, abs=0.5)  # time alone
    assert info["progress"] > 3 and not any(info["faults"].values())
    assert shown > 3


def test_every_case_of_the_library_is_an_environment():
    cases = {n for n, file in insula.scenes().items() if file.name == "case.xml"}
    assert len(cases) >= 11
    assert {e.scene for e in envs.EXERCISES.values() if e.name.startswith("Clipping")} == {*cases, "clipping"}


def test_a_neck_that_needs_two_clips():
    """The hands of the motion alone: the task loads the second clip, and its place becomes the aim."""
    task = envs.Task("ClippingMcaTwoClips", ("right",), 6, None, None)
    steady = task.simulation.motion("steady")
    hand = task.hands["right"]
    hand.move = lambda s, *_: s.set_hand("right", *steady.at("right", s.time + s.time_step))
    assert len(task.clips) == 2
    task.begin(None)
    nearest = [1.0, 1.0]
    while task.simulation.time < steady.duration:
        task.act({"right": np.zeros(8)})
        nearest[task.placed] = min(nearest[task.placed], np.linalg.norm(task.aim("right")))
    assert task.placed == 1
    assert max(nearest) < 0.001
    assert task.info()["goals"]["clip"]


def test_what_an_agent_sees():
    env = gymnasium.make("insula/SylvianFissure-v0").unwrapped
    seen, _ = env.reset(seed=1)
    task = env.task
    parts = {name: seen[at] for name, at in task.layout.items()}
    tip = np.array(task.simulation.tip_pose("right")[0])
    assert parts["right.tip"] * 0.03 + task.middle == pytest.approx(tip, abs=1e-6)
    assert np.linalg.norm(parts["right.axes"].reshape(2, 3), axis=1) == pytest.approx([1, 1], abs=1e-6)
    lines = next(d for d in task.simulation.drawables if d.id == "arachnoid.fibres").data
    middles = (lines[:, :3] + lines[:, 4:7]) / 2
    nearest = np.linalg.norm(middles - tip, axis=1).min()
    assert np.linalg.norm(parts["right.aim"]) * 0.03 == pytest.approx(nearest, rel=1e-4)
    assert len(parts["channels"]) == len(task.simulation.channels.values)


def test_pictures():
    env = gymnasium.make("insula/ClippingRight-v0", pixels=True, size=(60, 80))
    seen, _ = env.reset(seed=1)
    assert env.observation_space.contains(seen)
    assert seen["picture"].shape == (60, 80, 3)
    red = (seen["picture"][..., 0] > 2 * seen["picture"][..., 1].astype(int)).mean()
    assert 0.02 < red < 0.7  # the aneurysm and its vessels are in the picture
    assert len(np.unique(seen["picture"].reshape(-1, 3), axis=0)) > 500


def test_several_processes():
    env = gymnasium.make_vec("insula/SylvianFissureRight-v0", num_envs=2, vectorization_mode="async")
    try:
        seen, _ = env.reset(seed=[1, 1])
        assert seen.shape[0] == 2 and np.array_equal(seen[0], seen[1])
        actions = np.zeros((2, 8), np.float32)
        actions[1, 2] = 1
        for _ in range(5):
            seen, rewards, ended, late, _ = env.step(actions)
        assert not np.array_equal(seen[0], seen[1])
        assert rewards.shape == (2,) and not ended.any() and not late.any()
    finally:
        env.close()


def test_an_end_is_told():
    """A scene whose time is short ends its episode as failed."""
    scene = insula.scenes()["sylvian_fissure"]
    text = scene.read_text(encoding="utf-8").replace('limit="600 s"', 'limit="1 s"')
    short = scene.with_name("short_for_test.xml")
    short.write_text(text, encoding="utf-8")
    try:
        env = gymnasium.make("insula/SylvianFissure-v0", scene=str(short)).unwrapped
    finally:
        short.unlink()
    env.reset()
    ended, rewards = False, []
    while not ended and len(rewards) < 20:
        _, reward, ended, late, info = env.step(np.zeros(16))
        rewards.append(reward)
    assert ended and not late and info["state"] == "failed"
    assert rewards[-1] < -9
