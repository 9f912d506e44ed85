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
import tube  # noqa: E402
from layout import (  # noqa: E402
    BOWL_BOTTOM,
    BOWL_DEPTH,
    BOWL_RADIUS,
    FLAP_HIGH,
    FLAP_LOW,
    PAD_HIGH,
    PAD_LOW,
    POSTS,
    RAIL_HIGH,
    RAIL_LOW,
    TUBE_AXIS,
    TUBE_LENGTH,
    TUBE_MIDDLE,
)

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "meshes" / "practice"


def posts():
    surface = shapes.Surface()
    for x, y, height in POSTS:
        shapes.post(surface, x, y, 2.2, height)
    return surface


def surfaces():
    yield "table.obj", "the cloth below the tray, for the picture alone", shapes.plate(140, -4, -2.5)
    yield "tray.obj", "a tray with round corners, its floor at z = 0", shapes.tray(30, 22, 8)
    yield "flap_stand.obj", "the block that the flap is fastened to", shapes.block((-11, 7.5, 0), (11, 12, 11))
    yield "stands.obj", "two posts that carry the ends of the tube", stands()
    yield "posts.obj", "eight posts of different heights", posts()


def rounded(p):
    """A pad whose upper edges are rounded off."""
    x, y, z = p
    if z > 0.9 * PAD_HIGH[2]:
        x, y = 0.95 * x if abs(x) > 0.99 * PAD_HIGH[0] else x, 0.93 * y if abs(y) > 0.99 * PAD_HIGH[1] else y
    return [x, y, z]


def bowl(p):
    """A pad with a paraboloid hollow."""
    x, y, z = p
    top = BOWL_BOTTOM + BOWL_DEPTH * min(1.0, (x * x + y * y) / BOWL_RADIUS**2)
    return [x, y, 0.05 + (z - 0.05) * (top - 0.05)]


def rail(side):
    low, high = list(RAIL_LOW), list(RAIL_HIGH)
    if side < 0:
        low[0], high[0] = -high[0], -low[0]
    return shapes.pad((3, 8, 3), low, high)


def stands():
    """Two blocks that carry the ends of the tube."""
    surface = shapes.Surface()
    for sign in (-1, 1):
        x, y, z = (m + sign * (0.5 * TUBE_LENGTH + 0.5) * a for m, a in zip(TUBE_MIDDLE, TUBE_AXIS))
        shapes.post(surface, x, y, 2.6, z + 2.4)
    return surface


def solids():
    yield "flap.msh", "a soft flap above the floor", shapes.pad((12, 8, 1), FLAP_LOW, FLAP_HIGH)
    yield "rail_left.msh", "a soft rail to the left", rail(-1)
    yield "rail_right.msh", "a soft rail to the right", rail(1)
    yield "bowl.msh", "a soft pad with a hollow", shapes.pad((14, 12, 2), (-19, -16.5, 0.05), (19, 16.5, 1.05), bowl)
    yield "pad.msh", "a soft pad in the tray", shapes.pad((12, 8, 2), PAD_LOW, PAD_HIGH, rounded)


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
    for name, what, text in tube.files():
        out[name] = text
        manifest.append(entry(name, what, text))
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
