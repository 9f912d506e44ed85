#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the meshes of the skill tasks into meshes/practice, and the manifest that lists them.

Usage: generate.py [--check]      --check compares with what lies there and writes nothing
"""
import hashlib
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import shapes  # noqa: E402
from layout import POSTS  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "meshes" / "practice"


def posts():
    surface = shapes.Surface()
    for x, y, height in POSTS:
        shapes.post(surface, x, y, 2.2, height)
    return surface


def surfaces():
    yield "table.obj", "the cloth below the tray, for the picture alone", shapes.plate(140, -4, -2.5)
    yield "tray.obj", "a tray with round corners, its floor at z = 0", shapes.tray(30, 22, 8)
    yield "posts.obj", "eight posts of different heights", posts()


def solids():
    return []


def entry(name, what, text, **counts):
    return dict(
        file=name,
        what=what,
        unit="mm",
        frame="the scene's: +x to the right, +y away from the surgeon, +z up",
        source="generated",
        licence="GPL-3.0-or-later",
        sha256=hashlib.sha256(text.encode()).hexdigest(),
        rebuild="python3 tools/practice/generate.py",
        **counts
    )


def files():
    """Text of each file by its name, and the manifest."""
    out, manifest = {}, []
    for name, what, surface in surfaces():
        out[name] = surface.obj()
        manifest.append(entry(name, what, out[name], triangles=len(surface.triangles)))
    for name, what, (nodes, tets) in solids():
        out[name] = shapes.msh(nodes, tets)
        manifest.append(entry(name, what, out[name], nodes=len(nodes), tetrahedra=len(tets)))
    out["manifest.json"] = json.dumps(manifest, indent=2) + "\n"
    return out


def main():
    wanted = files()
    if "--check" in sys.argv[1:]:
        wrong = [n for n, t in wanted.items() if not (FOLDER / n).is_file() or (FOLDER / n).read_text() != t]
        extra = {p.name for p in FOLDER.iterdir()} - set(wanted)
        for n in sorted(set(wrong) | extra):
            print("differs from what tools/practice/generate.py writes:", n)
        return 1 if wrong or extra else 0
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, text in wanted.items():
        (FOLDER / name).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
