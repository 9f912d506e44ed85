#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes taps and drags at random points of the frontal cortex of exercise 1, for `insula bench --haptics`.

    python3 tools/motions/random_probes.py COUNT OUTPUT_FOLDER [SEED]

Points are drawn uniformly over a rectangle of the exposed cortex, 24 mm along the fissure and 10 mm across it. Each
point gets tap_NN.csv and drag_NN.csv: movements like those of `tap` and `drag` (haptic_probes.py), measured from the
cortex at that point. A drag goes 2 mm in a random direction and back. No point is left out. The same input gives the
same bytes.
"""
import math
import pathlib
import random
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import haptic_probes as probes  # noqa: E402
import sylvian_fissure as course  # noqa: E402
from sylvian_fissure import orientation  # noqa: E402
from vectors import add, cross, dot  # noqa: E402

SURFACE = course.ROOT / "meshes" / "lobes" / "frontal_surface.ply"
ALONG, LIFT = (-12.0, 12.0), (5.0, 15.0)  # mm, in the fissure's coordinates
# seconds, depth below the cortex (mm), part of the drag
TAP = [(0.0, -5, 0), (0.3, 2.3, 0), (0.1, 2.3, 0), (0.2, -1.3, 0), (0.25, 2.7, 0), (0.1, 2.7, 0), (0.2, -1.3, 0),
       (0.2, 2.3, 0), (0.2, -5, 0)]
DRAG = [(0.0, -5, 0), (0.35, 2.2, 0), (0.1, 2.2, 0), (0.3, 2.2, 1), (0.1, 2.2, 1), (0.25, 2.2, 0), (0.3, -5, 0)]
DRAG_MM = 2.0


def triangles(path):
    """Corners of a binary PLY's triangles, mm."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    lines = head.decode().split("\n")
    assert "format binary_little_endian 1.0" in lines, path
    vertices, faces = (next(int(l.split()[2]) for l in lines if l.startswith("element " + what))
                       for what in ("vertex", "face"))
    kinds = [l.split()[1] for l in lines if l.startswith("property ") and "list" not in l]
    code = {"float": "f", "float32": "f", "double": "d", "uchar": "B", "uint8": "B"}
    vertex = struct.Struct("<" + "".join(code[k] for k in kinds))
    points = [vertex.unpack_from(body, i * vertex.size)[:3] for i in range(vertices)]
    at = vertices * vertex.size
    return [tuple(points[k] for k in struct.unpack_from("<3i", body, at + 13 * i + 1)) for i in range(faces)]


def first_hit(corners, origin, direction):
    """Distance along a ray to the first triangle, or None (Moeller, Trumbore 1997)."""
    best = None
    for a, b, c in corners:
        e, f = add(b, a, -1.0), add(c, a, -1.0)
        p = cross(direction, f)
        det = dot(e, p)
        if abs(det) < 1e-12:
            continue
        t = add(origin, a, -1.0)
        u = dot(t, p) / det
        q = cross(t, e)
        v = dot(direction, q) / det
        s = dot(f, q) / det
        if u >= 0 and v >= 0 and u + v <= 1 and s > 0 and (best is None or s < best):
            best = s
    return best


def main():
    count, folder = int(sys.argv[1]), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    draw = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    fissure = course.Fissure(course.FISSURE)
    corners = triangles(SURFACE)
    q = orientation(fissure.direction(course.RIGHT_LEAN), fissure.up)
    for k in range(count):
        along, lift, angle = draw.uniform(*ALONG), draw.uniform(*LIFT), draw.uniform(0, 2 * math.pi)
        outside = fissure.place(along, -20, lift)
        distance = first_hit(corners, outside, fissure.inward)
        if distance is None:
            sys.exit("error: no cortex at along %.1f mm, lift %.1f mm" % (along, lift))
        cortex = add(outside, fissure.inward, distance)
        drag = [DRAG_MM * (math.cos(angle) * x + math.sin(angle) * y) for x, y in zip(fissure.front, fissure.up)]

        def place(at):
            return add(add(cortex, fissure.inward, at[0]), drag, at[1])

        for name, rows in (("tap", TAP), ("drag", DRAG)):
            probes.write(folder / ("%s_%02d.csv" % (name, k)), {"right": (q, probes.moves(rows, place), probes.never)})


if __name__ == "__main__":
    main()
