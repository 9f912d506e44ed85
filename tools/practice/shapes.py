# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain shapes as triangles and tetrahedra, in millimetres: trays, posts, pads. Surfaces point outward."""
import itertools
import math

# A cube in six tetrahedra around its diagonal: one for each order of stepping along the axes.
ORDERS = list(itertools.permutations(range(3)))


def even(order):
    return sum(order[i] > order[j] for i in range(3) for j in range(i + 1, 3)) % 2 == 0


def pad(cells, low, high, shape=lambda p: p):
    """Nodes and tetrahedra (from 1) of a box of cells[0] x cells[1] x cells[2] cubes whose nodes `shape` moves."""
    n = [c + 1 for c in cells]
    nodes = [
        shape([low[a] + (high[a] - low[a]) * i[a] / cells[a] for a in range(3)])
        for i in itertools.product(*(range(m) for m in n))
    ]
    tets = []
    for corner in itertools.product(*(range(c) for c in cells)):
        for order in ORDERS:
            at = list(corner)
            tet = [1 + (at[0] * n[1] + at[1]) * n[2] + at[2]]
            for axis in order:
                at[axis] += 1
                tet.append(1 + (at[0] * n[1] + at[1]) * n[2] + at[2])
            if not even(order):
                tet[2], tet[3] = tet[3], tet[2]
            tets.append(tet)
    return nodes, tets


def outline(half_x, half_y, corner, each=6):
    """A rectangle with round corners, counter-clockwise."""
    points = []
    for quarter, (sx, sy) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        for k in range(each + 1):
            a = 0.5 * math.pi * (quarter + k / each)
            points.append(
                (sx * (half_x - corner) + corner * math.cos(a), sy * (half_y - corner) + corner * math.sin(a))
            )
    return points


def circle(x, y, radius, n):
    return [(x + radius * math.cos(2 * math.pi * k / n), y + radius * math.sin(2 * math.pi * k / n)) for k in range(n)]


class Surface:
    def __init__(self):
        self.vertices, self.triangles = [], []

    def add(self, p):
        self.vertices.append(p)
        return len(self.vertices)

    def rings(self, rings):
        """Joins closed rings of equal length, each with the next; the first and the last one are closed by fans."""
        n = len(rings[0])
        at = [[self.add(p) for p in ring] for ring in rings]
        for a, b in zip(at, at[1:]):
            for k in range(n):
                m = (k + 1) % n
                self.triangles += [(a[k], a[m], b[m]), (a[k], b[m], b[k])]
        for ring, numbers, outward in ((rings[0], at[0], -1), (rings[-1], at[-1], 1)):
            middle = self.add([sum(p[i] for p in ring) / n for i in range(3)])
            for k in range(n):
                pair = (numbers[k], numbers[(k + 1) % n])
                self.triangles.append((middle, *pair) if outward > 0 else (middle, pair[1], pair[0]))
        return self

    def obj(self):
        lines = ["# SPDX-License-Identifier: GPL-3.0-or-later"]
        lines += ["v %.5g %.5g %.5g" % tuple(x + 0.0 for x in p) for p in self.vertices]
        return "\n".join(lines + ["f %d %d %d" % t for t in self.triangles] + [""])


def plate(radius, low, high, n=48):
    """A round plate."""
    return Surface().rings([[(x, y, z) for x, y in circle(0, 0, radius, n)] for z in (low, high)])


def tray(half_x, half_y, height, corner=7, wall=2.5):
    """A tray with round corners whose floor is at z = 0."""
    profile = [(0, -2.5), (0, height - 0.8), (-0.8, height), (-wall + 0.8, height), (-wall, height - 0.8)]
    profile += [(-wall, 2), (-wall - 0.6, 0.6), (-wall - 2, 0)]
    rings = []
    for inset, z in profile:
        points = outline(half_x + inset, half_y + inset, corner + inset)
        rings.append([(x, y, z) for x, y in points])
    return Surface().rings(rings)


def post(surface, x, y, radius, height, n=20):
    """A round post that stands on z = 0 with a bevelled top."""
    profile = [(radius + 0.6, 0), (radius, 0.8), (radius, height - 0.6), (radius - 0.6, height)]
    return surface.rings([[(px, py, z) for px, py in circle(x, y, r, n)] for r, z in profile])


def block(low, high):
    """A block with bevelled upper edges."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    rings = []
    for inset, z in ((0, z0), (0, z1 - 0.6), (0.6, z1)):
        a, b, c, d = x0 + inset, y0 + inset, x1 - inset, y1 - inset
        rings.append([(a, b, z), (c, b, z), (c, d, z), (a, d, z)])
    return Surface().rings(rings)


def msh(nodes, tets):
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes))]
    lines += ["%d %.6g %.6g %.6g" % (i, *p) for i, p in enumerate(nodes, 1)]
    lines += ["$EndNodes", "$Elements", str(len(tets))]
    lines += ["%d 4 2 1 1 %d %d %d %d" % (i, *t) for i, t in enumerate(tets, 1)]
    return "\n".join(lines + ["$EndElements", ""])
