#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the short motions that `insula bench --haptics` measures the servo's force on.

    python3 tools/motions/haptic_probes.py [OUTPUT_FOLDER]

tap      right hand, exercise 1: three taps on the frontal cortex, each faster
drag     right hand, exercise 1: pressed on, drawn along and back with friction
squeeze  both hands, exercise 1: the frontal lobe between them
strand   right hand, exercise 1: into the strands at the surface, pulled until they part
artery   right hand, exercise 2: along the parent artery while it beats
clip     right hand, exercise 3: over the dome, and the blades close on the neck
Moves start and end at rest (minimum jerk). The same input gives the same bytes.
"""
import csv
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import sylvian_fissure as course  # noqa: E402
from sylvian_fissure import add, cross, dot, orientation, unit  # noqa: E402

OUTPUT = course.ROOT / "scenes" / "haptics"
KEY_INTERVAL = 0.02  # s

# seconds, along, depth, lift (mm, see sylvian_fissure.py)
TAP = [(0.0, 8, -7, 9), (0.25, 8, 2.5, 9), (0.25, 8, -3, 9), (0.15, 8, 2.5, 9), (0.15, 8, -3, 9), (0.1, 8, 2.5, 9), (0.3, 8, -7, 9)]
DRAG = [(0.0, 8, -7, 9), (0.4, 8, 1.5, 9), (0.2, 8, 1.5, 9), (0.5, -2, 1.5, 9), (0.15, -2, 1.5, 9), (0.35, 8, 1.5, 9), (0.3, 8, -7, 9)]
SQUEEZE_LEFT = [(0.0, -6, -7, 8), (0.4, -6, 1.5, 8), (0.35, -3, 2.5, 8), (0.2, -3, 2.5, 8), (0.3, -6, 1.5, 8), (0.4, -6, -7, 8)]
SQUEEZE_RIGHT = [(0.0, 10, -7, 10), (0.5, 10, 1.5, 10), (0.3, 6, 2.5, 10), (0.2, 6, 2.5, 10), (0.3, 10, 1.5, 10), (0.3, 10, -7, 10)]
STRAND = [(0.0, 13, -5, 0.5), (0.5, 11, 2.6, -0.6), (0.9, -3, 2.6, -0.8), (0.1, -3, 2.6, -0.8), (0.5, 5, 3.2, -1.2), (0.4, 11, -5, 0.5)]


def ease(s):
    return s * s * s * (10 - 15 * s + 6 * s * s)


def moves(rows, place):
    """(seconds, coordinates...) to (time, position) keys."""
    out, t, last = [], 0.0, None
    for seconds, *at in rows:
        if last is None:
            out.append((0.0, place(at)))
        else:
            n = max(1, round(seconds / KEY_INTERVAL))
            for i in range(1, n + 1):
                out.append((t + seconds * i / n, place([a + (b - a) * ease(i / n) for a, b in zip(last, at)])))
        t += seconds
        last = at
    return out


def write(path, hands, commands=()):
    """hands: name -> (rotation, keys, buttons at a time or None)."""
    rows = [(t, "command", "%s" % c) for t, c in commands]
    for hand, (q, keys, pressed) in hands.items():
        for t, p in keys:
            numbers = ["%.6f" % (x / 1000) for x in p] + ["%.6f" % x for x in q]
            rows.append((t, hand, ",".join(numbers).replace("-0.000000", "0.000000") + (",%d,%d" % pressed(t))))
    rows.sort(key=lambda r: (round(r[0], 4), r[1]))
    with open(path, "w", encoding="ascii", newline="\n") as f:
        f.write("time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n")
        for t, hand, rest in rows:
            f.write("%.4f,%s,%s\n" % (t, hand, rest))


def never(_):
    return 0, 0


def lobes(folder):
    fissure = course.Fissure(course.FISSURE)
    left_q = orientation(fissure.direction(course.LEFT_LEAN), add([-0.8 * x for x in fissure.front], fissure.up, 0.6))
    right_q = orientation(fissure.direction(course.RIGHT_LEAN), fissure.up)

    def go(rows):
        return moves(rows, lambda at: fissure.place(*at))

    for name, rows in (("tap", TAP), ("drag", DRAG), ("strand", STRAND)):
        write(folder / (name + ".csv"), {"right": (right_q, go(rows), never)})
    write(folder / "squeeze.csv", {"left": (left_q, go(SQUEEZE_LEFT), never), "right": (right_q, go(SQUEEZE_RIGHT), never)})


def artery(folder):
    """Along a stretch of the inferior branch, on the side that looks at the surgeon."""
    vessel = json.loads((course.ROOT / "meshes" / "arteries" / "anterior_superior" / "vessel.json").read_text(encoding="utf-8"))
    line = next(c for c in vessel["centrelines"] if c["name"] == "inferior")
    start, end = (add(line["points"][k], unit(TOWARDS), line["radius"][k]) for k in STRETCH)
    shaft = unit(SHAFT)
    flat = unit(cross(shaft, add(end, start, -1.0)))

    def place(at):
        s, off = at
        return add(add(start, add(end, start, -1.0), s), unit(TOWARDS), off)

    rows = [(0.0, 0, 8), (0.4, 0, -PRESS), (0.2, 0, -PRESS), (0.8, 1, -PRESS), (0.6, 1, -PRESS), (0.6, 0.2, -PRESS), (0.4, 0.2, 8)]
    write(folder / "artery.csv", {"right": (orientation(shaft, flat), moves(rows, place), never)})


STRETCH = (8, 15)         # points of the branch's centreline
TOWARDS = [0.93, 0.22, 0.28]  # the surgeon
SHAFT = [0.80, 0.55, 0.24]
PRESS = 0.3  # mm into the middle of the wall as it lies


def clip(folder):
    """Exercise 3's own way, quicker and no further than the closing."""
    with open(course.ROOT / "scenes" / "training" / "3_clipping_steady.csv", encoding="ascii") as f:
        rows = [r for r in csv.reader(f) if r[1] == "right"]
    far, near, over = ([1000 * float(x) for x in rows[k][2:5]] for k in (0, 3, 4))
    q = [float(x) for x in rows[0][5:9]]
    path = [far, far, near, over, over, over]
    keys = []
    t = 0.0
    for seconds, a, b in zip((0.5, 0.8, 0.4, 0.2, 0.7), path, path[1:]):
        n = round(seconds / KEY_INTERVAL)
        keys += [(t + seconds * i / n, add(a, add(b, a, -1.0), ease(i / n))) for i in range(n)]
        t += seconds
    keys.append((t, over))
    write(folder / "clip.csv", {"right": (q, keys, lambda t: (int(0.15 <= t < 1.85), 0))}, [(0.05, "ask,applier load angled")])


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else OUTPUT
    folder.mkdir(parents=True, exist_ok=True)
    lobes(folder)
    artery(folder)
    clip(folder)


if __name__ == "__main__":
    main()
