#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that a folder includes only from folders that it may use.

The rooms of core/ are declared in cmake/core.cmake, which writes them to rooms.txt ("name:used,used"). The other
folders are declared here. Tests and their helpers (*_test.cpp, *_for_test.h) may include anything.

    includes.py SOURCE_FOLDER ROOMS_FILE
"""
import pathlib
import re
import sys

# Folder -> folders it may include from, besides itself. "core" stands for all rooms of core/ but bus, haptics and
# testing.
FOLDERS = {
    "core/bus": {"core"},
    "core/haptics": {"core", "core/bus"},
    "core/testing": {"core", "core/bus", "plugins"},
    "platform": {"core", "core/bus", "core/testing"},
    "plugins": {"core"},
    "haptic_server": {"core", "core/bus", "core/haptics"},
    "training/store": {"core"},
    "training/xapi": {"core", "training/store"},
    "training/curriculum": {"core"},
    "training/progress": {"core", "training/store", "training/curriculum"},
    "engine": {
        "core",
        "core/bus",
        "core/haptics",
        "haptic_server",
        "training/store",
        "training/xapi",
        "training/curriculum",
        "training/progress",
    },
    "python": {"core", "engine"},
    "viewer/gateway": {"core", "core/bus", "training/store", "training/curriculum", "training/progress"},
}
INCLUDE = re.compile(r'^\s*#\s*include "([\w./]+)"')


def read_rooms(text):
    """{"core/linalg": {"core/base"}} of lines "linalg:base"."""
    rooms = {}
    for line in text.split():
        name, used = line.split(":")
        rooms["core/" + name] = {"core/" + u for u in used.split(",") if u}
    return rooms


def place_of(path, rooms):
    """The declared folder that a path such as core/linalg/kernels.h lies in; None for all others."""
    for folder in sorted([*rooms, *FOLDERS], key=len, reverse=True):
        if path.startswith(folder + "/"):
            return folder
    return None


def allowed(place, other, rooms):
    if place == other:
        return True
    if place in rooms:
        return other in rooms[place]
    used = FOLDERS[place]
    return other in used or ("core" in used and other in rooms)


def check(files, rooms):
    """Messages for what is included but not declared. files: {path: text}."""
    problems = []
    for path, text in sorted(files.items()):
        place = place_of(path, rooms)
        if place is None or path.endswith("_test.cpp") or path.endswith("_for_test.h"):
            continue
        for number, line in enumerate(text.splitlines(), 1):
            found = INCLUDE.match(line)
            other = found and place_of(found.group(1), rooms)
            if other and not allowed(place, other, rooms):
                problems.append(f"{path}:{number}: {place} may not include from {other}: {found.group(1)}")
    return problems


def main(source, rooms_file):
    root = pathlib.Path(source)
    rooms = read_rooms(pathlib.Path(rooms_file).read_text())
    folders = {folder.split("/")[0] for folder in [*rooms, *FOLDERS]}
    files = {}
    for folder in sorted(folders):
        for path in (root / folder).rglob("*"):
            if path.suffix in (".h", ".cpp") and "node_modules" not in path.parts:
                files[path.relative_to(root).as_posix()] = path.read_text(encoding="utf-8")
    problems = check(files, rooms)
    print("\n".join(problems) or f"{len(files)} files include only what their folders may use")
    return 1 if problems or not rooms else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
