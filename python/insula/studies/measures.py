# SPDX-License-Identifier: GPL-3.0-or-later
"""What is measured of a run: channels, goals, faults, metrics, bodies, soundness."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from insula import _core
from insula.studies import soundness
from insula.studies.study import Measure, Study
from insula.studies.tree import Problems, did_you_mean

Value = float | int | bool | None


class _Statistic:
    """Of a number that is read after each step."""

    def __init__(self, read: Callable[[], float], kind: str):
        self.read, self.kind = read, kind
        self.sum, self.count, self.extreme = 0.0, 0, math.nan

    def step(self) -> None:
        if self.kind == "last":
            return
        x = self.read()
        if math.isnan(x):
            return
        self.sum, self.count = self.sum + x, self.count + 1
        choose = min if self.kind == "smallest" else max
        self.extreme = x if math.isnan(self.extreme) else choose(self.extreme, x)

    def value(self) -> float | None:
        x = self.read() if self.kind == "last" else self.extreme
        if self.kind == "mean":
            x = self.sum / self.count if self.count else math.nan
        return None if math.isnan(x) else x


def von_mises(stress: np.ndarray) -> np.ndarray:
    """Of each Cauchy stress, Pa."""
    deviator = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
    return np.sqrt(1.5 * np.einsum("ijk,ijk->i", deviator, deviator))


def _of_channel(simulation: _core.Simulation, name: str, index: int) -> Callable[[], float]:
    view = simulation.channels.view(name)
    return lambda: float(view[index])


def _of_body(body: _core.Body, what: str) -> Callable[[], float]:
    if what == "energy":
        return lambda: float(body.energy)
    if what == "speed":
        return lambda: float(np.linalg.norm(body.velocities, axis=1).max())
    if what == "stress":
        return lambda: float(von_mises(body.stress).max())
    return lambda: float(np.linalg.norm(body.positions - body.rest, axis=1).max())


class Measuring:
    """Measures one run. Call step() after each step, and values() at the end."""

    def __init__(self, simulation: _core.Simulation, measures: tuple[Measure, ...]):
        self.simulation, self.measures = simulation, measures
        self.reached: dict[str, float] = {}
        self.statistics: dict[str, _Statistic] = {}
        for m in measures:
            if m.kind == "channel":
                self.statistics[m.column] = _Statistic(_of_channel(simulation, m.id, m.index), m.statistic)
            if m.kind == "body":
                self.statistics[m.column] = _Statistic(_of_body(simulation.body(m.id), m.what), m.statistic)
        sound = any(m.kind == "soundness" for m in measures)
        self.soundness = soundness.Soundness(simulation) if sound else None
        self.steps = 0

    def step(self) -> None:
        self.steps += 1
        for s in self.statistics.values():
            s.step()
        for e in self.simulation.events:
            if e.kind == "goal":
                self.reached.setdefault(e.id, e.time)
        if self.soundness and self.steps % soundness.EVERY == 0:
            self.soundness.look()

    def values(self) -> dict[str, Value]:
        """By column."""
        s, out = self.simulation, dict[str, Value]()
        kinds = {m.kind for m in self.measures}
        goals = {g.id: g.done for g in s.goals} if "goal" in kinds else {}
        faults = {f.id: f.count for f in s.faults} if "fault" in kinds else {}
        metrics = {(v.id, v.hand): v.value for v in s.metrics()} if "metric" in kinds else {}
        for m in self.measures:
            if m.kind in ("channel", "body"):
                out[m.column] = self.statistics[m.column].value()
            elif m.kind == "goal":
                out[m.column] = goals[m.id]
                out[m.column + ".time"] = self.reached.get(m.id) if goals[m.id] else None
            elif m.kind == "fault":
                out[m.column] = faults[m.id]
            elif m.kind == "metric":
                out[m.column] = metrics[m.id, m.hand]
            elif self.soundness:
                out.update({"soundness." + k: v for k, v in self.soundness.values().items()})
        return out


def units(simulation: _core.Simulation, study: Study) -> dict[str, str]:
    """Of the measured columns, where they have one."""
    infos = {i.id: i.unit for i in simulation.channels.infos}
    metrics = {(v.id, v.hand): v.unit for v in simulation.metrics()} if simulation.has_exercise else {}
    of_body = {"displacement": "m", "speed": "m/s", "energy": "J", "stress": "Pa"}
    out = {}
    for m in study.measures:
        if m.kind == "goal":
            out[m.column + ".time"] = "s"
        elif m.kind == "soundness":
            out.update({"soundness." + k: u for k, u in soundness.UNITS.items()})
        else:
            out[m.column] = {"channel": infos.get(m.id, ""), "body": of_body.get(m.what, ""),
                             "metric": metrics.get((m.id, m.hand), "")}.get(m.kind, "")
    return {k: u for k, u in out.items() if u}


def columns(study: Study) -> list[str]:
    """The measured columns in their order."""
    out: list[str] = []
    for m in study.measures:
        out += ["soundness." + c for c in soundness.COLUMNS] if m.kind == "soundness" else [m.column]
        out += [m.column + ".time"] if m.kind == "goal" else []
    return out


def check(simulation: _core.Simulation, study: Study, problems: Problems) -> None:
    """Reports what the scene does not have."""
    channels = {i.id: i.size for i in simulation.channels.infos}
    exercise = simulation.has_exercise
    known: dict[str, list[str]] = {
        "channel": list(channels),
        "body": [b.id for b in simulation.bodies if b.deformable],
        "goal": [g.id for g in simulation.goals] if exercise else [],
        "fault": [f.id for f in simulation.faults] if exercise else [],
        "metric": list(dict.fromkeys(v.id for v in simulation.metrics())) if exercise else [],
    }
    whose = {(v.id, v.hand) for v in simulation.metrics()} if exercise else set()
    for m in study.measures:
        if m.kind == "soundness" or not m.id:
            continue
        names = known[m.kind]
        if m.id not in names:
            what = "deformable body" if m.kind == "body" else m.kind
            near = did_you_mean(m.id, names) if names else ": the scene has none"
            problems.add(m.place, 'id: no %s "%s" in %s%s' % (what, m.id, simulation.file, near))
        elif m.kind == "channel" and m.index >= channels[m.id]:
            problems.add(m.place, 'place: the channel "%s" has %d numbers, from 0 on' % (m.id, channels[m.id]))
        elif m.kind == "metric" and (m.id, m.hand) not in whose:
            there = ", ".join(sorted(h for i, h in whose if i == m.id))
            problems.add(m.place, 'hand: the metric "%s" is measured of: %s' % (m.id, there))
