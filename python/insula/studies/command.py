# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `insula study`."""

from __future__ import annotations

import argparse
import os
import pathlib
import signal
import sys
from collections.abc import Sequence

from insula.studies import elements, planning, running, store
from insula.studies.campaign import Options, carry_out
from insula.studies.engines import EngineError
from insula.studies.planning import Plan
from insula.studies.tree import StudyError, did_you_mean


def _count(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError('"%s" is not a whole number of at least 1' % text)
    return int(text)


def parser() -> argparse.ArgumentParser:
    p = argparse.ArgumentParser(prog="insula study", description="Sweeps scenes, parameters, motions, rates and seeds.",
                                epilog="Status: 0 all runs are done, 1 some have failed or something is missing, 2 bad "
                                       "input. The same command goes on with a study that was broken off.")
    p.add_argument("file", nargs="?", type=pathlib.Path, help="study file")
    p.add_argument("--engine", choices=("local", "ray", "slurm"), default="local", help="where runs are made")
    p.add_argument("--workers", type=_count, metavar="N",
                   help="runs at the same time (default: the cores of this machine, or of the Ray cluster)")
    p.add_argument("--out", type=pathlib.Path, metavar="DIR", help="folder of results (default: NAME_results)")
    p.add_argument("--sample", type=_count, metavar="N", help="N of the runs, spread evenly over the study")
    p.add_argument("--retry", action="store_true", help="make failed runs again")
    p.add_argument("--run", metavar="ID", help="make this run alone, here, and print its row; nothing is written")
    p.add_argument("--list", action="store_true", help="print the runs and whether they are finished")
    p.add_argument("--elements", action="store_true", help="print what a study file may hold")
    p.add_argument("--quiet", action="store_true", help="no progress")
    p.add_argument("--ray-address", default="", metavar="ADDRESS", help="of a running Ray cluster, or auto")
    p.add_argument("--sbatch", action="append", default=[], metavar="OPTION",
                   help="option of sbatch, as in --sbatch=--partition=long; may be given several times")
    return p


def _list(plan: Plan, folder: pathlib.Path) -> int:
    open_runs = {r.id for r in store.Store(folder).open(plan.runs)}
    try:
        for r in plan.runs:
            row = running.describe(plan.study, r)
            what = ["%s=%s" % (k, v) for k, v in row.items() if k not in ("run", "number", "status") and v is not None]
            print(r.id, "open    " if r.id in open_runs else "finished", *what)
        sys.stdout.flush()
    except BrokenPipeError:  # `| head` has read enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return 0


def _one(plan: Plan, run: str) -> int:
    """A run alone, in this process, so that a debugger sees it."""
    chosen = [r for r in plan.runs if r.id == run]
    if not chosen:
        near = did_you_mean(run, [r.id for r in plan.runs])
        print('error: no run "%s" in %s%s' % (run, plan.study.file, near), file=sys.stderr)
        return 2
    row = running.perform(plan.study, chosen[0])
    for key, value in row.items():
        print("%-28s %s" % (key, value), plan.units.get(key, "") if value is not None else "")
    return 0 if row["status"] == "done" else 1


def _check_options(p: argparse.ArgumentParser, o: argparse.Namespace) -> None:
    if o.ray_address and o.engine != "ray":
        p.error("--ray-address is for --engine ray")
    if o.sbatch and o.engine != "slurm":
        p.error("--sbatch is for --engine slurm")
    if o.run and o.list:
        p.error("--run and --list exclude each other")
    if o.file is None:
        p.error("a study file is needed; the shipped ones are in studies/")


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def main(words: Sequence[str] | None = None) -> int:
    p = parser()
    o = p.parse_args(words)
    if o.elements:
        print(elements.page(), end="")
        return 0
    _check_options(p, o)
    try:
        plan = planning.plan(o.file)
    except StudyError as error:
        print(error, file=sys.stderr)
        return 2
    folder = o.out or pathlib.Path(o.file.stem + "_results")
    if o.list:
        return _list(plan, folder)
    if o.run:
        return _one(plan, o.run)
    signal.signal(signal.SIGTERM, _interrupt)
    options = Options(engine=o.engine, workers=o.workers or 0, sample=o.sample or 0, retry=o.retry, quiet=o.quiet,
                      ray_address=o.ray_address, sbatch=tuple(o.sbatch))
    try:
        return carry_out(plan, folder, options)
    except (EngineError, store.InUse, RuntimeError, OSError) as error:
        print("error: %s" % error, file=sys.stderr)
        return 1
