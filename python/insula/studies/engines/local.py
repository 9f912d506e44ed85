# SPDX-License-Identifier: GPL-3.0-or-later
"""Processes of this machine. Each worker makes one run after the other, and is replaced when it dies."""

from __future__ import annotations

import collections
import dataclasses
import multiprocessing.connection
import os
import pathlib
import signal
import subprocess
import sys
import time

import insula
from insula.studies import running
from insula.studies.engines import ATTEMPTS, Record, died
from insula.studies.study import RunSpec, Study

GRACE = 60.0  # s beyond its time limit, after which a worker that does not end its run is killed


def environment() -> dict[str, str]:
    """For a Python that imports this very package. The engine has one thread in each worker."""
    package = str(pathlib.Path(insula.__file__).resolve().parent.parent)
    built = str(pathlib.Path(insula.__file__).parent.parent)
    before = os.environ.get("PYTHONPATH", "")
    path = os.pathsep.join(dict.fromkeys(p for p in (built, package, *before.split(os.pathsep)) if p))
    return {**os.environ, "PYTHONPATH": path, "OMP_NUM_THREADS": "1"}


@dataclasses.dataclass
class _Worker:
    """runs: the one that it is at, and one more, so that it does not wait for this process."""

    process: subprocess.Popen[bytes]
    pipe: multiprocessing.connection.Connection
    runs: collections.deque[RunSpec] = dataclasses.field(default_factory=collections.deque)
    deadline: float = 0.0

    @staticmethod
    def start(study: Study) -> _Worker:
        ours, theirs = multiprocessing.Pipe()
        with theirs:
            words = [sys.executable, "-B", "-m", "insula.studies.worker", str(theirs.fileno())]
            process = subprocess.Popen(words, pass_fds=[theirs.fileno()], env=environment(), stdin=subprocess.DEVNULL)
        try:
            ours.send(study)
        except OSError:
            pass  # it has ended already; its end is found with its first run
        return _Worker(process, ours)

    def give(self, run: RunSpec, limit: float) -> None:
        if not self.runs:
            self.deadline = time.monotonic() + limit + GRACE
        self.runs.append(run)
        try:
            self.pipe.send(run)
        except OSError:
            pass

    def hear(self, limit: float) -> running.Row | None:
        """The row of the run that it was at; None if it has died."""
        try:
            row = self.pipe.recv()
        except (EOFError, OSError):
            return None
        self.runs.popleft()
        self.deadline = time.monotonic() + limit + GRACE
        return row

    def is_late(self) -> bool:
        return bool(self.runs) and time.monotonic() > self.deadline

    def end(self) -> str:
        """Kills it. Returns how it has ended."""
        how = "did not answer"
        if not self.is_late():
            try:
                code = self.process.wait(1 if self.runs else 0)
                how = "was ended by " + signal.Signals(-code).name if code < 0 else "ended with status %d" % code
            except subprocess.TimeoutExpired:
                how = "was lost"
        self.process.kill()
        self.process.wait()
        self.pipe.close()
        return how


class LocalEngine:
    def __init__(self, workers: int):
        self.workers = workers
        self._lost: dict[str, int] = collections.defaultdict(int)

    def run(self, study: Study, runs: list[RunSpec], record: Record) -> None:
        waiting = collections.deque(runs)
        workers: list[_Worker] = []
        try:
            while waiting or any(w.runs for w in workers):
                while len(workers) < min(self.workers, len(waiting) + len(workers)):
                    workers.append(_Worker.start(study))
                self._give(study, workers, waiting)
                self._hear(study, workers, waiting, record)
        finally:
            for w in workers:
                w.runs.clear()
                w.process.kill()
                w.end()

    def _give(self, study: Study, workers: list[_Worker], waiting: collections.deque[RunSpec]) -> None:
        """A second run only while there is one for each worker: the last runs go to whoever is free."""
        for ahead in range(2):
            for w in workers:
                if len(w.runs) == ahead and len(waiting) > (len(workers) if ahead else 0):
                    w.give(waiting.popleft(), study.time_limit)

    def _hear(self, study: Study, workers: list[_Worker], waiting: collections.deque[RunSpec], record: Record) -> None:
        ready = multiprocessing.connection.wait([w.pipe for w in workers if w.runs], timeout=1.0)
        for w in [w for w in workers if w.pipe in ready or w.is_late()]:
            row = w.hear(study.time_limit) if w.pipe in ready else None
            if row is not None:
                record(row)
                continue
            workers.remove(w)
            late, how = w.is_late(), w.end()
            run, *others = w.runs
            waiting.extendleft(reversed(others))
            self._lost[run.id] += 1
            if self._lost[run.id] < ATTEMPTS and not late:
                waiting.appendleft(run)
            else:
                record(running.failed(study, run, died(self._lost[run.id], how)))
