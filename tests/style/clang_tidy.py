#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""clang_tidy.py SOURCE BUILD [FILE...]: the checks of .clang-tidy on files.

Without files, it looks at the sources that differ from the main branch. It needs clang-tidy and a build folder with its
compile_commands.json; without one of them it is skipped (status 77). It looks at MOST
files at most, so that the time stays small, and says which ones it left out.
"""
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

MOST = 8


def changed(source):
    def git(*words):
        done = subprocess.run(["git", "-C", source, "-c", "safe.directory=*", *words], capture_output=True, text=True)
        return done.stdout.split("\n") if done.returncode == 0 else []

    base = next((b[0] for b in (git("merge-base", "HEAD", m) for m in ("origin/main", "main")) if b and b[0]), "HEAD")
    return [f for f in git("diff", "--name-only", base) if f.endswith(".cpp")]


def command_without_precompiled(entry):
    """The arguments of a compile command that clang understands: gcc's precompiled headers are not among them."""
    words, out, skip = shlex.split(entry["command"]), [], 0
    compiler = next(k for k, w in enumerate(words) if w.endswith(("c++", "g++", "clang++")))
    for k, word in enumerate(words[compiler:]):
        if skip:
            skip -= 1
        elif word == "-include" and "cmake_pch" in words[compiler + k + 1]:
            skip = 1
        elif word not in ("-fpch-preprocess", "-Winvalid-pch"):
            out.append(word)
    return out


def by_source(entries):
    """The compile command of each source. One entry may compile several, each of which it includes."""
    out = {}
    for entry in entries:
        unity = pathlib.Path(entry["file"])
        if unity.parent.name != "Unity":
            out[entry["file"]] = entry
            continue
        for source in re.findall(r'^#include "(.*)"', unity.read_text(), re.M):
            out[source] = dict(entry, file=source, command=entry["command"].replace(entry["file"], source))
    return out


def main():
    source, build = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    tool = shutil.which("clang-tidy-14") or shutil.which("clang-tidy")
    database = build / "compile_commands.json"
    if not tool or not database.exists():
        print("no clang-tidy or no compile_commands.json here: skipped")
        return 77
    commands = by_source(json.loads(database.read_text()))
    files = [f for f in (sys.argv[3:] or changed(source)) if str(source / f) in commands]
    for f in files[MOST:]:
        print("left out: " + f)
    folder = build / "tests/clang_tidy"
    folder.mkdir(parents=True, exist_ok=True)
    entries = []
    for f in files[:MOST]:
        entry = commands[str(source / f)]
        entries.append(dict(entry, command=shlex.join(command_without_precompiled(entry))))
    (folder / "compile_commands.json").write_text(json.dumps(entries))
    wrong = 0
    for f in files[:MOST]:
        command = [tool, "--quiet", "--warnings-as-errors=*", "-p", folder, source / f]
        done = subprocess.run(command, capture_output=True, text=True)
        print("%s: %s" % (f, "well" if done.returncode == 0 else "\n" + done.stdout))
        wrong += done.returncode != 0
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
