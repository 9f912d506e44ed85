# SPDX-License-Identifier: GPL-3.0-or-later
"""A real Slurm of this one machine for the time of a test: munged, slurmctld and slurmd of Debian, with all their files
in a folder of the test. It needs root, since slurmd does.
"""

import contextlib
import os
import shutil
import socket
import subprocess
import time

import pytest

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scontrol")
CONFIGURATION = """ClusterName=insula_test
SlurmctldHost={host}
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
SchedulerParameters=sched_interval=1,bf_interval=1
KillWait=1
InactiveLimit=0
NodeName={host} CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP OverSubscribe=FORCE:{cpus}
"""


def missing():
    """Why there is no Slurm here; empty if there is."""
    if os.geteuid() != 0:
        return "slurmd needs root"
    search = os.environ["PATH"] + ":/usr/sbin:/sbin"
    gone = [p for p in PROGRAMS if not shutil.which(p, path=search)]
    return "not installed: %s (Debian: slurmctld slurmd slurm-client munge)" % ", ".join(gone) if gone else ""


def free_port():
    with socket.socket() as s:
        s.bind(("", 0))
        return s.getsockname()[1]


def ready(environment, seconds=60):
    """Waits until the node takes jobs."""
    end, said = time.monotonic() + seconds, ""
    while time.monotonic() < end:
        done = subprocess.run(["sinfo", "--noheader", "--format", "%T"], capture_output=True, text=True,
                              env=environment, check=False)
        said = done.stdout.strip() + done.stderr.strip()
        if said in ("idle", "mixed", "allocated"):
            return
        time.sleep(0.5)
    pytest.fail("no node of Slurm is ready: " + said)


@contextlib.contextmanager
def slurm(folder, cpus=2):
    """The environment in which sbatch and squeue speak with it."""
    if missing():
        pytest.skip(missing())
    for name in ("state", "spool"):
        (folder / name).mkdir(parents=True)
    folder.chmod(0o755)
    key = folder / "munge.key"
    key.write_bytes(os.urandom(64))
    key.chmod(0o600)
    host = socket.gethostname().split(".")[0]
    text = CONFIGURATION.format(folder=folder, host=host, cpus=cpus, controller=free_port(), node=free_port())
    (folder / "slurm.conf").write_text(text)
    environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf"),
                   "PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}
    munge = ["munged", "--foreground", "--force", "--socket", str(folder / "munge.socket"), "--key-file", str(key),
             "--pid-file", str(folder / "munge.pid"), "--log-file", str(folder / "munge.log"),
             "--seed-file", str(folder / "munge.seed")]
    started = []
    try:
        for words in (munge, ["slurmctld", "-D", "-i"], ["slurmd", "-D", "-N", host]):
            started.append(subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL,
                                            stderr=subprocess.DEVNULL))
            if words is munge:
                wait_for(folder / "munge.socket")
        ready(environment)
        yield environment
    finally:
        subprocess.run(["scancel", "--user", "root"], env=environment, check=False, capture_output=True)
        for process in reversed(started):
            process.terminate()
        for process in started:
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()


def wait_for(file, seconds=20):
    end = time.monotonic() + seconds
    while not file.exists():
        if time.monotonic() > end:
            pytest.fail("%s was not made" % file)
        time.sleep(0.1)
