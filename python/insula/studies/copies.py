# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs in copies of this process. A scene with retractors settles for as long as a short run lasts. So this process
settles it once and never steps it, and each run is made by a fork.
"""

from __future__ import annotations

import ctypes
import os
import pathlib
import signal
import sys
from multiprocessing.connection import Connection

from insula.studies import running
from insula.studies.study import RunSpec, Study

PR_SET_PDEATHSIG = 1


def end_with_parent(parent: int) -> None:
    """The kernel ends this process when its parent has died, in whatever step it is."""
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)  # it had died before


def _has_one_thread() -> bool:
    """A fork has no other. Scenes that take factors from the background have one."""
    threads = pathlib.Path("/proc/self/task")
    return threads.is_dir() and len(list(threads.iterdir())) == 1


def perform(study: Study, run: RunSpec) -> running.Row:
    """running.perform in a copy of this process, where one can be made. Ends this process as the copy ends, if that
    gives no row."""
    if not running.stands_settled(study, run) or not _has_one_thread():
        return running.perform(study, run)
    ours, theirs = os.pipe()
    parent = os.getpid()
    copy = os.fork()
    if copy == 0:
        try:
            end_with_parent(parent)
            with Connection(theirs, readable=False) as pipe:
                pipe.send(running.perform(study, run))
        finally:
            os._exit(0)
    os.close(theirs)
    row = None
    with Connection(ours, writable=False) as pipe:
        try:
            row = pipe.recv()
        except EOFError:
            pass
    status = os.waitpid(copy, 0)[1]
    if row is None:
        if os.WIFSIGNALED(status):
            os.kill(parent, os.WTERMSIG(status))
        os._exit(1)
    row["process"] = parent
    return row
