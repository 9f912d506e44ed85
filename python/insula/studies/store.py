# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder of a study's results.

    runs/ab/abcdef012345.json   a finished run, written at once or not at all
    plan.pickle                 the plan, for jobs on other machines
    results.parquet             all finished runs of the plan, made anew after each call
    failures.txt                failed runs, each with its reason and the command that repeats it
"""

from __future__ import annotations

import fcntl
import json
import os
import pathlib
import pickle
import shlex
import tempfile
from collections.abc import Iterable

from insula.studies import running
from insula.studies.planning import Plan
from insula.studies.running import Row
from insula.studies.study import RunSpec


class InUse(RuntimeError):
    pass


def write_whole(file: pathlib.Path, data: bytes) -> None:
    """All of it or nothing, whatever happens to this process meanwhile."""
    file.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=file.parent, prefix=".", suffix=".part")
    try:
        with os.fdopen(handle, "wb") as out:
            out.write(data)
        os.chmod(name, 0o644)
        os.replace(name, file)
    except BaseException:
        pathlib.Path(name).unlink(missing_ok=True)
        raise


class Store:
    def __init__(self, folder: pathlib.Path):
        self.folder = folder.resolve()
        self.runs = self.folder / "runs"
        self._lock: int | None = None

    def lock(self) -> None:
        """Raises InUse while another process works in the folder."""
        self.folder.mkdir(parents=True, exist_ok=True)
        lock = os.open(self.folder / ".lock", os.O_CREAT | os.O_RDWR | os.O_CLOEXEC, 0o644)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(lock)
            raise InUse("another study is at work in %s; wait for it, or choose another folder by --out"
                        % self.folder) from None
        self._lock = lock

    def unlock(self) -> None:
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def file(self, run: str) -> pathlib.Path:
        return self.runs / run[:2] / (run + ".json")

    def record(self, row: Row) -> None:
        write_whole(self.file(str(row["run"])), json.dumps(row, default=str).encode())

    def finished(self) -> set[str]:
        return {f.stem for f in self.runs.glob("??/*.json")}

    def forget(self, run: str) -> None:
        self.file(run).unlink(missing_ok=True)

    def read(self, run: str) -> Row | None:
        """None if it is not finished, or if a machine that lost its power left a damaged file."""
        try:
            row = json.loads(self.file(run).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        return row if isinstance(row, dict) and row.get("run") == run else None

    def open(self, runs: Iterable[RunSpec]) -> list[RunSpec]:
        """Those that are not finished."""
        there = self.finished()
        return [r for r in runs if r.id not in there or self.read(r.id) is None]

    def rows(self, plan: Plan) -> list[Row]:
        """Finished runs of the plan, in its order, with its numbers."""
        there, out = self.finished(), []
        for r in plan.runs:
            row = self.read(r.id) if r.id in there else None
            if row is not None:
                # The same run may have had another number and other names of axes in an earlier plan.
                kept = {k: v for k, v in row.items() if k not in ("number", "scene")}
                out.append(running.describe(plan.study, r) | kept)
        return out

    def write_plan(self, plan: Plan) -> pathlib.Path:
        file = self.folder / "plan.pickle"
        write_whole(file, pickle.dumps(plan))
        return file

    def read_plan(self) -> Plan:
        return pickle.loads((self.folder / "plan.pickle").read_bytes())


def repeat(plan: Plan, run: str) -> str:
    """The command that repeats a run alone."""
    return "insula study %s --run %s" % (shlex.quote(str(plan.study.file.resolve())), run)


def write_failures(store: Store, plan: Plan, rows: list[Row]) -> list[Row]:
    """The failed ones. The file is there if and only if there are any."""
    bad = [r for r in rows if r["status"] != "done"]
    file = store.folder / "failures.txt"
    if not bad:
        file.unlink(missing_ok=True)
        return bad
    lines = []
    for r in bad:
        lines += ["run %s: %s" % (r["run"], r.get("error", "")), "    " + repeat(plan, str(r["run"])), ""]
    write_whole(file, "\n".join(lines).encode())
    return bad
