# SPDX-License-Identifier: GPL-3.0-or-later
"""One run of a study, in this process. Its result is a row: a dictionary of plain values."""

from __future__ import annotations

import datetime
import os
import platform
import time

from insula import _core
from insula.studies import checking
from insula.studies.measures import Measuring
from insula.studies.random_hands import random_motion
from insula.studies.study import RunSpec, Study

Row = dict[str, object]


class TimeLimit(Exception):
    pass


class _Loaded:
    """The simulation that this process made last."""

    key: object = None
    simulation: _core.Simulation | None = None
    has_run = False


def _load(study: Study, run: RunSpec) -> _core.Simulation:
    key = (str(study.scenes[run.scene]), checking.edits(study, run.at), run.rate)
    if _Loaded.simulation is None or _Loaded.key != key:
        _Loaded.key, _Loaded.simulation, _Loaded.has_run = None, None, False
        _Loaded.simulation = checking.load(study, run.scene, run.at, run.rate)
        _Loaded.key = key
    return _Loaded.simulation


def stands_settled(study: Study, run: RunSpec) -> bool:
    """Whether this process has the run's simulation at its start, after a time of settling. Loads it when needed;
    False if that fails."""
    try:
        simulation = _load(study, run)
    except Exception:  # noqa: BLE001  the run itself tells it
        return False
    return simulation.settle_time > 0 and not _Loaded.has_run


def _at_start(study: Study, run: RunSpec) -> _core.Simulation:
    """A run with the scene and values of the last one resets its simulation, which gives the bits of a new one."""
    s = _load(study, run)
    s.follow(None)
    s.draw_complications(run.seed)
    if _Loaded.has_run:
        s.reset()
    _Loaded.has_run = True
    return s


def _motion(simulation: _core.Simulation, study: Study, run: RunSpec) -> _core.Motion | None:
    if study.hands:
        return random_motion(simulation, run.seed, study.hands)
    motion = study.motions[run.motion]
    return None if motion.kind == "none" else simulation.motion(motion.name)


def _duration(study: Study, motion: _core.Motion | None) -> float:
    if study.duration:
        return study.duration
    if motion is None:
        return 10.0
    return motion.duration + (0.0 if study.hands else 1.0)


def _steps(simulation: _core.Simulation, study: Study, run: RunSpec, row: Row, deadline: float) -> None:
    motion = _motion(simulation, study, run)
    if motion is not None:
        simulation.follow(motion)
    measuring = Measuring(simulation, study.measures)
    duration = _duration(study, motion)
    end = simulation.time + duration - 1e-9 * duration
    until_end = study.until_end and simulation.has_exercise
    try:
        while simulation.time < end:
            simulation.step()
            measuring.step()
            if until_end and simulation.exercise_state != "running":
                break
            if time.monotonic() > deadline:
                raise TimeLimit("took longer than its time limit of %g s (simulated %.2f of %.2f s)"
                                % (study.time_limit, simulation.time, duration))
    finally:
        row.update(simulated=simulation.time, steps=simulation.steps, state_hash="%016x" % simulation.state_hash)
    row.update(measuring.values())


def describe(study: Study, run: RunSpec) -> Row:
    """What a run is, before it has run."""
    motion = study.motions[run.motion]
    row: Row = {"run": run.id, "number": run.number, "status": "", "scene": study.labels[run.scene]}
    row |= {a.name: a.points[k].value for a, k in zip(study.axes, run.at)}
    row |= {"motion": "random" if study.hands else motion.name.rsplit("/", 1)[-1], "rate": run.rate or None,
            "seed": run.seed}
    return row


def _finish(row: Row, wall: float, cpu: float) -> Row:
    now = datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds")
    row.update(wall=time.monotonic() - wall, cpu=time.process_time() - cpu, ended=now, version=_core.version,
               machine=platform.node(), process=os.getpid())
    return row


def failed(study: Study, run: RunSpec, why: str) -> Row:
    """The row of a run that no process could bring to its end."""
    return _finish(describe(study, run) | {"status": "failed", "error": why}, time.monotonic(), time.process_time())


def perform(study: Study, run: RunSpec) -> Row:
    """Runs it. Whatever goes wrong is in the row."""
    wall, cpu = time.monotonic(), time.process_time()
    row = describe(study, run)
    try:
        simulation = _at_start(study, run)
        row.update(scene_hash="%016x" % simulation.scene_hash, rate=1 / simulation.time_step)
        _steps(simulation, study, run, row, wall + study.time_limit)
        row["status"] = "done"
    except Exception as error:  # noqa: BLE001  a run that fails is a result
        row.update(status="failed", error="%s: %s" % (type(error).__name__, error))
        _Loaded.key = None  # nothing is known of its state
    return _finish(row, wall, cpu)
