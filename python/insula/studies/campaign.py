# SPDX-License-Identifier: GPL-3.0-or-later
"""Carries a plan out: makes what is not finished, and writes table, failures and pictures."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import sys

from insula.studies import planning, plots, table
from insula.studies.engines import Engine
from insula.studies.engines.local import LocalEngine
from insula.studies.planning import Plan
from insula.studies.progress import Progress
from insula.studies.running import Row
from insula.studies.store import Store, repeat, write_failures

SHOWN_FAILURES = 5


@dataclasses.dataclass(frozen=True)
class Options:
    """workers: 0 for all cores. sample: 0 for all runs."""

    engine: str = "local"
    workers: int = 0
    sample: int = 0
    retry: bool = False
    quiet: bool = False
    ray_address: str = ""
    sbatch: tuple[str, ...] = ()


def cores() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _engine(options: Options, store: Store) -> Engine:
    if options.engine == "ray":
        from insula.studies.engines.ray import RayEngine

        return RayEngine(options.workers, options.ray_address)
    if options.engine == "slurm":
        from insula.studies.engines.slurm import SlurmEngine

        return SlurmEngine(options.workers or cores(), store, options.sbatch)
    return LocalEngine(options.workers or cores())


def _say(text: str, options: Options) -> None:
    if not options.quiet:
        print(text, file=sys.stderr)


def _forget_failed(store: Store, plan: Plan) -> None:
    for row in store.rows(plan):
        if row["status"] != "done":
            store.forget(str(row["run"]))


def write_results(store: Store, plan: Plan, options: Options) -> list[Row]:
    """Table, failures and pictures of what is finished. Returns the failed runs."""
    rows = store.rows(plan)
    if not rows:
        return []
    _say("results: %s (%d runs)" % (table.write(store, plan, rows), len(rows)), options)
    for picture in plots.draw(plan, rows, store.folder):
        _say("picture: %s" % picture, options)
    bad = write_failures(store, plan, rows)
    if bad:
        print("%d runs have failed (%s):" % (len(bad), store.folder / "failures.txt"), file=sys.stderr)
        for row in bad[:SHOWN_FAILURES]:
            print("  %s: %s\n    %s" % (row["run"], str(row.get("error", "")).split("\n")[0],
                                        repeat(plan, str(row["run"]))), file=sys.stderr)
    return bad


def carry_out(plan: Plan, folder: str | os.PathLike[str], options: Options = Options()) -> int:
    """Status 0 if all runs are done, 1 if some have failed, 130 if it was broken off."""
    table.needed()
    store = Store(pathlib.Path(folder))
    store.lock()
    try:
        engine = _engine(options, store)
        store.write_plan(plan)
        if options.retry:
            _forget_failed(store, plan)
        wanted = planning.sample(plan.runs, options.sample) if options.sample else plan.runs
        runs = store.open(wanted)
        progress = Progress(len(wanted), len(wanted) - len(runs), options.quiet)
        _say("%d runs, %d of them finished before" % (len(wanted), len(wanted) - len(runs)), options)

        def record(row: Row) -> None:
            if options.engine != "slurm":  # whose tasks write their rows themselves
                store.record(row)
            progress.add(row["status"])

        status = 0
        try:
            engine.run(plan.study, runs, record)
        except KeyboardInterrupt:
            status = 130
        progress.tell(last=True)
        bad = write_results(store, plan, options)
        if status:
            _say("broken off; the same command goes on", options)
        return status or (1 if bad else 0)
    finally:
        store.unlock()
