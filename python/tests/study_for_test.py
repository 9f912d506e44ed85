# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of studies share: a small scene in a folder of its own, study files, and the command."""

import json
import os
import pathlib
import shutil
import subprocess
import sys

import insula

SCENE = """<scene title="Block" gravity="0 0 -5 m/s2">
  <variable name="young" value="2 kPa"/>
  <soft_body id="block" mesh="meshes/block.msh" mesh_unit="mm">
    <corotational_fem young="$young"/>
    <fixed region="inside" centre="0 0 0 mm" radius="8 mm"/>
    <surface id="skin"/>
  </soft_body>
</scene>
"""
STUDY = """<study title="A block that hangs">
  <scene file="block.xml"/>
  %s
  <run duration="%s" time_limit="%s"/>
  <body id="block"/>
  <body id="block" value="energy" statistic="largest"/>
</study>
"""
YOUNG = '<vary of="block.corotational_fem.young" values="2, 4, 8 kPa"/>'
SEEDS = '<seeds count="%d"/>'


def write(folder, axes=YOUNG, duration="0.2 s", limit="1 min", scene=SCENE):
    """A study in this folder, with its scene and mesh."""
    (folder / "meshes").mkdir(parents=True, exist_ok=True)
    shutil.copy(insula.shipped.folder() / "meshes/examples/block.msh", folder / "meshes/block.msh")
    (folder / "block.xml").write_text(scene, encoding="utf-8")
    file = folder / "study.xml"
    file.write_text(STUDY % (axes, duration, limit), encoding="utf-8")
    return file


def words(*more):
    return [sys.executable, "-B", "-m", "insula", "study", *(str(m) for m in more)]


def run(*more, env=None):
    """The command, to its end."""
    return subprocess.run(words(*more), capture_output=True, text=True, check=False, env=env, timeout=600)


def rows(folder):
    """Finished runs by id."""
    return {f.stem: json.loads(f.read_text()) for f in pathlib.Path(folder).glob("runs/??/*.json")}


def written_at(folder):
    """When each finished run was written: a run that is made twice is written twice."""
    return {f.stem: f.stat().st_mtime_ns for f in pathlib.Path(folder).glob("runs/??/*.json")}


def children(process):
    """Processes below this one."""
    out = []
    for task in pathlib.Path("/proc/%d/task" % process).glob("*/children"):
        out += [int(p) for p in task.read_text().split()]
    return out


def alive(process):
    """A process that has ended and was not waited for is not alive."""
    try:
        state = pathlib.Path("/proc/%d/stat" % process).read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return False
    return state not in "ZX" and os.path.exists("/proc/%d" % process)
