# SPDX-License-Identifier: GPL-3.0-or-later
"""A study as data: what is swept, and what is measured. It can be pickled and sent to workers."""

from __future__ import annotations

import dataclasses
import pathlib

Place = tuple[int, int]


@dataclasses.dataclass(frozen=True)
class Change:
    """A value in place of what the scene says. component: empty for a variable."""

    component: str
    name: str
    value: str
    place: Place = (0, 0)

    @property
    def key(self) -> str:
        return "%s.%s" % (self.component, self.name) if self.component else "$" + self.name


@dataclasses.dataclass(frozen=True)
class Point:
    """A place on an axis. value: a number if all points of the axis are numbers of one unit, else a text."""

    value: float | str
    changes: tuple[Change, ...]


@dataclasses.dataclass(frozen=True)
class Axis:
    name: str
    unit: str
    points: tuple[Point, ...]
    place: Place = (0, 0)


@dataclasses.dataclass(frozen=True)
class Motion:
    """kind: "none", "name" (of the exercise) or "file"."""

    kind: str
    name: str
    place: Place = (0, 0)


@dataclasses.dataclass(frozen=True)
class RandomHands:
    busy: float = 3.0  # s
    rest: float = 1.5  # s
    fastest: float = 0.5  # m/s


@dataclasses.dataclass(frozen=True)
class Measure:
    """kind: channel, goal, fault, metric, body, soundness. `what`: of a body, its value."""

    kind: str
    id: str = ""
    statistic: str = "last"
    hand: str = "both"
    what: str = ""
    index: int = 0
    place: Place = (0, 0)

    @property
    def column(self) -> str:
        if self.kind == "channel":
            return self.id + (".%d" % self.index if self.index else "") + _ending(self.statistic)
        if self.kind == "metric":
            return "metric." + self.id + ("" if self.hand == "both" else "." + self.hand)
        if self.kind == "body":
            return "%s.%s" % (self.id, self.what) + _ending(self.statistic)
        return "%s.%s" % (self.kind, self.id) if self.id else self.kind


def _ending(statistic: str) -> str:
    return "" if statistic == "last" else "." + statistic


@dataclasses.dataclass(frozen=True)
class Plot:
    file: str
    x: str
    y: str
    group: str = ""
    kind: str = "line"
    scale: str = "linear"
    label: str = ""
    places: tuple[tuple[str, Place], ...] = ()


@dataclasses.dataclass(frozen=True)
class Study:
    file: pathlib.Path
    title: str
    scenes: tuple[pathlib.Path, ...]
    changes: tuple[Change, ...] = ()
    axes: tuple[Axis, ...] = ()
    motions: tuple[Motion, ...] = (Motion("none", "none"),)
    hands: RandomHands | None = None
    seeds: tuple[int, ...] = (0,)  # 0: the scene's own
    rates: tuple[float, ...] = (0.0,)  # Hz; 0: the scene's own
    duration: float | None = None  # s
    until_end: bool = False
    time_limit: float = 600.0  # s
    measures: tuple[Measure, ...] = ()
    plots: tuple[Plot, ...] = ()
    scene_places: tuple[Place, ...] = ()

    @property
    def labels(self) -> tuple[str, ...]:
        """A short name for each scene: the file's, or the folder's of a case; both where several have the same."""
        names = [s.parent.name if s.stem == "case" else s.stem for s in self.scenes]
        return tuple(
            n if names.count(n) == 1 else "%s/%s" % (s.parent.name, s.stem) for n, s in zip(names, self.scenes)
        )


@dataclasses.dataclass(frozen=True)
class RunSpec:
    """One run of a study. at: of each axis, the index of its point."""

    id: str
    number: int
    scene: int
    at: tuple[int, ...]
    motion: int
    rate: float
    seed: int
