# SPDX-License-Identifier: GPL-3.0-or-later
"""A hand that an agent moves by velocities."""

from __future__ import annotations

import numpy as np

from insula import Simulation

SPEED = 0.05  # m/s at an action of 1
TURN = 1.5  # rad/s
LEASH = 0.008  # farthest that the hand is drawn from its tool, m
REACH = 0.09  # farthest from the middle of the field, m
ACTIONS = 8  # velocity and turning rate, scene frame, each of three numbers; two buttons, pressed above 0


def multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The product of two quaternions w x y z."""
    w, v, u, s = a[0], a[1:], b[1:], b[0]
    return np.concatenate(([w * s - v @ u], w * u + s * v + np.cross(v, u)))


def rotation(turn: np.ndarray) -> np.ndarray:
    """The quaternion of a rotation vector, rad."""
    angle = float(np.linalg.norm(turn))
    if angle < 1e-12:
        return np.array([1.0, 0, 0, 0])
    return np.concatenate(([np.cos(angle / 2)], np.sin(angle / 2) / angle * turn))


def axes(orientation: np.ndarray) -> np.ndarray:
    """The three columns of a quaternion's rotation matrix, as rows."""
    w, x, y, z = orientation
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
            [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


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
