#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""build_folder.py BUILD: a plugin against a build folder that is installed nowhere. The command that `insula
new-plugin` prints is run as it stands; it must find the package there, build the plugin and pass its tests.
"""
import os
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from steps import run, that  # noqa: E402

NAME = "my_float"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    work = build / "tests/build_folder"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    said = run(build / "bin/insula", "new-plugin", NAME, "--kind", "body", cwd=work)
    commands = [line.strip() for line in said.split("\n") if line.strip().startswith("cmake ")]
    that(len(commands) == 1 and "-DInsula_DIR=%s" % build in commands[0], "new-plugin prints:\n" + said)
    environment = dict(os.environ, CMAKE_GENERATOR="Ninja")
    if shutil.which("ccache"):
        environment["CMAKE_CXX_COMPILER_LAUNCHER"] = "ccache"
    passed = run("sh", "-c", commands[0], cwd=work, env=environment)
    that("100% tests passed, 0 tests failed out of 3" in passed, passed)
    cache = (work / NAME / "build/CMakeCache.txt").read_text(encoding="utf-8")
    that("Insula_DIR:PATH=%s\n" % build in cache or "Insula_DIR:UNINITIALIZED=%s\n" % build in cache, "found elsewhere")
    return 0


if __name__ == "__main__":
    sys.exit(main())
