#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""clang_tidy.py SOURCE BUILD --headers | --all | FILE...: the checks of .clang-tidy.

--headers  all headers in one run: a file that includes each of them. The test suite runs it.
--all      every source. It takes several seconds a file; CONTRIBUTING.md says when to run it.

It needs clang-tidy and a build folder with its compile_commands.json, and generated headers in it. Without one of them
it is skipped (status 77).
"""
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from sources import tracked  # noqa: E402

ROOMS = ("core/", "engine/", "haptic_server/", "platform/", "plugins/", "viewer/gateway/")
# Sources for instruction sets and types of GCC that clang does not support, and headers that only they include.
NOT_FOR_CLANG = ("core/linalg/fp16_kernels_impl.cpp", "core/linalg/instruction_set.cpp")
# Flags that the one command for all headers takes from the commands of the sources.
FLAGS_WITH_VALUE = ("-I", "-isystem", "-D")


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


def shared_flags(entries):
    """The header folders and the definitions of all commands, without duplicates."""
    out = []
    for entry in entries:
        words = command_without_precompiled(entry)
        for k, word in enumerate(words):
            flag = next((f for f in FLAGS_WITH_VALUE if word.startswith(f)), None)
            if flag:
                pair = word if word != flag else word + "\0" + words[k + 1]
                if pair not in out:
                    out.append(pair)
    return [w for pair in out for w in pair.split("\0")]


def file_of_headers(source, folder, entries):
    """Writes the file that includes all headers. Returns its entry for compile_commands.json."""
    headers = [p.relative_to(source).as_posix() for p in tracked(source, ".h")]
    headers = [h for h in headers if h.startswith(ROOMS) and not h.endswith(("_for_test.h", "_impl.h"))]
    headers = [h for h in headers if not h.startswith("core/testing/")]
    file = folder / "all_headers.cpp"
    file.write_text("".join('#include "%s"\n' % h for h in headers), encoding="utf-8")
    command = ["c++", "-std=c++20", *shared_flags(entries), "-c", str(file)]
    return {"directory": entries[0]["directory"], "file": str(file), "command": shlex.join(command)}


def chosen(how, known):
    """The files to check, as the command line selects them."""
    if how == ["--all"]:
        return sorted(known)
    return [f for f in how if f in known]


def main():
    source, build, how = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3:]
    tool = shutil.which("clang-tidy-14") or shutil.which("clang-tidy")
    database = build / "compile_commands.json"
    if not tool or not database.exists():
        print("no clang-tidy or no compile_commands.json here: skipped")
        return 77
    known = {}
    for entry in by_source(json.loads(database.read_text())).values():
        path = pathlib.Path(entry["file"])
        name = path.relative_to(source).as_posix() if path.is_relative_to(source) else ""
        if name.startswith(ROOMS) and name not in NOT_FOR_CLANG:
            known.setdefault(name, entry)
    folder = build / "tests/clang_tidy"
    folder.mkdir(parents=True, exist_ok=True)
    if how == ["--headers"]:
        entries = [file_of_headers(source, folder, list(known.values()))]
    else:
        entries = [
            dict(known[f], command=shlex.join(command_without_precompiled(known[f])))
            for f in chosen(how, known)
        ]
    (folder / "compile_commands.json").write_text(json.dumps(entries))
    wrong = 0
    for entry in entries:
        command = [tool, "--quiet", "--warnings-as-errors=*", "-p", folder, entry["file"]]
        done = subprocess.run(command, capture_output=True, text=True)
        print("%s: %s" % (entry["file"], "passed" if done.returncode == 0 else "\n" + done.stdout), flush=True)
        wrong += done.returncode != 0
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
