# SPDX-License-Identifier: GPL-3.0-or-later
"""An exercise as a task for agents: what they see, what they get, and when it ends."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

import insula
from insula import Motion
from insula.envs.exercises import EXERCISES, Exercise
from insula.envs.hands import Hand
from insula.rotations import axes

FIELD = 0.03  # m: lengths are seen in this unit
FORCE = 0.1  # N
# What one unit of a channel without a range is seen as, by SI unit.
SCALES = {"N": 0.1, "Pa": 13332.0, "m": 0.01, "m3/s": 1e-6, "m3": 1e-5, "s": 10.0, "Hz": 1000.0}
GOAL, FAULT, FAILED, TIME = 10.0, -1.0, -10.0, -0.01
CLIP_HAND = "right"  # which holds the applier


@dataclass(frozen=True)
class Clip:
    """A clip that a motion places. load: what the scrub nurse is asked; place: of the hand that lets it go, m."""

    load: str
    place: np.ndarray


def clips_of(motion: Motion, step: float = 0.05) -> list[Clip]:
    """The clips of a motion, in order: each load with the pose at which button 2 lets it go."""
    loads = [(t, argument) for t, verb, argument in motion.commands if verb == "ask" and " load " in argument]
    clips = []
    for (begins, load), ends in zip(loads, [t for t, _ in loads[1:]] + [motion.duration]):
        for t in np.arange(begins, ends, step):
            position, _, _, lets_go = motion.at(CLIP_HAND, float(t))
            if lets_go:
                clips.append(Clip(load, np.array(position)))
                break
    return clips


class Task:
    """A simulation of an exercise with one or two hands that agents move, for Gymnasium and PettingZoo alike."""

    def __init__(self, exercise: str, hands: tuple[str, ...], steps: int, scene: str | None, helper: str | None):
        if not hands or set(hands) - {"left", "right"}:
            raise ValueError('hands: "left", "right" or both, not %s' % (hands,))
        self.exercise: Exercise = EXERCISES[exercise]
        self.simulation = insula.load(scene or self.exercise.scene)
        self.hands = {name: Hand(name) for name in hands}
        self.steps = steps
        self.middle = np.array(self.simulation.view[1] if self.simulation.view else (0, 0, 0))
        steady = self.simulation.motion("steady") if "steady" in self.simulation.motions else None
        self.clips = clips_of(steady)[self.exercise.clip - 1 :] if steady and self.exercise.clip else []
        self.placed = 0
        others = {"left", "right"} - set(hands)
        self.helper = self.simulation.motion(helper) if helper and others else None
        self.helped = sorted(h for h in others if self.helper and self.helper.moves(h))
        self._drawables = [d for d in self.simulation.drawables if d.id in self.exercise.lines]
        self._low, self._scale = self._channel_scales()
        self.layout = self._layout()
        self.decisions = 0
        self._goals: dict[str, bool] = {}
        self._faults: dict[str, int] = {}
        self._promise = 0.0

    def begin(self, seed: int | None) -> None:
        """Returns to the start. A seed draws the complications anew."""
        s = self.simulation
        if seed is not None:
            s.draw_complications(seed)
        if s.steps > 0:  # a scene that was just loaded is at its start
            s.reset()
        self.decisions, self.placed = 0, 0
        if self.clips:
            s.command("ask", self.clips[0].load)
        for verb, argument in self.exercise.commands:
            s.command(verb, argument)
        for hand in self.hands.values():
            hand.begin(s)
        s.step()
        self._goals = {g.id: g.done for g in s.goals}
        self._faults = {f.id: f.count for f in s.faults}
        self._promise = self.promise()

    def act(self, actions: Mapping[str, np.ndarray]) -> tuple[float, bool]:
        """Some steps with these actions of the hands. Returns the reward and whether the exercise has ended."""
        s = self.simulation
        for _ in range(self.steps):
            for name, action in actions.items():
                self.hands[name].move(s, np.clip(action, -1, 1), s.time_step, self.middle)
            if self.helper:
                for name in self.helped:
                    s.set_hand(name, *self.helper.at(name, s.time + s.time_step))
            s.step()
        self._next_clip()
        self.decisions += 1
        return self._reward(), s.exercise_state != "running"

    def _next_clip(self) -> None:
        """A neck that needs several clips: the next one is loaded once one was let go and the applier is drawn out."""
        if self.placed + 1 < len(self.clips) and self.simulation.channels["clip.applications"] > self.placed:
            with contextlib.suppress(insula.CommandRefused):  # while the applier is in the field
                self.simulation.command("ask", self.clips[self.placed + 1].load)
                self.placed += 1

    def _reward(self) -> float:
        s, reward = self.simulation, TIME
        goals, faults, promise = {g.id: g.done for g in s.goals}, {f.id: f.count for f in s.faults}, self.promise()
        reward += GOAL * (sum(goals.values()) - sum(self._goals.values()))
        reward += FAULT * (sum(faults.values()) - sum(self._faults.values()))
        reward += promise - self._promise
        if s.exercise_state == "failed":
            reward += FAILED
        self._goals, self._faults, self._promise = goals, faults, promise
        return float(reward)

    def promise(self) -> float:
        """How far the exercise has come, and how near the hands are to what is next. Its change is a reward."""
        nearest = [float(np.linalg.norm(self.aim(h))) for h in self.hands if self.has_aim(h)]
        return self.exercise.progress(self.simulation.channels) - min(nearest, default=0.0) / FIELD

    def has_aim(self, hand: str) -> bool:
        return (hand == CLIP_HAND and bool(self.clips)) or bool(self._drawables)

    def aim(self, hand: str) -> np.ndarray:
        """From the tip of the hand's tool to what is next, m: the place of the clip, or the middle of the nearest line
        that stands. Zero when nothing is left."""
        tip = np.array(self.simulation.tip_pose(hand)[0])
        if hand == CLIP_HAND and self.clips:
            return self.clips[self.placed].place - tip
        lines = [d.data for d in self._drawables]
        middles = [(a[:, :3] + a[:, 4:7])[a[:, 3] >= 0] / 2 for a in lines if a.shape[1] == 8]
        away = np.concatenate([np.zeros((0, 3)), *middles]) - tip
        if len(away) == 0:
            return np.zeros(3)
        return away[np.argmin((away * away).sum(axis=1))].astype(float)

    def _channel_scales(self) -> tuple[np.ndarray, np.ndarray]:
        low: list[float] = []
        scale: list[float] = []
        for i in self.simulation.channels.infos:
            if i.low is not None and i.high is not None and i.high > i.low:
                low += i.size * [i.low]
                scale += i.size * [i.high - i.low]
            else:
                low += i.size * [0.0]
                scale += i.size * [SCALES.get(i.unit, 1.0)]
        return np.array(low), np.array(scale)

    def _layout(self) -> dict[str, slice]:
        """Where each part of what agents see begins and ends."""
        parts, at = {}, 0
        sizes = [("%s.%s" % (h, p), n) for h in self.hands for p, n in Task.OF_HAND]
        for name, size in [*sizes, ("goals", len(self.simulation.goals)), ("time", 1), ("channels", len(self._low))]:
            parts[name] = slice(at, at + size)
            at += size
        return parts

    # Of each hand: tip from the middle of the field, x and z axes of the tool, hand from its tip, force and torque on
    # the hand, contact force, buttons, way to what is next.
    OF_HAND = (("tip", 3), ("axes", 6), ("lead", 3), ("force", 6), ("contact", 1), ("buttons", 2), ("aim", 3))

    def size(self) -> int:
        return self.layout["channels"].stop

    def observe(self) -> np.ndarray:
        """What agents see: numbers of the order of 1, between -10 and 10; 0 for what is not known."""
        s, parts = self.simulation, []
        for name, hand in self.hands.items():
            tip, orientation = s.tip_pose(name)
            x, _, z = axes(np.array(orientation))
            aim = self.aim(name) if self.has_aim(name) else np.zeros(3)
            force = s.hand_force(name) / FORCE
            force[3:] *= 100  # torques, in mN m
            parts += [(np.array(tip) - self.middle) / FIELD, x, z, (hand.position - tip) / 0.01, force]
            parts += [[s.contact_force(name) / FORCE], np.array(hand.buttons, float), aim / FIELD]
        parts += [[float(g.done) for g in s.goals], [s.time / 60], (s.channels.values - self._low) / self._scale]
        seen = np.concatenate([np.asarray(p, float).ravel() for p in parts])
        return np.clip(np.nan_to_num(seen, nan=0.0), -10, 10).astype(np.float32)

    def info(self) -> dict:
        s = self.simulation
        return {
            "time": s.time,
            "state": s.exercise_state,
            "goals": {g.id: g.done for g in s.goals},
            "faults": {f.id: f.count for f in s.faults},
            "progress": self.exercise.progress(s.channels),
        }
