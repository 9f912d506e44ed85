# SPDX-License-Identifier: GPL-3.0-or-later
"""An exercise with an agent for each hand, as an environment of PettingZoo."""

from __future__ import annotations

import gymnasium
import numpy as np
import pettingzoo  # type: ignore[import-untyped]

from insula.envs.exercises import EXERCISES
from insula.envs.hands import ACTIONS
from insula.envs.task import Task


class TwoHands(pettingzoo.ParallelEnv):
    """Two agents, "left" and "right", that see the same and share one reward. `steps`, `scene`: as of ExerciseEnv."""

    metadata = {"render_modes": ["rgb_array"], "name": "insula_v0", "is_parallelizable": True}

    def __init__(
        self,
        exercise: str,
        steps: int = 6,
        scene: str | None = None,
        render_mode: str | None = None,
        size: tuple[int, int] = (120, 160),
    ):
        self.task = Task(exercise, ("left", "right"), steps, scene, None)
        self.most_steps = EXERCISES[exercise].most_steps
        self.render_mode, self.size = render_mode, tuple(size)
        self.possible_agents = ["left", "right"]
        self.agents: list[str] = []
        seen = gymnasium.spaces.Box(-10, 10, (self.task.size(),), np.float32)
        self.observation_spaces = {a: seen for a in self.possible_agents}
        self.action_spaces = {
            a: gymnasium.spaces.Box(-1, 1, (ACTIONS,), np.float32) for a in self.possible_agents
        }

    def observation_space(self, agent):
        return self.observation_spaces[agent]

    def action_space(self, agent):
        return self.action_spaces[agent]

    def reset(self, seed=None, options=None):
        self.agents = list(self.possible_agents)
        self.task.begin(seed)
        return self._observations(), {a: self.task.info() for a in self.agents}

    def step(self, actions):
        reward, ended = self.task.act({a: np.asarray(action, float) for a, action in actions.items()})
        late = self.task.decisions >= self.most_steps
        agents = list(self.agents)
        out = (
            self._observations(),
            {a: reward for a in agents},
            {a: ended for a in agents},
            {a: late for a in agents},
            {a: self.task.info() for a in agents},
        )
        if ended or late:
            self.agents = []
        return out

    def render(self):
        return self.task.simulation.picture(*self.size) if self.render_mode == "rgb_array" else None

    def close(self):
        self.agents = []

    def _observations(self):
        seen = self.task.observe()
        return {a: seen.copy() for a in self.agents}
