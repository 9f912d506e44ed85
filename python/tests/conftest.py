# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests share: scenes, hands that work in exercise 1, and a new process."""

import pathlib
import subprocess
import sys

import insula
import pytest


def pytest_addoption(parser):
    parser.addoption("--build", type=pathlib.Path, required=True, help="build folder")


@pytest.fixture
def build(request):
    return request.config.getoption("--build")


@pytest.fixture
def fissure():
    """Exercise 1, at its start."""
    return insula.load("sylvian_fissure")


BLOCK = """<scene title="Block">
  <soft_body id="block" mesh="block.msh" mesh_unit="mm">
    <corotational_fem young="2 kPa"/>
    <fixed region="inside" centre="0 0 0 mm" radius="8 mm"/>
    <surface id="skin"/>
  </soft_body>
</scene>
"""


def load_block(text=BLOCK, name="mine.xml", **options):
    """A scene with a block of tissue alone, from its text."""
    return insula.load(text, path=insula.shipped.folder() / "meshes/examples" / name, **options)


def work(simulation, steps, start=20.0):
    """Both hands do what the exercise's motion shows, from `start` (s) on, set in each step by this program."""
    motion = simulation.motion("steady")
    for k in range(steps):
        time = start + k * simulation.time_step
        for hand in ("left", "right"):
            position, orientation, button1, button2 = motion.at(hand, time)
            simulation.set_hand(hand, position, orientation, button1, button2)
        simulation.step()


def in_new_process(program):
    """The last line that a program prints in a new process."""
    done = subprocess.run([sys.executable, "-B", "-c", program], capture_output=True, text=True, check=False,
                          cwd=pathlib.Path(__file__).parent, env={"PYTHONPATH": ":".join(sys.path), "PATH": ""})
    assert done.returncode == 0, done.stderr
    return done.stdout.strip().split("\n")[-1]
