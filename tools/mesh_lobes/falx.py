#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the falx between two hemispheres: falx.py FOLDER OUTPUT_FOLDER.

FOLDER/approach.json says whether the approach has a falx (mesh.falx) and what is on its left and right. OUTPUT_FOLDER
holds fissure.json and both fine surfaces, and gets falx_surface.ply (mm). The falx is a sheet midway between the medial
surfaces. It begins above the cortex and ends with a free edge above the corpus callosum. The same input gives the same
bytes.
"""
import json
import math
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "meshes"))
import mesh_files  # noqa: E402

THICKNESS = 0.7  # mm
ABOVE_CORTEX = 5.0  # mm
CELL = 2.5  # mm, of the grid in which the middle is looked for
STEP = 1.2  # mm between points of the sheet
MEDIAL = 8.0  # mm: surfaces farther from the middle are not medial


def middle_of(left, right):
    """Function of (y, z): x midway between the surfaces."""
    cells = {}
    for k, (points, sign) in enumerate(((left, 1.0), (right, -1.0))):
        for x, y, z in points:
            if abs(x) < MEDIAL:
                sides = cells.setdefault((math.floor(y / CELL), math.floor(z / CELL)), [None, None])
                sides[k] = x if sides[k] is None else sign * max(sign * sides[k], sign * x)
    known = [((j + 0.5) * CELL, (k + 0.5) * CELL, 0.5 * (a + b)) for (j, k), (a, b) in sorted(cells.items())
             if a is not None and b is not None]

    def at(y, z):
        total, weight = 0.0, 0.0
        for q, r, x in known:
            w = math.exp(-((y - q) ** 2 + (z - r) ** 2) / (2 * CELL**2)) + 1e-12
            total, weight = total + w * x, weight + w
        return total / weight

    return at


def resampled(stations, free_edge):
    """Upper and lower ends (y, z) of the sheet's columns, STEP apart at the cortex."""
    ends = []
    for s in stations:
        (_, y, z), (_, v, w) = s["superficial"], s["inward"]
        down = max(1.0, s["depth"] - free_edge)
        ends.append(((y - ABOVE_CORTEX * v, z - ABOVE_CORTEX * w), (y + down * v, z + down * w)))
    out = []
    for (a, b), (c, d) in zip(ends, ends[1:]):
        count = max(1, round(math.dist(a, c) / STEP))
        for k in range(count):
            t = k / count
            mix = lambda p, q: tuple(u + (v - u) * t for u, v in zip(p, q))
            out.append((mix(a, c), mix(b, d)))
    return out + [ends[-1]]


def sheet(columns, middle):
    rows = 1 + max(round(math.dist(a, b) / STEP) for a, b in columns)
    points, triangles = [], []
    for side in (1, -1):
        for a, b in columns:
            for r in range(rows):
                y, z = (u + (v - u) * r / (rows - 1) for u, v in zip(a, b))
                points.append((middle(y, z) + side * THICKNESS / 2, y, z))
    half, n = len(columns) * rows, len(columns)
    quad = lambda a, b, c, d: triangles.extend(((a, b, c), (a, c, d)))
    for i in range(n - 1):
        for r in range(rows - 1):
            k = i * rows + r
            quad(k, k + 1, k + rows + 1, k + rows)
            quad(half + k, half + k + rows, half + k + rows + 1, half + k + 1)
    border = [r for r in range(rows - 1)] + [i * rows + rows - 1 for i in range(n - 1)]
    border += [(n - 1) * rows + r for r in range(rows - 1, 0, -1)] + [i * rows for i in range(n - 1, 0, -1)]
    for p, q in zip(border, border[1:] + border[:1]):
        quad(p, half + p, half + q, q)
    volume = sum(
        points[a][0] * (points[b][1] * points[c][2] - points[b][2] * points[c][1])
        + points[a][1] * (points[b][2] * points[c][0] - points[b][0] * points[c][2])
        + points[a][2] * (points[b][0] * points[c][1] - points[b][1] * points[c][0])
        for a, b, c in triangles
    )
    return points, [(a, c, b) for a, b, c in triangles] if volume < 0 else triangles


def write_ply(path, points, triangles):
    head = "ply\nformat binary_little_endian 1.0\ncomment unit mm\nelement vertex %d\n" % len(points)
    head += "property float x\nproperty float y\nproperty float z\nelement face %d\n" % len(triangles)
    head += "property list uchar int vertex_indices\nend_header\n"
    body = b"".join(struct.pack("<3f", *p) for p in points) + b"".join(struct.pack("<B3i", 3, *t) for t in triangles)
    path.write_bytes(head.encode() + body)


def main():
    falx = json.loads((pathlib.Path(sys.argv[1]) / "approach.json").read_text())["mesh"].get("falx")
    if not falx:
        return
    out = pathlib.Path(sys.argv[2])
    left, right = (mesh_files.read_ply(out / (falx[side] + "_surface.ply"))[0] for side in ("left", "right"))
    stations = json.loads((out / "fissure.json").read_text())["stations"]
    points, triangles = sheet(resampled(stations, falx["free_edge_mm"]), middle_of(left, right))
    write_ply(out / "falx_surface.ply", points, triangles)
    print("falx: %d points, %d triangles" % (len(points), len(triangles)))


main()
