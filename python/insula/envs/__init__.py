# SPDX-License-Identifier: GPL-3.0-or-later
"""The exercises as environments: Gymnasium (`gymnasium.make("insula/Clipping-v0")`) and PettingZoo (`parallel_env`).

`import insula` registers them where Gymnasium is installed. Each exercise has an environment for both hands, and one
for the right hand, whose left hand follows the exercise's motion: "insula/ClippingRight-v0". So has each case of the
library: "insula/ClippingBasilarTip-v0".
"""

from __future__ import annotations

import gymnasium

from insula.envs.environment import ExerciseEnv
from insula.envs.exercises import EXERCISES, Exercise
from insula.envs.task import Task

__all__ = ["EXERCISES", "Exercise", "ExerciseEnv", "Task", "parallel_env", "register"]

RIGHT = {"hands": ("right",)}


def register() -> None:
    """Registers all environments with Gymnasium, once."""
    for exercise in EXERCISES.values():
        for suffix, options in (("", {}), ("Right", RIGHT)):
            name = "insula/%s%s-v0" % (exercise.name, suffix)
            if name not in gymnasium.registry:
                gymnasium.register(
                    name,
                    entry_point="insula.envs:ExerciseEnv",
                    max_episode_steps=exercise.most_steps,
                    kwargs={"exercise": exercise.name, **options},
                )


def parallel_env(exercise: str, **options):
    """The exercise with an agent for each hand, as a PettingZoo ParallelEnv. `options`: those of ExerciseEnv."""
    from insula.envs.two_agents import TwoHands  # needs PettingZoo

    return TwoHands(exercise, **options)


register()
