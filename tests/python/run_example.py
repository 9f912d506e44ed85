#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs examples/python/*.py in a virtual environment of its own against a real engine and haptic server
on a bus of their own, and checks what it prints.

    run_example.py SOURCE_FOLDER BUILD_FOLDER LCM_GEN
"""
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile

from packages import environment, skip

SCENE = """<scene title="Two hands">
  <soft_body id="block" mesh="meshes/examples/block.msh" mesh_unit="mm">
    <corotational_fem/>
    <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/>
    <surface/>
  </soft_body>
  <retractor id="left_spatula" model="meshes/instruments/retractor/retractor.urdf" hand="left"
             home="-5 0 3 mm" shaft="0 0 1" flat="1 0 0"/>
  <dissector id="left_dissector" model="meshes/instruments/dissector/dissector.urdf" hand="left"
             home="-5 0 3 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="right_spatula" model="meshes/instruments/retractor/retractor.urdf" hand="right"
             home="5 0 3 mm" shaft="0 0 1" flat="1 0 0"/>
  %s
</scene>
"""
CLIP = """<clip id="straight" model="meshes/clips/straight/straight.urdf"/>
  <clip_applier id="applier" model="meshes/instruments/clip_applier/clip_applier.urdf" hand="right" clips="straight"
                home="5 0 12 mm" shaft="0 0 1" flat="1 0 0"/>"""


def multicast(python, url):
    """Whether LCM messages come back here; as root, a missing route is added."""
    probe = (
        "import lcm,sys\nb=lcm.LCM(sys.argv[1])\ns=[]\nb.subscribe('P',lambda c,d:s.append(d))\n"
        "for i in range(50):\n  b.publish('P',b'x')\n  b.handle_timeout(20)\n  if s: sys.exit(0)\nsys.exit(1)"
    )
    for attempt in range(2):
        if subprocess.run([python, "-c", probe, url], capture_output=True, timeout=60).returncode == 0:
            return True
        if attempt == 0 and os.geteuid() == 0:
            subprocess.run(
                "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo", shell=True, capture_output=True
            )
    return False


def free_bus():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("", 0))
        return "udpm://239.255.76.67:%d?ttl=0" % s.getsockname()[1]


def make_scene(source, insula, folder):
    """Writes the scene with its files. Returns whether it has clips."""
    tools = ["instruments/" + t for t in ("retractor", "dissector", "clip_applier")]
    for part in ["examples", "clips/straight"] + tools:
        if (source / "meshes" / part).is_dir():
            shutil.copytree(source / "meshes" / part, folder / "meshes" / part)
    elements = subprocess.run([insula, "list"], capture_output=True, text=True, check=True).stdout
    clips = "clip_applier" in elements and (folder / "meshes/clips/straight").is_dir()
    (folder / "scene.xml").write_text(SCENE % (CLIP if clips else ""), encoding="utf-8")
    return clips


class Programs:
    """Engine and haptic server that run in a folder. As a context manager, it ends both."""

    def __init__(self, build, folder, env):
        self.logs = [open(folder / n, "w+") for n in ("engine.log", "server.log")]
        commands = [
            [str(build / "bin/insula"), "engine", "scene.xml", "--motion", "none"],
            [str(build / "bin/haptic_server")],
        ]
        self.processes = [
            subprocess.Popen(c, cwd=folder, env=env, stdout=log, stderr=subprocess.STDOUT)
            for c, log in zip(commands, self.logs)
        ]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.alive = [p.poll() is None for p in self.processes]
        for p in self.processes:
            p.send_signal(signal.SIGINT)
        self.status = [p.wait(60) for p in self.processes]

    def said(self):
        return "".join(log.seek(0) * "" + log.read() for log in self.logs)


def run_script(python, source, name, types, env, *more, timeout=60):
    command = [python, str(source / "examples/python" / name), "--types", str(types), *more]
    return subprocess.run(command, env=env, capture_output=True, text=True, timeout=timeout)


def expected_of_the_example(clips):
    expected = [
        r"^scene: Two hands$",
        r"^left hand: left_dissector taken up$",
        r"^left hand: left_spatula taken up$",
        r"^right hand: right_spatula taken up$",
    ]
    if clips:
        expected += [r"^right hand: applier taken up$", r"^applier: straight loaded$"]
    for side in ("left", "right"):
        expected.append(r"^%s hand: [1-9]\d+ forces, mean \d+\.\d+ N, largest \d+\.\d+ N$" % side)
    return expected


# Additional arguments of spy.py, and patterns of its output with them.
SPIED = (
    ([], [r"^%s +[1-9]\d* +\d+\.\d$" % c for c in ("DEVICE_STATE", "HAPTIC_PROBLEM", "RENDER_FRAME")]),
    (
        ["--show", "HAPTIC_STATUS"],
        [r"^HAPTIC_STATUS$", r"^  fresh_forces_per_s +\[", r"^  lateness_count +\[\d+, .*\]$"],
    ),
)


def main():
    source, build, lcm_gen = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    python = environment(build)
    url = free_bus()
    if not multicast(python, url):
        skip("no multicast on this machine")
    types = build / "python"
    messages = [str(f) for f in sorted((source / "lcm_types").glob("*.lcm"))]
    subprocess.run([lcm_gen, "-p", "--ppath", str(types), *messages], check=True)
    with tempfile.TemporaryDirectory(prefix="insula_python_") as name:
        folder = pathlib.Path(name)
        clips = make_scene(source, str(build / "bin/insula"), folder)
        env = dict(os.environ, LCM_DEFAULT_URL=url, XDG_RUNTIME_DIR=name)
        with Programs(build, folder, env) as programs:
            times = ["--seconds", "2", "--wait", "90"]
            run = run_script(python, source, "exchange_and_forces.py", types, env, *times, timeout=240)
            spied = [run_script(python, source, "spy.py", types, env, "--seconds", "2.5", *m) for m, _ in SPIED]
        said = programs.said()
    print(run.stdout, run.stderr, said, sep="\n")
    missing = [e for e in expected_of_the_example(clips) if not re.search(e, run.stdout, re.M)]
    for spy, (_, lines) in zip(spied, SPIED):
        assert spy.returncode == 0, spy.stderr
        missing += [e for e in lines if not re.search(e, spy.stdout, re.M)]
    assert run.returncode == 0, run.returncode
    assert not missing, missing
    assert "refused" not in run.stdout
    assert all(programs.alive), "a process ended by itself"
    assert programs.status == [0, 0], programs.status
    print("the example does what it says" + ("" if clips else " (no clips in this build)"))


if __name__ == "__main__":
    main()
