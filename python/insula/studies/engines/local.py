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
    process: subprocess.Popen[bytes]
    pipe: multiprocessing.connection.Connection
    run: RunSpec | None = None
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
        self.run, self.deadline = run, time.monotonic() + limit + GRACE
        try:
            self.pipe.send(run)
        except OSError:
            pass

    def end(self) -> str:
        """Kills it. Returns how it has ended."""
        if self.process.poll() is None and time.monotonic() > self.deadline > 0:
            how = "did not answer"
        else:
            try:
                code = self.process.wait(1)
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
        self._attempts: dict[str, int] = collections.defaultdict(int)

    def run(self, study: Study, runs: list[RunSpec], record: Record) -> None:
        waiting = collections.deque(runs)
        workers: list[_Worker] = []
        try:
            while waiting or any(w.run for w in workers):
                while len(workers) < min(self.workers, len(waiting) + len(workers)):
                    workers.append(_Worker.start(study))
                for w in workers:
                    if w.run is None and waiting:
                        self._attempts[waiting[0].id] += 1
                        w.give(waiting.popleft(), study.time_limit)
                self._hear(study, workers, waiting, record)
        finally:
            for w in workers:
                w.end()

    def _hear(self, study: Study, workers: list[_Worker], waiting: collections.deque[RunSpec], record: Record) -> None:
        busy = {w.pipe: w for w in workers if w.run}
        ready = multiprocessing.connection.wait(list(busy), timeout=1.0)
        late = [w for w in busy.values() if time.monotonic() > w.deadline]
        for w in [busy[p] for p in ready] + late:  # type: ignore[index]
            run, w_row = w.run, None
            if run is None:
                continue  # it has answered at the last moment
            if w not in late:
                try:
                    w_row = w.pipe.recv()
                except (EOFError, OSError):
                    pass
            w.run = None
            if w_row is not None:
                record(w_row)
                continue
            workers.remove(w)
            how = w.end()
            if self._attempts[run.id] < ATTEMPTS and w not in late:
                waiting.appendleft(run)
            else:
                record(running.failed(study, run, died(self._attempts[run.id], how)))
