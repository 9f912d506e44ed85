# SPDX-License-Identifier: GPL-3.0-or-later
"""The straight tube that is clipped: vessel.json with one region and one centreline, and its wall, in millimetres."""
import json
import math

from layout import TUBE_AXIS, TUBE_LENGTH, TUBE_MIDDLE, TUBE_RADIUS

AROUND, ALONG = 14, 30


def place(along, side, up):
    """Of a point by its place along the tube, to its left side and upward."""
    n = math.hypot(*TUBE_AXIS)
    a = [x / n for x in TUBE_AXIS]
    return [TUBE_MIDDLE[0] + along * a[0] - side * a[1], TUBE_MIDDLE[1] + along * a[1] + side * a[0],
            TUBE_MIDDLE[2] + up]


def wall():
    """Vertices and triangles, outward; the last two vertices are the middles of the ends."""
    vertices, triangles = [], []
    for j in range(ALONG + 1):
        for i in range(AROUND):
            angle = 2 * math.pi * (i + 0.5 * (j % 2)) / AROUND
            along = TUBE_LENGTH * (j / ALONG - 0.5)
            vertices.append(place(along, TUBE_RADIUS * math.cos(angle), TUBE_RADIUS * math.sin(angle)))
    for j in range(ALONG):
        for i in range(AROUND):
            a, b = j * AROUND + i, j * AROUND + (i + 1) % AROUND
            c, d = a + AROUND, b + AROUND
            triangles += [(a, b, c), (b, d, c)] if j % 2 == 0 else [(a, b, d), (a, d, c)]
    ends = []
    for j, half in ((0, -0.5), (ALONG, 0.5)):
        middle = len(vertices)
        vertices.append(place(half * TUBE_LENGTH, 0, 0))
        first = len(triangles)
        for i in range(AROUND):
            a, b = j * AROUND + i, j * AROUND + (i + 1) % AROUND
            triangles.append((middle, b, a) if half < 0 else (middle, a, b))
        ends.append(list(range(first, len(triangles))))
    return vertices, triangles, ends


def ply(vertices, triangles):
    lines = ["ply", "format ascii 1.0", "element vertex %d" % len(vertices)]
    lines += ["property double " + axis for axis in "xyz"]
    lines += ["element face %d" % len(triangles), "property list uchar int vertex_indices", "end_header"]
    lines += ["%.5f %.5f %.5f" % tuple(x + 0.0 for x in v) for v in vertices]
    return "\n".join(lines + ["3 %d %d %d" % t for t in triangles] + [""])


def files():
    """Name, description and text of each file."""
    vertices, triangles, (inlet, outlet) = wall()
    points = [[round(x, 5) for x in place(TUBE_LENGTH * (k / 10 - 0.5), 0, 0)] for k in range(11)]
    vessel = dict(
        unit="mm",
        regions=["tube"],
        vertex_region=[0] * len(vertices),
        caps=[dict(name="inlet", triangles=inlet), dict(name="outlet", triangles=outlet)],
        centrelines=[
            {"name": "tube", "region": "tube", "from": "inlet", "to": "outlet", "points": points,
             "radius": [TUBE_RADIUS] * len(points)}
        ],
    )
    yield "vessel.json", "the tube: region, ends, centreline", json.dumps(vessel) + "\n"
    yield "wall.ply", "wall of the tube, its middle surface", ply(vertices, triangles)
