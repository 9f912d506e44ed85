# SPDX-License-Identifier: GPL-3.0-or-later
"""A hand that an agent moves by velocities."""

from __future__ import annotations

import numpy as np

from insula import Simulation
from insula.rotations import multiply, rotation

SPEED = 0.05  # m/s at an action of 1
TURN = 1.5  # rad/s
LEASH = 0.008  # farthest that the hand is drawn from its tool, m
REACH = 0.09  # farthest from the middle of the field, m
ACTIONS = 8  # velocity and turning rate, scene frame, each of three numbers; two buttons, pressed above 0


class Hand:
    """Where an agent wants a hand. Its pose stays near its tool, so that the coupling never pulls without bound."""

    def __init__(self, name: str):
        self.name = name
        self.position = np.zeros(3)
        self.orientation = np.array([1.0, 0, 0, 0])
        self.buttons = (False, False)

    def begin(self, simulation: Simulation) -> None:
        """At the present pose of the hand, without buttons."""
        position, orientation = simulation.hand_pose(self.name)
        self.position, self.orientation = np.array(position), np.array(orientation)
        self.buttons = (False, False)

    def move(self, simulation: Simulation, action: np.ndarray, seconds: float, middle: np.ndarray) -> None:
        """Moves the hand by an action for a time, and gives its pose to the coming step."""
        wanted = self.position + SPEED * seconds * action[:3]
        for centre, radius in ((np.array(simulation.tip_pose(self.name)[0]), LEASH), (middle, REACH)):
            away = wanted - centre
            size = np.linalg.norm(away)
            if size > radius:
                wanted = centre + radius / size * away
        self.position = wanted
        turned = multiply(rotation(TURN * seconds * action[3:6]), self.orientation)
        self.orientation = turned / np.linalg.norm(turned)
        self.buttons = (bool(action[6] > 0), bool(action[7] > 0))
        simulation.set_hand(self.name, self.position.tolist(), self.orientation.tolist(), *self.buttons)
