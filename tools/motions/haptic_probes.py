#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the short motions that `insula bench --haptics` measures the servo's force on.

    python3 tools/motions/haptic_probes.py [OUTPUT_FOLDER]

tap      right hand, exercise 1: three taps on the frontal cortex, each faster
drag     right hand, exercise 1: pressed on, drawn along and back with friction
squeeze  both hands, exercise 1: the frontal lobe between them
strand   both hands, exercise 1: strands stretched by the left hand, divided by the right
artery   right hand, exercise 3: a dissector along the inferior branch while it beats
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
from sylvian_fissure import orientation  # noqa: E402
from vectors import add, cross, dot, unit  # noqa: E402

OUTPUT = course.ROOT / "scenes" / "haptics"
KEY_INTERVAL = 0.005  # s

# seconds, along, depth, lift (mm, see sylvian_fissure.py)
TAP = [
    (0.0, -8, -5, 10),
    (0.3, -8, 0.6, 10),
    (0.1, -8, 0.6, 10),
    (0.2, -8, -3, 10),
    (0.25, -8, 1.0, 10),
    (0.1, -8, 1.0, 10),
    (0.2, -8, -3, 10),
    (0.2, -8, 0.6, 10),
    (0.2, -8, -5, 10),
]
DRAG = [
    (0.0, -8, -5, 8),
    (0.35, -8, 0.5, 8),
    (0.1, -8, 0.5, 8),
    (0.3, -8, 0.5, 10),
    (0.1, -8, 0.5, 10),
    (0.25, -8, 0.5, 8),
    (0.25, -7, 0.5, 9.5),
    (0.25, -8, 0.5, 8),
    (0.3, -8, -5, 8),
]
SQUEEZE_LEFT = [
    (0.0, -8, -5, 10),
    (0.4, -8, 0.5, 10),
    (0.35, -6.5, 1.2, 10),
    (0.3, -6.5, 1.2, 10),
    (0.3, -8, 0.5, 10),
    (0.3, -8, -5, 10),
]
SQUEEZE_RIGHT = [
    (0.0, 9, -5, 10),
    (0.5, 9, 0.5, 10),
    (0.3, 7.5, 1.2, 10),
    (0.25, 7.5, 1.2, 10),
    (0.3, 9, 0.5, 10),
    (0.3, 9, -5, 10),
]
# The left hand takes hold of the temporal lobe (button 1) and draws it down, the right one divides what is stretched.
STRAND_LEFT = [
    (0.0, 4, -4, -6, 0),
    (0.5, 4, 2.8, -6, 0),
    (0.2, 4, 3.0, -6, 1),
    (0.6, 4, 2.4, -8, 1),
    (0.8, 4, 2.4, -8, 1),
    (0.4, 4, 2.6, -7, 1),
]
STRAND_RIGHT = [
    (0.0, 13, -5, 0.5, 0),
    (0.5, 13, -5, 0.5, 0),
    (0.5, 11, 1.5, -0.7, 0),
    (0.8, -3, 1.5, -0.9, 0),
    (0.1, -3, 1.5, -0.9, 0),
    (0.3, -3, -6, -0.7, 0),
]


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

    def held(rows):
        ends, t = [], 0.0
        for row in rows:
            ends.append((t, row[4]))
            t += row[0]
        return lambda at: (next((b for s, b in reversed(ends) if at >= s), 0), 0)

    for name, rows in (("tap", TAP), ("drag", DRAG)):
        write(folder / (name + ".csv"), {"right": (right_q, go(rows), never)})
    write(
        folder / "strand.csv",
        {
            "left": (left_q, go([r[:4] for r in STRAND_LEFT]), held(STRAND_LEFT)),
            "right": (right_q, go([r[:4] for r in STRAND_RIGHT]), never),
        },
    )
    write(
        folder / "squeeze.csv",
        {"left": (left_q, go(SQUEEZE_LEFT), never), "right": (right_q, go(SQUEEZE_RIGHT), never)},
    )


def artery(folder):
    """Along a stretch of the inferior branch, on the side that looks at the surgeon."""
    vessel = json.loads(
        (course.ROOT / "meshes" / "arteries" / "anterior_superior" / "vessel.json").read_text(encoding="utf-8")
    )
    line = next(c for c in vessel["centrelines"] if c["name"] == "inferior")
    start, end = (add(line["points"][k], unit(TOWARDS), line["radius"][k]) for k in STRETCH)
    shaft = unit(SHAFT)
    flat = unit(cross(shaft, add(end, start, -1.0)))

    def place(at):
        s, off = at
        return add(add(start, add(end, start, -1.0), s), unit(TOWARDS), off)

    rows = [
        (0.0, 0, 8),
        (0.2, 0, 8),
        (0.8, 0, -PRESS),
        (0.3, 0, -PRESS),
        (0.8, 1, -PRESS),
        (0.7, 1, -PRESS),
        (0.3, 1, 8),
    ]
    write(
        folder / "artery.csv",
        {"right": (orientation(shaft, flat), moves(rows, place), never)},
        [(0.0, "exchange,right stylus")],
    )


STRETCH = (8, 15)  # points of the branch's centreline
TOWARDS = [0.93, 0.22, 0.28]  # the surgeon
SHAFT = [0.80, 0.55, 0.24]
PRESS = 0.3  # mm into the middle of the wall as it lies


def clip(folder):
    """Exercise 3's own way, from half-way to where it meets the neck."""
    with open(course.ROOT / "scenes" / "training" / "3_clipping_steady.csv", encoding="ascii") as f:
        rows = [r for r in csv.reader(f) if r[1] == "right"]
    far, near = ([1000 * float(x) for x in rows[k][2:5]] for k in (0, 3))
    q = [float(x) for x in rows[0][5:9]]
    half = [(a + b) / 2 for a, b in zip(far, near)]
    keys = [(0.0, half), (0.1, half), (0.4, half), (1.65, near), (1.85, near), (2.6, near)]
    write(
        folder / "clip.csv",
        {"right": (q, keys, lambda t: (int(0.1 <= t < 1.85), 0))},
        [(0.02, "ask,applier load angled")],
    )


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else OUTPUT
    folder.mkdir(parents=True, exist_ok=True)
    lobes(folder)
    artery(folder)
    clip(folder)


if __name__ == "__main__":
    main()
