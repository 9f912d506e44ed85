#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the two scripted two-hand motions of exercise 1 from the course of the fissure.

    python3 tools/motions/sylvian_fissure.py [OUTPUT_FOLDER]

steady  opens the fissure as it should be done; rough makes the faults the exercise is about. The same input gives the
same bytes. A place is given in the fissure's own terms, in millimetres:
    along  from the middle of the exercise towards the front
    depth  from the surface inwards
    lift   across the fissure, towards the frontal lobe, from the middle of the gap at rest
"""
import json
import math
import pathlib
import sys

from vectors import add, cross, dot, quaternion, unit

ROOT = pathlib.Path(__file__).resolve().parents[2]
FISSURE = ROOT / "meshes" / "lobes" / "fissure.json"
OUTPUT = ROOT / "scenes" / "training"
NAME = "1_sylvian_fissure"

MIDDLE_Y = 4.0  # mm: `along` is 0 where the superficial line passes this y
KEY_INTERVAL = 0.05  # s
# The lips overhang: so much (mm) above the straight way inwards lies the middle of the gap, at these depths, by
# `along`.
RISE_DEPTHS = [0.0, 3.0, 5.5, 8.0, 11.0]
GAP_RISE = [
    (-14.0, [0.0, 0.0, 0.0, 0.0, 0.0]),
    (-9.0, [0.6, 1.3, 1.7, 3.3, 3.8]),
    (-4.0, [0.6, 1.6, 2.5, 3.2, 3.7]),
    (0.0, [0.4, 1.2, 1.9, 1.9, 1.6]),
    (6.0, [0.4, 1.6, 2.4, 2.2, 1.8]),
    (11.0, [0.4, 0.8, 1.2, 1.2, 1.2]),
]

# Shafts lean out of the microscope's line of sight: the left hand works from behind, the right one from the front.
LEFT_LEAN = {"front": -32.0, "up": -14.0}  # degrees from straight outwards
RIGHT_LEAN = {"front": 20.0, "up": 4.0}

# Each row: seconds, along, depth, lift, suction button, what the hand does.
STEADY_LEFT = [
    (0.0, -14, -24, -10, 0, "rest beside the window"),
    (2.2, 0, -4.0, -1.5, 0, "come in over the temporal lip"),
    (1.3, 0, 4.5, -0.8, 0, "dip between the lips"),
    (0.5, 0, 5.0, -1.0, 1, "take hold"),
    (1.5, 0, 5.0, -2.6, 1, "draw the temporal lobe down, a little"),
    (8.6, 0, 5.0, -2.6, 1, "hold while the surface is divided"),
    (1.2, 0, 6.0, -4.1, 1, "draw further as the lips give way"),
    (11.5, 0, 6.0, -4.1, 1, "hold"),
    (0.8, 0, 5.5, -1.5, 0, "let go"),
    (1.2, -5, 3.0, -0.8, 0, "uncover what the tube hid"),
    (0.8, -5, 5.0, -1.0, 0, "dip between the lips"),
    (0.5, -5, 5.0, -1.0, 1, "take hold"),
    (1.2, -5, 5.0, -2.6, 1, "draw down, a little"),
    (6.6, -5, 5.0, -2.6, 1, "hold"),
    (0.8, -5, 4.0, -0.8, 0, "let go"),
    (1.5, 3, 6.0, -1.0, 0, "change place, deeper"),
    (0.5, 3, 7.5, -1.4, 1, "take hold"),
    (1.5, 3, 7.5, -2.0, 1, "draw down"),
    (16.0, 3, 7.5, -2.0, 1, "hold while the depth is divided"),
    (1.0, 3, 6.0, -1.0, 0, "let go"),
    (1.2, 1, -5.0, -1.0, 0, "leave the fissure"),
    (1.8, -14, -24, -10, 0, "withdraw"),
]
STEADY_RIGHT = [
    (0.0, 16, -26, 8, 0, "rest beside the window"),
    (2.5, 13, -5.0, 0.5, 0, "come in over the front of the fissure"),
    (2.4, 13, -5.0, 0.5, 0, "wait for the left hand"),
    (1.2, 11, 2.6, -0.6, 0, "enter where the fissure is wide"),
    (2.0, -11, 2.6, -1.0, 0, "sweep the surface towards the back"),
    (2.0, 10, 3.2, -1.5, 0, "and forward again, a little deeper"),
    (2.1, -12.5, 3.8, -1.2, 0, "third layer"),
    (2.1, 11, 4.4, -1.5, 0, "and forward"),
    (1.0, 11, 5.4, -1.3, 0, "go deeper while the left hand draws further"),
    (2.2, -13, 5.4, -1.3, 0, "sweep"),
    (2.2, 11, 6.4, -1.6, 0, "sweep"),
    (2.2, -12, 7.4, -0.8, 0, "sweep"),
    (2.2, 11, 7.4, -1.6, 0, "sweep"),
    (7.5, 9, 2.6, -0.6, 0, "make room while the lips stand open and the left hand changes place"),
    (1.5, -1, 3.0, -1.0, 0, "sweep where the tube was"),
    (1.5, 8, 3.8, -1.4, 0, "and forward"),
    (1.5, -1, 4.6, -1.2, 0, "deeper"),
    (1.5, 8, 5.2, -1.4, 0, "and forward"),
    (4.1, 12, 3.0, 0.2, 0, "make room while the left hand changes place"),
    (1.0, 9, 8.0, -0.8, 0, "into the depth"),
    (2.0, -10, 8.0, -0.8, 0, "sweep"),
    (2.0, 9, 8.8, -0.8, 0, "sweep"),
    (2.0, -9, 9.8, -1.0, 0, "sweep"),
    (2.0, 9, 10.6, -0.8, 0, "sweep"),
    (2.0, -8, 11.4, -0.8, 0, "sweep"),
    (2.0, 7, 11.6, -1.0, 0, "sweep"),
    (1.8, -7, 11.8, -0.1, 0, "look for what is left, higher"),
    (1.2, -2, 4.0, -0.6, 0, "come up"),
    (1.0, 10, -4.0, 0.5, 0, "leave the fissure"),
    (1.8, 16, -26, 8, 0, "withdraw"),
]

ROUGH_LEFT = [
    (0.0, -14, -24, -10, 0, "rest beside the window"),
    (1.4, -2, -4.0, -1.5, 0, "come in"),
    (0.8, -1, 6.0, -0.4, 0, "plunge between the lips"),
    (0.4, -1, 6.0, -0.8, 1, "take hold"),
    (1.0, -1, 6.0, -3.0, 1, "draw the temporal lobe down at once"),
    (6.6, -1, 6.0, -3.0, 1, "hold"),
    (0.8, 1, 5.0, -1.0, 0, "let go"),
    (0.8, 3, 7.5, -1.4, 0, "change place, deeper"),
    (0.4, 3, 7.5, -1.4, 1, "take hold"),
    (2.4, 3, 7.5, -12.0, 1, "tear the lips apart"),
    (1.5, 3, 7.5, -12.0, 1, "and keep on pulling"),
    (1.2, 1, 3.0, 0.0, 0, "let go"),
    (2.0, -14, -24, -10, 0, "withdraw"),
]
ROUGH_RIGHT = [
    (0.0, 16, -26, 8, 0, "rest beside the window"),
    (1.4, 12, -4.0, 0.5, 0, "come in"),
    (0.9, 9, 10.5, 0.0, 0, "straight into the depth"),
    (1.6, -9, 10.5, 0.0, 0, "cut there first"),
    (1.6, 9, 10.5, 0.0, 0, "and again"),
    (0.6, 9, 7.4, -0.6, 0, "come up a little"),
    (1.6, -9, 7.4, -0.6, 0, "sweep"),
    (1.6, 9, 5.4, -0.6, 0, "sweep"),
    (0.8, 9, -4.0, 0.5, 0, "out"),
    (4.5, 9, -4.0, 0.5, 0, "look on"),
    (0.6, 8, 4.0, 2.0, 0, "back in"),
    (0.7, 2, 9.0, 13.0, 0, "press on the frontal lobe"),
    (0.7, 2, 9.0, 13.0, 0, "and stay"),
    (0.8, 11, -4.0, 0.5, 0, "leave"),
    (1.5, 16, -26, 8, 0, "withdraw"),
]


def table(rows, x):
    """Piecewise linear, constant outside."""
    if x <= rows[0][0]:
        return rows[0][1]
    for (x0, y0), (x1, y1) in zip(rows, rows[1:]):
        if x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    return rows[-1][1]


class Fissure:
    """Places in the fissure's terms to the scene's frame (mm). Axes are those of the middle: the hands' moves stay
    straight."""

    def __init__(self, path):
        stations = json.loads(path.read_text(encoding="utf-8"))["stations"]
        line = sorted(((s["superficial"], s["inward"]) for s in stations), key=lambda s: s[0][1])
        self.line = line
        k = next(i for i, (p, _) in enumerate(line) if p[1] > MIDDLE_Y)
        f = (MIDDLE_Y - line[k - 1][0][1]) / (line[k][0][1] - line[k - 1][0][1])
        self.inward = unit(add(line[k - 1][1], add(line[k][1], line[k - 1][1], -1.0), f))
        near = [p for p, _ in line if abs(p[1] - MIDDLE_Y) < 10.0]
        front = unit(add(near[-1], near[0], -1.0))
        self.up = unit(cross(front, self.inward))
        if self.up[2] < 0:
            self.up = [-x for x in self.up]
        self.front = unit(cross(self.inward, self.up))
        if self.front[1] < 0:
            self.front = [-x for x in self.front]
        # Arc length of the superficial line from the middle.
        middle = add(line[k - 1][0], add(line[k][0], line[k - 1][0], -1.0), f)
        self.marks = [(0.0, middle)]
        for points, sign in ((line[k:], 1.0), (line[k - 1 :: -1], -1.0)):
            at, last = 0.0, middle
            for p, _ in points:
                at += sign * math.dist(p, last)
                last = p
                self.marks.append((at, p))
        self.marks.sort(key=lambda m: m[0])

    def surface(self, along):
        return [table([(s, p[i]) for s, p in self.marks], along) for i in range(3)]

    def place(self, along, depth, lift):
        rise = table([(s, table(list(zip(RISE_DEPTHS, row)), depth)) for s, row in GAP_RISE], along)
        return add(add(self.surface(along), self.inward, depth), self.up, lift + rise)

    def direction(self, lean):
        """Outwards, leaning by these degrees."""
        out = [-x for x in self.inward]
        out = add(out, self.front, math.tan(math.radians(lean["front"])))
        return unit(add(out, self.up, math.tan(math.radians(lean["up"]))))


def orientation(shaft, flat):
    """Tool frame: z along the shaft to the handle, x the flat side's normal."""
    x = unit(add(flat, shaft, -dot(flat, shaft)))
    return quaternion(x, cross(shaft, x), shaft)


