# SPDX-License-Identifier: GPL-3.0-or-later
"""Two hands with random motions around the field of a scene: fast and slow strokes with rotations, buttons, exchanges
of tools, and commands of the tools. At the end both hands draw back along their shafts and rest at home. The same
seed gives the same motion.
"""

from __future__ import annotations

import math
import random

import numpy as np

from insula import _core
from insula.rotations import axes, conjugate, multiply, rotation, rotation_vector
from insula.studies.study import RandomHands

HALF_BOX = 12e-3  # the box of the targets is twice this wide, m
SLOWEST = 0.02  # m/s
SPIN = 6.0  # rad/s
TILT = 0.6  # from the orientation at home, rad
KEY = 0.01  # between two poses, s
HANDS = ("left", "right")


class _Strokes:
    """The way of a hand: strokes of minimum jerk, whose peak is 15/8 of their mean speed, from rest to rest."""

    def __init__(self, motion: _core.Motion, hand: str, position: np.ndarray, orientation: np.ndarray):
        self.motion, self.hand = motion, hand
        self.position, self.orientation = position, orientation
        self.buttons = [False, False]
        self.time = 0.0
        self._key()

    def _key(self) -> None:
        self.motion.add(self.hand, self.time, self.position.tolist(), self.orientation.tolist(), *self.buttons)

    def hold(self, seconds: float) -> None:
        self.time += seconds
        self._key()

    def stroke(self, position: np.ndarray, orientation: np.ndarray, speed: float) -> None:
        way, start = position - self.position, self.position
        turn, first = rotation_vector(multiply(orientation, conjugate(self.orientation))), self.orientation
        length, angle = float(np.linalg.norm(way)), float(np.linalg.norm(turn))
        seconds = max(15 / 8 * length / speed, 15 / 8 * angle / SPIN, 0.02)
        keys = max(2, math.ceil(seconds / KEY))
        for k in range(1, keys + 1):
            x = k / keys
            part = x**3 * (10 - 15 * x + 6 * x * x)
            self.position = start + part * way
            self.orientation = multiply(rotation(part * turn), first)
            self.hold(seconds / keys)


def _direction(draw: random.Random) -> np.ndarray:
    z, a = 2 * draw.random() - 1, 2 * math.pi * draw.random()
    s = math.sqrt(1 - z * z)
    return np.array([s * math.cos(a), s * math.sin(a), z])


def _between(draw: random.Random, low: float, high: float) -> float:
    return low + (high - low) * draw.random()


def _commands(simulation: _core.Simulation, hand: str) -> list[tuple[str, str]]:
    """What the hand may ask for: exchanges, and commands of its tools without a number."""
    tools = simulation.tools(hand)
    clips = [b.id for b in simulation.bodies if b.element == "clip"]
    out = [("exchange", "%s %s" % (hand, tool)) for tool in tools] if len(tools) > 1 else []
    for component, name, _, argument, _, _ in simulation.commands:
        if component in tools and argument in ("", "clip id"):
            words = [component, name]
            out += [("ask", " ".join([*words, c])) for c in clips] if argument else [("ask", " ".join(words))]
    return out


def random_motion(simulation: _core.Simulation, seed: int, settings: RandomHands) -> _core.Motion:
    """The motion of a seed, for a simulation at its start."""
    motion, end = _core.Motion(), 0.0
    middle = np.array(simulation.view[1]) if simulation.view else np.zeros(3)
    last: dict[str, _Strokes] = {}
    for number, hand in enumerate(HANDS):
        if simulation.tool(hand) is None:
            continue
        draw = random.Random(2 * seed + number)
        position, orientation = (np.array(p) for p in simulation.hand_pose(hand))
        w = _Strokes(motion, hand, position, orientation)
        w.hold(_between(draw, 0.1, 0.3))
        while w.time < settings.busy:
            target = middle + HALF_BOX * np.array([_between(draw, -1, 1) for _ in range(3)])
            if draw.random() < 0.2:
                target = (target + position) / 2
            turned = multiply(rotation(_between(draw, 0, TILT) * _direction(draw)), orientation)
            speed = SLOWEST * (settings.fastest / SLOWEST) ** draw.random()  # slow and fast are equally frequent
            w.buttons = [b != (draw.random() < 0.35) for b in w.buttons]
            w.stroke(target, turned, max(speed, 1.5 * float(np.linalg.norm(target - w.position))))
            if draw.random() < 0.4:
                w.hold(_between(draw, 0.1, 0.5))
        w.buttons = [False, False]
        w.hold(0.05)
        # Out along the shaft, since the path in may be around a corner.
        w.stroke(w.position + 40e-3 * axes(w.orientation)[2], w.orientation, 0.15)
        w.stroke(position, orientation, 0.3)
        last[hand], end = w, max(end, w.time)
        possible, time = _commands(simulation, hand), 0.02
        while possible and time < settings.busy:
            motion.add_command(time, *possible[int(draw.random() * len(possible))])
            time += _between(draw, 0.2, 1.5)
    for w in last.values():
        w.hold(end + settings.rest - w.time)
    return motion
