# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks a study against its scenes: every value of every axis, motions, measures, columns of plots. Nothing runs
before all of it is right.
"""

from __future__ import annotations

import concurrent.futures
import itertools
import math
import os

from insula import _core
from insula.loading import Edit
from insula.studies import measures
from insula.studies.study import Change, Study
from insula.studies.tree import Problems, did_you_mean

MOST_COMBINATIONS = 100  # that are all read before the study begins; of more, one axis after the other is


def edits(study: Study, at: tuple[int, ...]) -> list[Edit]:
    """What a combination of points sets, as the module takes it."""
    changes: list[Change] = [*study.changes]
    for axis, k in zip(study.axes, at):
        changes += axis.points[k].changes
    return [(c.component, c.name, c.value, str(study.file), *c.place) for c in changes]


def step(rate: float) -> float:
    """The time step of a rate, s; 0: the scene's own."""
    return 1 / rate if rate else 0.0


def combinations(study: Study) -> list[tuple[int, ...]]:
    """Points to be read: the first ones, those with another point on one axis, and all if they are few."""
    sizes = [len(a.points) for a in study.axes]
    first = (0,) * len(sizes)
    if math.prod(sizes) <= MOST_COMBINATIONS:
        return list(itertools.product(*(range(n) for n in sizes)))
    return [first] + [first[:i] + (k,) + first[i + 1 :] for i, n in enumerate(sizes) for k in range(1, n)]


def check_scenes(study: Study, problems: Problems) -> dict[tuple[int, tuple[int, ...]], int]:
    """Reads every scene with its changes. Returns the hashes of their files by scene and points."""
    jobs = [(s, at, rate) for s in range(len(study.scenes)) for at in combinations(study) for rate in study.rates]

    def read(job: tuple[int, tuple[int, ...], float]) -> tuple[list[_core.Problem], int]:
        scene, at, rate = job
        return _core.check(str(study.scenes[scene]), [], step(rate), edits(study, at))

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(read, jobs))
    hashes = {}
    for (scene, at, _), (found, value) in zip(jobs, results):
        hashes[scene, at] = value
        problems.found += [p for p in found if p.severity == "error"]
    return hashes


def load(study: Study, scene: int, at: tuple[int, ...], rate: float) -> _core.Simulation:
    """Raises ValueError with all that is wrong."""
    simulation, found = _core.load("", str(study.scenes[scene]), [], 1, step(rate), edits(study, at))
    if simulation is None:
        raise ValueError("\n".join(str(p) for p in found if p.severity == "error"))
    return simulation


def check_motions(simulation: _core.Simulation, study: Study, problems: Problems) -> None:
    for m in study.motions:
        if m.kind == "name" and m.name not in simulation.motions:
            problems.add(m.place, 'name: no motion "%s" in %s%s'
                         % (m.name, simulation.file, did_you_mean(m.name, simulation.motions)))
        if m.kind == "file":
            try:
                _core.Motion.read(m.name)
            except _core.InputError as error:
                problems.add(m.place, "file: %s" % error)


FIXED = ("run", "number", "status", "scene", "motion", "rate", "seed")
MEASURED = ("simulated", "steps", "wall", "cpu")


def check_plots(study: Study, problems: Problems) -> None:
    axes = [a.name for a in study.axes]
    names = [*axes, *FIXED, *MEASURED, *measures.columns(study)]
    for a in study.axes:
        if a.name in (*FIXED, *MEASURED, *measures.columns(study)):
            problems.add(a.place, 'the axis "%s" has the name of another column' % a.name)
    for p in study.plots:
        places = dict(p.places)
        for which, column in (("x", p.x), ("y", p.y), ("group", p.group)):
            if column and column not in names:
                problems.add(places[which], '%s: no column "%s"%s' % (which, column, did_you_mean(column, names)))


def check(study: Study, problems: Problems) -> tuple[dict[tuple[int, tuple[int, ...]], int], dict[str, str]]:
    """All of it. Returns hashes of scenes, and units of measured columns. Raises StudyError."""
    check_plots(study, problems)
    hashes = check_scenes(study, problems)
    problems.end()
    of_columns: dict[str, str] = {}
    for scene in range(len(study.scenes)):
        try:
            simulation = load(study, scene, (0,) * len(study.axes), study.rates[0])
        except ValueError as error:
            problems.add(study.scene_places[scene], "file: %s" % error)
            continue
        measures.check(simulation, study, problems)
        check_motions(simulation, study, problems)
        of_columns |= measures.units(simulation, study)
    problems.end()
    return hashes, of_columns