def keys(fissure, rows, rotation):
    """Moves that start and end at rest (minimum jerk), sampled; the button changes at the move's start."""
    out = []
    t = 0.0
    last = None
    for seconds, along, depth, lift, button, _ in rows:
        place = (along, depth, lift)
        if last is None:
            out.append((0.0, fissure.place(*place), rotation, button))
        else:
            n = max(1, round(seconds / KEY_INTERVAL))
            for i in range(1, n + 1):
                s = i / n
                s = s * s * s * (10 - 15 * s + 6 * s * s)
                now = [a + (b - a) * s for a, b in zip(last, place)]
                out.append((t + seconds * i / n, fissure.place(*now), rotation, button))
        t += seconds
        last = place
    return out


def write(path, fissure, left, right):
    left_q = orientation(fissure.direction(LEFT_LEAN), add([-0.8 * x for x in fissure.front], fissure.up, 0.6))
    right_q = orientation(fissure.direction(RIGHT_LEAN), fissure.up)
    rows = [
        (t, hand, p, q, b)
        for hand, moves, rotation in (("left", left, left_q), ("right", right, right_q))
        for t, p, q, b in keys(fissure, moves, rotation)
    ]
    rows.sort(key=lambda r: (round(r[0], 4), r[1]))
    with open(path, "w", encoding="ascii", newline="\n") as f:
        f.write("time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n")
        for t, hand, p, q, b in rows:
            numbers = ["%.6f" % (x / 1000) for x in p] + ["%.6f" % x for x in q]
            f.write("%.3f,%s,%s,%d,0\n" % (t, hand, ",".join(numbers).replace("-0.000000", "0.000000"), b))


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else OUTPUT
    fissure = Fissure(FISSURE)
    write(folder / (NAME + "_steady.csv"), fissure, STEADY_LEFT, STEADY_RIGHT)
    write(folder / (NAME + "_rough.csv"), fissure, ROUGH_LEFT, ROUGH_RIGHT)


if __name__ == "__main__":
    main()
