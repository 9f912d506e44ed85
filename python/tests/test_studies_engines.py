# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies on processes, Ray and Slurm: everything is run once, whoever is killed on the way."""

import os
import signal
import subprocess
import sys
import time

import pytest
import slurm_for_test
import study_for_test as st
from insula import studies
from insula.studies import running, table

parquet = pytest.importorskip("pyarrow.parquet")
MANY = st.YOUNG + st.SEEDS % 10  # 30 runs
LONG = "2 s"  # of each run


def start(*more, env=None):
    return subprocess.Popen(st.words(*more), env=env, stderr=subprocess.PIPE, text=True)


def until(true, process=None, seconds=120):
    """Waits for something that happens while the process runs."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "it did not happen"
        assert process is None or process.poll() is None, process.stderr.read()
        time.sleep(0.02)


def check_all(file, out, expected=30):
    """Every run of the plan is there, done, in its order, and with the bits that it has alone."""
    plan = studies.plan(file)
    found = parquet.read_table(out / "results.parquet")
    assert found.column("run").to_pylist() == [r.id for r in plan.runs]
    assert len(plan.runs) == expected
    assert set(found.column("status").to_pylist()) == {"done"}
    assert found.schema.field("block.corotational_fem.young").metadata == {b"unit": b"kPa"}
    assert found.schema.field("block.energy.largest").metadata == {b"unit": b"J"}
    hashes = found.column("state_hash").to_pylist()
    assert len(set(hashes)) == 3  # one for each stiffness, on whatever machine and after whatever run
    assert not (out / "failures.txt").exists()


def test_a_study_is_resumed_and_nothing_runs_twice(tmp_path):
    file, out = st.write(tmp_path, MANY), tmp_path / "out"
    first = st.run(file, "--out", out, "--workers", 2, "--sample", 7)
    assert first.returncode == 0, first.stderr
    before = st.written_at(out)
    assert len(before) == 7 and len(parquet.read_table(out / "results.parquet")) == 7
    second = st.run(file, "--out", out, "--workers", 2)
    assert second.returncode == 0 and "30 runs, 7 of them finished before" in second.stderr
    after = st.written_at(out)
    assert len(after) == 30 and {k: after[k] for k in before} == before
    check_all(file, out)
    third = st.run(file, "--out", out)
    assert third.returncode == 0 and st.written_at(out) == after


def test_a_killed_worker_costs_the_run_that_it_was_at(tmp_path):
    file, out = st.write(tmp_path, MANY, LONG), tmp_path / "out"
    process = start(file, "--out", out, "--workers", 2)
    until(lambda: len(st.rows(out)) >= 4, process)
    before = st.written_at(out)
    killed = st.children(process.pid)
    assert len(killed) == 2
    for worker in killed:
        os.kill(worker, signal.SIGKILL)
    said = process.communicate(timeout=300)[1]
    assert process.returncode == 0, said
    after = st.written_at(out)
    assert {k: after[k] for k in before} == before
    check_all(file, out)


SETTLING = st.SCENE.replace("</scene>", '<settle time="1 s"/></scene>')


def test_a_copy_of_a_worker_has_the_bits_of_a_run_alone(tmp_path):
    file, out = st.write(tmp_path, st.YOUNG + st.SEEDS % 3, scene=SETTLING), tmp_path / "out"
    done = st.run(file, "--out", out, "--workers", 1)
    assert done.returncode == 0, done.stderr
    plan, found = studies.plan(file), st.rows(out)
    assert len({r["process"] for r in found.values()}) == 1
    for run in plan.runs:
        assert found[run.id]["state_hash"] == running.perform(plan.study, run)["state_hash"]


def test_a_killed_copy_costs_the_run_that_it_was_at(tmp_path):
    file, out = st.write(tmp_path, MANY, LONG, scene=SETTLING), tmp_path / "out"
    process = start(file, "--out", out, "--workers", 2)
    killed = []

    def a_copy_of_each():
        killed[:] = [c for w in st.children(process.pid) for c in st.children(w)]
        return len(killed) == 2

    until(a_copy_of_each, process)
    os.kill(killed[0], signal.SIGKILL)
    os.kill(killed[1], signal.SIGSEGV)
    said = process.communicate(timeout=300)[1]
    assert process.returncode == 0, said
    check_all(file, out)
    assert not any(st.alive(c) for c in killed)


def test_a_killed_study_goes_on(tmp_path):
    file, out = st.write(tmp_path, MANY, LONG), tmp_path / "out"
    process = start(file, "--out", out, "--workers", 2)
    until(lambda: len(st.rows(out)) >= 4, process)
    workers = st.children(process.pid)
    process.send_signal(signal.SIGSTOP)
    busy = st.run(file, "--out", out)
    assert busy.returncode == 1 and "another study is at work" in busy.stderr
    process.kill()
    process.wait()
    until(lambda: not any(st.alive(w) for w in workers), seconds=10)
    before = st.written_at(out)
    assert 4 <= len(before) < 30
    again = st.run(file, "--out", out, "--workers", 2)
    assert again.returncode == 0, again.stderr
    after = st.written_at(out)
    assert {k: after[k] for k in before} == before
    check_all(file, out)


def test_ctrl_c_leaves_a_table(tmp_path):
    file, out = st.write(tmp_path, MANY, LONG), tmp_path / "out"
    process = start(file, "--out", out, "--workers", 1)
    until(lambda: len(st.rows(out)) >= 2, process)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 130 and "the same command goes on" in said
    assert 2 <= len(parquet.read_table(out / "results.parquet")) < 30


def test_failed_runs_are_listed_and_can_be_repeated(tmp_path):
    file, out = st.write(tmp_path, duration="60 s", limit="30 ms"), tmp_path / "out"
    done = st.run(file, "--out", out, "--workers", 2)
    assert done.returncode == 1 and "3 runs have failed" in done.stderr
    lines = (out / "failures.txt").read_text().split("\n")
    assert "time limit" in lines[0]
    words = lines[1].split()
    assert words[:2] == ["insula", "study"]
    repeated = st.run(*words[2:])
    assert repeated.returncode == 1 and "time limit" in repeated.stdout
    before = st.written_at(out)
    assert st.run(file, "--out", out).returncode == 1 and st.written_at(out) == before  # a failure is a result
    assert st.run(file, "--out", out, "--retry").returncode == 1
    assert all(st.written_at(out)[k] > before[k] for k in before)
    wrong = st.run(file, "--run", "0" * 12)
    assert wrong.returncode == 2 and "no run" in wrong.stderr


def test_workers_are_kept_at_work(tmp_path):
    """The share of their time in which they are at a run does not depend on how busy the machine is."""
    file, out = st.write(tmp_path, st.YOUNG + st.SEEDS % 20, LONG), tmp_path / "out"
    process = start(file, "--out", out, "--workers", 2)
    until(lambda: len(st.rows(out)) >= 2, process)  # both have started and loaded
    begin, before = time.monotonic(), st.rows(out)
    until(lambda: len(st.rows(out)) >= 50, process)
    rows, span = st.rows(out), time.monotonic() - begin
    process.communicate(timeout=120)
    busy = sum(r["wall"] for k, r in rows.items() if k not in before)
    assert busy / (2 * span) > 0.9


@pytest.mark.skipif(bool(slurm_for_test.missing()), reason=slurm_for_test.missing() or "there is one")
def test_slurm_makes_each_run_once_though_a_task_is_killed(tmp_path):
    file, out = st.write(tmp_path / "study", MANY, LONG), tmp_path / "out"
    with slurm_for_test.slurm(tmp_path / "slurm") as environment:
        process = start(file, "--out", out, "--workers", 2, "--engine", "slurm", env=environment)
        until(lambda: len(st.rows(out)) >= 3, process)
        before = st.written_at(out)
        newest = max(before, key=lambda k: before[k])
        worker = st.rows(out)[newest]["process"]
        task = int(open("/proc/%d/stat" % worker).read().rsplit(")", 1)[1].split()[1])
        os.kill(task, signal.SIGKILL)
        # The process that watches may die too: its jobs go on, and are watched again.
        process.kill()
        process.wait()
        again = st.run(file, "--out", out, "--workers", 2, "--engine", "slurm", env=environment)
        assert again.returncode == 0, again.stderr
        after = st.written_at(out)
        assert {k: after[k] for k in before} == before
        check_all(file, out)
        assert "#SBATCH --array=0-" in (out / "slurm/study.sbatch").read_text()


def test_ray_survives_a_killed_worker_and_a_lost_node(tmp_path):
    pytest.importorskip("ray")
    from ray.cluster_utils import Cluster

    file, out = st.write(tmp_path, MANY, LONG), tmp_path / "out"
    small = {"num_cpus": 1, "object_store_memory": 80_000_000}
    cluster = Cluster(initialize_head=True, head_node_args={**small, "include_dashboard": False})
    try:
        lost = [cluster.add_node(**small) for _ in range(2)][-1]
        cluster.wait_for_nodes()
        process = start(file, "--out", out, "--engine", "ray", "--ray-address", cluster.address)
        until(lambda: len(st.rows(out)) >= 4, process)
        before = st.written_at(out)
        worker = max(st.rows(out).values(), key=lambda r: before[r["run"]])["process"]
        os.kill(worker, signal.SIGKILL)
        cluster.remove_node(lost, allow_graceful=False)
        said = process.communicate(timeout=300)[1]
        assert process.returncode == 0, said
        after = st.written_at(out)
        assert {k: after[k] for k in before} == before
        check_all(file, out)
    finally:
        cluster.shutdown()


@pytest.mark.parametrize("words, what", [
    (["--engine", "slurm"], "sbatch is missing"),
    (["--engine", "ray"], "pip install \"insula[ray]\""),
    (["--ray-address", "auto"], "--ray-address is for --engine ray"),
    (["--workers", "0"], "is not a whole number of at least 1"),
])
def test_what_is_missing_is_said(tmp_path, words, what):
    environment = {**os.environ, "PATH": "/nowhere"}
    if words[-1] == "ray":
        (tmp_path / "ray.py").write_text("raise ImportError('none')")
        environment["PYTHONPATH"] = "%s:%s" % (tmp_path, os.environ.get("PYTHONPATH", ""))
    done = st.run(st.write(tmp_path), "--out", tmp_path / "out", *words, env=environment)
    assert done.returncode in (1, 2) and what in done.stderr, done.stderr


def test_without_pyarrow_nothing_begins(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(RuntimeError, match="insula\\[studies\\]"):
        table.needed()
