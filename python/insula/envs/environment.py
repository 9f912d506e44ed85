# SPDX-License-Identifier: GPL-3.0-or-later
"""An exercise as an environment of Gymnasium."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np

from insula.envs.hands import ACTIONS
from insula.envs.task import Task


class ExerciseEnv(gymnasium.Env):
    """An exercise whose hands an agent moves.

    exercise: one of insula.envs.EXERCISES.
    hands: those that the agent moves; both together are one action of 16 numbers.
    steps: of the simulation for one action (default: a tenth of a second).
    scene: another scene with the same exercise.
    helper: motion of the exercise that a hand follows which the agent does not move; None: that hand rests.
    pixels: whether the picture is seen too; the observation is then {"state", "picture"}.
    size: height and width of pictures, in pixels.

    An action holds for each hand velocity (3), turning rate (3), and two buttons, from -1 to 1. Tools are exchanged
    with `unwrapped.task.simulation.command`.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(
        self,
        exercise: str,
        hands: tuple[str, ...] = ("left", "right"),
        steps: int = 6,
        scene: str | None = None,
        helper: str | None = "steady",
        render_mode: str | None = None,
        pixels: bool = False,
        size: tuple[int, int] = (120, 160),
    ):
        self.task = Task(exercise, tuple(hands), steps, scene, helper)
        self.render_mode = render_mode
        self.pixels, self.size = pixels, tuple(size)
        state = gymnasium.spaces.Box(-10, 10, (self.task.size(),), np.float32)
        picture = gymnasium.spaces.Box(0, 255, (*self.size, 3), np.uint8)
        self.observation_space = gymnasium.spaces.Dict({"state": state, "picture": picture}) if pixels else state
        self.action_space = gymnasium.spaces.Box(-1, 1, (ACTIONS * len(hands),), np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None):
        super().reset(seed=seed)
        self.task.begin(seed)
        return self._observation(), self.task.info()

    def step(self, action):
        parts = np.split(np.asarray(action, float), len(self.task.hands))
        reward, ended = self.task.act(dict(zip(self.task.hands, parts)))
        return self._observation(), reward, ended, False, self.task.info()

    def render(self):
        return self.task.simulation.picture(*self.size) if self.render_mode == "rgb_array" else None

    def _observation(self):
        state = self.task.observe()
        return {"state": state, "picture": self.task.simulation.picture(*self.size)} if self.pixels else state
