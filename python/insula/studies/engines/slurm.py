# SPDX-License-Identifier: GPL-3.0-or-later
"""Array jobs of Slurm. Each task of the array makes a part of the runs and writes them into the common folder. This
process submits the array and watches the folder. The jobs go on without it, and the same command watches them again.
"""

from __future__ import annotations

import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence

from insula.studies.engines import EngineError, Record
from insula.studies.engines.local import environment
from insula.studies.store import Store, write_whole
from insula.studies.study import RunSpec, Study

POLL = 2.0  # s between two looks
MOST_TASKS = 1000  # of an array; Slurm's MaxArraySize is 1001 unless an administrator has changed it
PARTS = 4  # tasks for each worker, so that none waits long for the last one

SCRIPT = """#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --array=0-{last}%{workers}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --output={folder}/task-%a.log
#SBATCH --open-mode=append
{more}export PYTHONPATH={path}
exec {python} -B -m insula.studies.part {out} {runs} "$SLURM_ARRAY_TASK_ID" {parts}
"""


def _call(*words: str) -> str:
    try:
        done = subprocess.run(words, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise EngineError("%s is missing: this machine has no Slurm (Debian: slurm-client)" % words[0]) from None
    if done.returncode:
        raise EngineError("%s: %s" % (words[0], done.stderr.strip() or "status %d" % done.returncode))
    return done.stdout


def is_in_queue(job: str) -> bool:
    """Whether any task of an array waits or runs."""
    try:
        return bool(_call("squeue", "--noheader", "--jobs", job, "--format", "%T").strip())
    except EngineError as error:
        if "Invalid job id" in str(error):
            return False
        raise


class SlurmEngine:
    """options: more lines for sbatch, such as --partition=long."""

    def __init__(self, workers: int, store: Store, options: Sequence[str] = ()):
        self.workers, self.store, self.options = max(1, workers), store, options
        self.folder = store.folder / "slurm"
        self.job_file = self.folder / "job.json"
        if not shutil.which("sbatch"):
            raise EngineError("sbatch is missing: this machine has no Slurm (Debian: slurm-client)")

    def script(self, study: Study, runs: list[RunSpec]) -> pathlib.Path:
        """Writes the batch script and the list of its runs."""
        ids = self.folder / "runs.txt"
        write_whole(ids, "".join(r.id + "\n" for r in runs).encode())
        parts = min(MOST_TASKS, len(runs), PARTS * self.workers)
        quoted = {"out": self.store.folder, "runs": ids, "path": environment()["PYTHONPATH"], "python": sys.executable}
        text = SCRIPT.format(
            name="insula-" + re.sub(r"[^\w.-]", "_", study.file.stem), last=parts - 1, workers=self.workers,
            folder=str(self.folder).replace("%", "%%"), parts=parts,
            more="".join("#SBATCH %s\n" % o for o in self.options),
            **{k: shlex.quote(str(v)) for k, v in quoted.items()})
        file = self.folder / "study.sbatch"
        write_whole(file, text.encode())
        return file

    def _submit(self, study: Study, runs: list[RunSpec]) -> str:
        job = _call("sbatch", "--parsable", str(self.script(study, runs))).strip().split(";")[0]
        write_whole(self.job_file, json.dumps({"job": job}).encode())
        return job

    def _earlier(self) -> str:
        """The job of an earlier call that is still in the queue, or nothing."""
        try:
            job = str(json.loads(self.job_file.read_text(encoding="utf-8"))["job"])
        except (OSError, ValueError, KeyError):
            return ""
        return job if is_in_queue(job) else ""

    def run(self, study: Study, runs: list[RunSpec], record: Record) -> None:
        open_runs = {r.id: r for r in runs}
        job = self._earlier()
        while open_runs:
            before = len(open_runs)
            if not job:
                job = self._submit(study, list(open_runs.values()))
            self._watch(job, open_runs, record)
            if len(open_runs) == before:
                raise EngineError("the tasks of job %s have ended without a result; their logs are in %s"
                                  % (job, self.folder))
            job = ""

    def _watch(self, job: str, open_runs: dict[str, RunSpec], record: Record) -> None:
        """Until the job has left the queue. What its tasks have written leaves `open_runs`."""
        going = True
        while going and open_runs:
            going = is_in_queue(job)
            for run in self.store.finished() & open_runs.keys():
                row = self.store.read(run)
                if row is not None:
                    del open_runs[run]
                    record(row)
            if going and open_runs:
                time.sleep(POLL)
        while is_in_queue(job):  # tasks that end after their last run
            time.sleep(POLL / 4)
        if os.path.exists(self.job_file):
            self.job_file.unlink()
