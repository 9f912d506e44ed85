#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits the bone window to the brain: reads meshes/lobes, writes centre, axes and inner table into bone_window.json.

    window_fit.py [--lobes DIR] [--parameters FILE]

The highest point of each 3 mm cell of both lobes gives the brain's envelope; a quadric is fitted to it, the cells that
fall into sulci are dropped and the fit repeated. The inner table is the quadric raised by `fit.gap`, and further until
the bone keeps `fit.least_clearance` from every point below it. Needed again only when the lobes change.
"""
import argparse
import json
import math
import os
import struct
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from vec import combine, cross, dot, sub, unit  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
CELL = 3.0
FIT_RADIUS = 29.0


def ply_vertices(path):
    """Vertex positions of a PLY file (ascii or binary little endian, float or double coordinates)."""
    sizes = {
        "char": "b",
        "int8": "b",
        "uchar": "B",
        "uint8": "B",
        "short": "h",
        "int16": "h",
        "ushort": "H",
        "uint16": "H",
        "int": "i",
        "int32": "i",
        "uint": "I",
        "uint32": "I",
        "float": "f",
        "float32": "f",
        "double": "d",
        "float64": "d",
    }
    with open(path, "rb") as f:
        data = f.read()
    end = data.index(b"end_header") + len(b"end_header")
    end = data.index(b"\n", end - 1) + 1
    names, code, count, binary, element = [], "<", 0, False, ""
    for line in data[:end].decode("ascii").split("\n"):
        word = line.split()
        if word[:1] == ["format"]:
            binary = word[1] == "binary_little_endian"
            if word[1] == "binary_big_endian":
                raise ValueError(f"{path}: big-endian PLY is not read")
        elif word[:1] == ["element"]:
            element = word[1]
            if element == "vertex":
                count = int(word[2])
        elif word[:1] == ["property"] and element == "vertex":
            names.append(word[2])
            code += sizes[word[1]]
    at = [names.index(k) for k in "xyz"]
    if binary:
        size = struct.calcsize(code)
        rows = struct.iter_unpack(code, data[end : end + size * count])
    else:
        rows = ([float(x) for x in line.split()] for line in data[end:].decode("ascii").split("\n")[:count])
    return [tuple(float(r[k]) for k in at) for r in rows]


def solve(a, b):
    """Gaussian elimination with partial pivoting."""
    n = len(b)
    m = [list(row) + [x] for row, x in zip(a, b)]
    for i in range(n):
        p = max(range(i, n), key=lambda k: abs(m[k][i]))
        m[i], m[p] = m[p], m[i]
        for k in range(i + 1, n):
            f = m[k][i] / m[i][i]
            m[k] = [x - f * y for x, y in zip(m[k], m[i])]
    x = [0.0] * n
    for i in range(n - 1, -1, -1):
        x[i] = (m[i][n] - sum(m[i][k] * x[k] for k in range(i + 1, n))) / m[i][i]
    return x


def monomials(x, y):
    return (1.0, x, y, x * x, x * y, y * y)


def height(c, x, y):
    return sum(k * m for k, m in zip(c, monomials(x, y)))


def fit_quadric(points):
    for _ in range(4):
        rows = [monomials(x, y) for x, y, _ in points]
        a = [[sum(r[i] * r[j] for r in rows) for j in range(6)] for i in range(6)]
        b = [sum(r[i] * p[2] for r, p in zip(rows, points)) for i in range(6)]
        c = solve(a, b)
        points = [p for p in points if p[2] - height(c, p[0], p[1]) > -1.8]
    return c


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lobes", default=os.path.join(ROOT, "meshes", "lobes"))
    parser.add_argument("--parameters", default=os.path.join(HERE, "bone_window.json"))
    args = parser.parse_args(argv)
    with open(args.parameters, encoding="utf-8") as f:
        text = f.read()
    par = json.loads(text)
    with open(os.path.join(args.lobes, "fissure.json"), encoding="utf-8") as f:
        fissure = json.load(f)
    with open(os.path.join(args.lobes, "approach.json"), encoding="utf-8") as f:
        approach = json.load(f)
    # A corridor that does not lead along the fissure's normal has a direction and a middle of its own.
    n = unit(tuple(par["fit"].get("normal", fissure["outward_normal"])))
    up = unit(sub((0.0, 0.0, 1.0), combine((0.0, 0.0, 0.0), (n[2], n))))
    x_axis = cross(up, n)
    shift = par["fit"]["shift"]
    centre = combine(tuple(par["fit"].get("middle", fissure["centre"])), (shift[0], x_axis), (shift[1], up))
    brain = []
    for lobe in approach["lobes"]:
        for p in ply_vertices(os.path.join(args.lobes, f"{lobe}_surface.ply")):
            d = sub(p, centre)
            brain.append((dot(d, x_axis), dot(d, up), dot(d, n)))
    cells = {}
    for p in brain:
        key = (math.floor(p[0] / CELL), math.floor(p[1] / CELL))
        if math.hypot(p[0], p[1]) < FIT_RADIUS and p[2] > cells.get(key, (0.0, 0.0, -10.0))[2]:
            cells[key] = p
    c = fit_quadric([cells[k] for k in sorted(cells)])
    bone = [p for p in brain if 16.0 < math.hypot(p[0], p[1]) < 34.0]
    nearest = min(height(c, p[0], p[1]) - p[2] for p in bone)
    lift = max(par["fit"]["gap"], par["fit"]["least_clearance"] - nearest)
    c[0] += lift
    replace = {"centre": centre, "normal": n, "up": up, "surface": c}
    lines = []
    for line in text.split("\n"):
        key = line.strip().split('"')[1] if line.startswith('  "') else ""
        if key in replace:
            digits = 6 if key in ("surface", "normal", "up") else 3
            line = f'  "{key}": {json.dumps([round(v, digits) + 0.0 for v in replace[key]])},'
        lines.append(line)
    with open(args.parameters, "w", encoding="utf-8", newline="\n") as f:
        f.write("\n".join(lines))
    print(
        f"inner table {lift:.2f} mm above the fitted envelope, least clearance under the bone {nearest + lift:.2f} mm"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
