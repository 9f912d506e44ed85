# SPDX-License-Identifier: GPL-3.0-or-later
"""The types of the package: its own code agrees with the stubs, and a wrong use is found."""

import pathlib
import subprocess
import sys

import insula
import pytest

pytest.importorskip("mypy")
GOOD = """import insula
s = insula.load("clipping", threads=2)
s.set_hand("left", (0, 0, 0), (1, 0, 0, 0), button1=True)
x: float = s.tip_pose("right")[0][0] + s.problem.W[0, 0] + s.contacts["gap"].sum()
"""
WRONG = {
    's.set_hand("left", 0, (1, 0, 0, 0))': "arg-type",
    's.sten(2)': "attr-defined",
    'insula.load("clipping", thread=2)': "call-arg",
}


def mypy(*words):
    package = pathlib.Path(insula.__file__).parent.parent
    done = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", "/dev/null", *words], capture_output=True,
                          text=True, check=False, env={"MYPYPATH": str(package), "PATH": ""})
    return done.stdout


def test_the_package_agrees_with_its_stubs():
    assert "Success" in (said := mypy("-p", "insula")), said


def test_a_wrong_use_is_found(tmp_path):
    file = tmp_path / "use.py"
    file.write_text(GOOD)
    assert "Success" in (said := mypy(str(file))), said
    file.write_text(GOOD + "\n".join(WRONG) + "\n")
    said = mypy(str(file))
    for kind in WRONG.values():
        assert "[%s]" % kind in said, said


def test_everything_has_a_docstring():
    import inspect

    from insula import _core

    without = []
    for name, kind in inspect.getmembers(_core, inspect.isclass):
        for member, value in vars(kind).items():
            if not member.startswith("_") and not inspect.getdoc(value):
                without.append("%s.%s" % (name, member))
    assert not without
