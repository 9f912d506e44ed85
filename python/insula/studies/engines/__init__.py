# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the runs of a study are made: processes of this machine, a Ray cluster, or jobs of Slurm."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from insula.studies.running import Row
from insula.studies.study import RunSpec, Study

Record = Callable[[Row], None]
ATTEMPTS = 3  # for a run whose worker dies


class Engine(Protocol):
    """Makes each of the runs once, and calls `record` with each row in this process. A worker that dies costs the run
    that it was at, which is made again."""

    def run(self, study: Study, runs: list[RunSpec], record: Record) -> None: ...


class EngineError(RuntimeError):
    """The engine cannot be used, with the reason and what to do."""


def died(attempts: int, how: str) -> str:
    return "the worker %s%s" % (how, " in each of %d attempts" % attempts if attempts > 1 else "")
