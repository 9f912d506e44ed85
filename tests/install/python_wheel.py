#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""python_wheel.py SOURCE BUILD: builds the wheel, installs it into a clean environment, and uses it there.

It runs without the source tree's files: the environment is empty, and so is the folder in which it works. Every
library that a program or the module loads lies in the wheel or belongs to the C library.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

PROGRAM = """
import insula, pathlib, sys
s = insula.load("sylvian_fissure")
s.follow(s.motion("steady"))
s.step(60)
assert "site-packages" in insula.__file__, insula.__file__
assert "site-packages" in s.file, s.file
print("state_hash %016x" % s.state_hash)
"""
# Of the machine: the C library, what manylinux allows, and what it needs of the C++ library.
SYSTEM = re.compile(r"^(linux-vdso|ld-linux-x86-64|libpython3"
                    r"|lib(c|m|dl|rt|pthread|util|stdc\+\+|gcc_s|resolv|z|expat|nsl|anl)\.so)")


def run(*words, **more):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False, **more)
    if done.returncode:
        sys.exit("%s%s\nfailed: %s" % (done.stdout, done.stderr, " ".join(map(str, words))))
    return done.stdout


def foreign_libraries(package):
    """Libraries outside of the package that its files load, besides those of the system."""
    files = [*package.glob("_core*.so"), *(package / "prefix/bin").iterdir()]
    found = []
    for file in files:
        for line in run("ldd", file).split("\n"):
            match = re.match(r"\s*(\S+) => (\S+)", line)
            if match and not SYSTEM.match(match[1]) and "site-packages" not in match[2]:
                found.append("%s loads %s" % (file.name, line.strip()))
    return files, found


def main():
    source, build = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        python = source / "build/python-env/bin/python"
        if subprocess.run([python, "-m", "pip", "download", "-q", "--no-deps", "-d", folder / "try", "nanobind"],
                          capture_output=True, check=False).returncode:
            print("skipped: there is no way to PyPI")
            return 77
        print(run(python, "-B", source / "python/wheel/build.py", build, folder / "dist").strip())
        (wheel,) = (folder / "dist").glob("*.whl")
        run("/usr/bin/python3", "-m", "venv", folder / "venv")
        run(folder / "venv/bin/pip", "install", wheel)
        clean = {"cwd": folder, "env": {"PATH": "/usr/bin:/bin", "HOME": str(folder)}}
        said = run(folder / "venv/bin/python", "-c", PROGRAM, **clean).strip()
        insula = folder / "venv/bin/insula"
        scene = run(folder / "venv/bin/python", "-c", "import insula; print(insula.scenes()['sylvian_fissure'])",
                    **clean)
        again = run(insula, "run", scene.strip(), "--motion", "steady", "--duration", "1", "--quiet", **clean)
        assert said in again, (said, again)
        for words in (["list"], ["check", scene.strip()], ["play", "--help"], ["devices"]):
            assert run(insula, *words, **clean)
        (package,) = (folder / "venv").glob("lib/python3*/site-packages/insula")
        files, foreign = foreign_libraries(package)
        assert {f.name for f in files} >= {"insula", "haptic_server", "gateway"}
        assert not foreign, foreign
        assert (package / "prefix/share/insula/page/index.html").exists() or not (source / "viewer/page/dist").exists()
        assert (package / "_core.pyi").exists() and (package / "py.typed").exists()
        print("%d programs and modules, all libraries inside" % len(files))
    return 0


if __name__ == "__main__":
    sys.exit(main())
