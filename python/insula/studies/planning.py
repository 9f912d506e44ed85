# SPDX-License-Identifier: GPL-3.0-or-later
"""The plan: all runs of a study in a fixed order. A run's id is a hash of everything that its result depends on, so the
same run has the same id in every plan, and a changed scene gives another one.
"""

from __future__ import annotations

import dataclasses
import hashlib
import itertools
import json
import pathlib

from insula import _core
from insula.studies import checking, reading
from insula.studies.study import RunSpec, Study
from insula.studies.tree import StudyError


@dataclasses.dataclass(frozen=True)
class Plan:
    study: Study
    runs: tuple[RunSpec, ...]
    units: dict[str, str]  # of the columns that have one


def _hash(*parts: object) -> str:
    return hashlib.sha256(json.dumps(parts, sort_keys=True, default=str).encode()).hexdigest()


def _motion_hashes(study: Study) -> list[str]:
    """A named motion is a file of the scene, which the scene's hash covers."""
    return [_hash(m.kind, pathlib.Path(m.name).read_text(encoding="utf-8")) if m.kind == "file"
            else _hash(m.kind, m.name) for m in study.motions]


def make(study: Study, hashes: dict[tuple[int, tuple[int, ...]], int], units: dict[str, str]) -> Plan:
    """All runs: scenes, axes and rates change slowest, so that a worker seldom loads another scene."""
    first, runs = (0,) * len(study.axes), list[RunSpec]()
    motions = _motion_hashes(study)
    measured = [dataclasses.replace(m, place=(0, 0)) for m in study.measures]
    common = _hash(_core.version, study.duration, study.until_end, study.hands, [str(m) for m in measured])
    places = itertools.product(range(len(study.scenes)), *(range(len(a.points)) for a in study.axes))
    for scene, *points in places:
        at = tuple(points)
        # The files that each point leads to.
        files = [hashes[scene, first[:i] + (k,) + first[i + 1 :]] for i, k in enumerate(at)] or [hashes[scene, first]]
        changes = [(c[0], c[1], c[2]) for c in checking.edits(study, at)]
        there = _hash(common, files, changes)
        for rate, motion, seed in itertools.product(study.rates, range(len(motions)), study.seeds):
            run = _hash(there, rate, motions[motion], seed)[:12]
            runs.append(RunSpec(run, len(runs), scene, at, motion, rate, seed))
    columns = {a.name: a.unit for a in study.axes if a.unit} | units | dict(checking_units())
    return Plan(study, tuple(runs), columns)


def checking_units() -> tuple[tuple[str, str], ...]:
    return (("rate", "Hz"), ("simulated", "s"), ("wall", "s"), ("cpu", "s"))


def absolute(study: Study) -> Study:
    """With paths that hold in every folder and on every machine that shares the files."""
    motions = tuple(dataclasses.replace(m, name=str(pathlib.Path(m.name).resolve())) if m.kind == "file" else m
                    for m in study.motions)
    return dataclasses.replace(study, scenes=tuple(s.resolve() for s in study.scenes), motions=motions)


def plan(file: str | pathlib.Path) -> Plan:
    """Reads, checks and plans a study. Raises StudyError with all that is wrong."""
    study, problems = reading.read(file)
    if study is None or not study.scenes:
        problems.end()
        raise StudyError(problems.found)
    hashes, units = checking.check(study, problems)
    made = make(study, hashes, units)
    return dataclasses.replace(made, study=absolute(study))


def sample(runs: tuple[RunSpec, ...], count: int) -> tuple[RunSpec, ...]:
    """`count` of the runs, spread evenly over all of them."""
    if count >= len(runs):
        return runs
    return tuple(runs[k * len(runs) // count] for k in range(count))
