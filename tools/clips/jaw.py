# SPDX-License-Identifier: GPL-3.0-or-later
"""Building blocks of clips: the line that the closed blades follow, sections, and bars swept through rings. Lengths in
mm.

Body frame: the hinge axis is the y axis, the applier lies at +z, the jaws point to -z and part along x.
"""
import math

from mesh import Mesh
from vec import add, combine, cross, dot, mul, sub, unit


def turned(v, axis, angle):
    """v turned about a unit axis, right-handed."""
    c, s = math.cos(angle), math.sin(angle)
    return combine(mul(v, c), (s, cross(axis, v)), ((1.0 - c) * dot(axis, v), axis))


class Line:
    """A chain of straight pieces and arcs from the hinge to the tip, in the surface where the closed jaws meet.

    A piece is [length, turn_deg] or [length, turn_deg, "side"]. A positive turn bends towards +y within the clamping
    plane; a "side" turn bends the clamping surface itself, towards +x. `frame(s)` gives (point, tangent t, normal n of
    the clamping surface, binormal b = t x n).
    """

    def __init__(self, pieces):
        self.starts = []
        p, t, n, s = (0.0, 0.0, 0.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), 0.0
        for piece in pieces:
            length, turn = float(piece[0]), math.radians(piece[1])
            side = len(piece) > 2 and piece[2] == "side"
            if length <= 0.0 or (len(piece) > 2 and not side):
                raise ValueError(f'{piece}: a piece is [length, turn_deg] or [length, turn_deg, "side"]')
            self.starts.append((s, p, t, n, turn / length, side))
            p, t, n = self._along(self.starts[-1], length)
            s += length
        self.length = s

    @staticmethod
    def _along(start, ds):
        _, p, t, n, curvature, side = start
        # The bend goes towards `to`: -b = n x t is +y where the line begins.
        to = n if side else cross(n, t)
        angle = curvature * ds
        if abs(angle) < 1e-9:
            return combine(p, (ds, t)), t, n
        q = combine(p, (math.sin(angle) / curvature, t), ((1.0 - math.cos(angle)) / curvature, to))
        t2 = combine(mul(t, math.cos(angle)), (math.sin(angle), to))
        return q, t2, (combine(mul(n, math.cos(angle)), (-math.sin(angle), t)) if side else n)

    def frame(self, s):
        start = next((x for x in reversed(self.starts) if s >= x[0]), self.starts[0])
        p, t, n = self._along(start, s - start[0])
        return p, t, n, cross(t, n)

    def turn_between(self, a, b):
        """Angle (rad) between the tangents at two places, summed along the way."""
        steps = [self.frame(a + (b - a) * k / 16.0)[1] for k in range(17)]
        return sum(math.acos(max(-1.0, min(1.0, dot(p, q)))) for p, q in zip(steps, steps[1:]))


class Node:
    """One ring of a jaw: at `s` along the line, its centre `o` off the clamping surface and `u` sideways, its half
    extents (wx across the surface, wy along it), and how far it is from a round wire (0) to a flat-faced blade (1)."""

    def __init__(self, s, o, u, wx, wy, flat, notch=0.0):
        self.s, self.o, self.u, self.wx, self.wy, self.flat, self.notch = s, o, u, wx, wy, flat, notch


def ring_outline(node):
    """Eight points (a away from the clamping surface, b along it) of the section; the notch cuts the clamping face."""
    wx, wy, c = node.wx, node.wy, min(0.08, 0.3 * node.wx)
    k, m = math.cos(math.pi / 8.0), math.sin(math.pi / 8.0)
    wire = [(-k, m), (-m, k), (m, k), (k, m)]
    wire = [(x * wx, y * wy) for x, y in wire]
    blade = [(-wx + node.notch, wy - c), (-wx + c + node.notch, wy), (0.2 * wx, wy), (wx, 0.5 * wy)]
    half = [(p[0] + (q[0] - p[0]) * node.flat, p[1] + (q[1] - p[1]) * node.flat) for p, q in zip(wire, blade)]
    return half + [(x, -y) for x, y in half[::-1]]


def jaw_rings(line, nodes, side):
    """(rings of points, centres) of a jaw on one side (+1 or -1) of the clamping surface."""
    frames = [line.frame(x.s) for x in nodes]
    centres = [combine(f[0], (side * x.o, f[2]), (side * x.u, f[3])) for x, f in zip(nodes, frames)]
    rings = []
    for i, (x, f) in enumerate(zip(nodes, frames)):
        t = unit(sub(centres[min(i + 1, len(nodes) - 1)], centres[max(i - 1, 0)]))
        if x.flat >= 1.0:
            t = f[1]  # a blade's faces stay true, whatever its taper
        b = unit(combine(f[3], (-dot(f[3], t), t)))
        n = mul(cross(b, t), side)
        rings.append([combine(centres[i], (a, n), (w, b)) for a, w in ring_outline(x)])
    return rings, centres


def wire_rings(points, radius, axis):
    """Octagonal rings about a polyline; `axis` lies roughly across it."""
    rings = []
    for i, p in enumerate(points):
        t = unit(sub(points[min(i + 1, len(points) - 1)], points[max(i - 1, 0)]))
        b = unit(combine(axis, (-dot(axis, t), t)))
        n = cross(b, t)
        rings.append(
            [
                combine(p, (radius * math.cos(v), n), (radius * math.sin(v), b))
                for v in (math.pi / 8.0 + k * math.pi / 4.0 for k in range(8))
            ]
        )
    return rings


def bar_mesh(rings):
    """The closed surface through rings of equal count, with a flat cap at each end."""
    mesh = Mesh()
    rows = [[mesh.vertex(p) for p in ring] for ring in rings]
    count = len(rows[0])
    ends = [
        mesh.vertex(mul((sum(p[0] for p in r), sum(p[1] for p in r), sum(p[2] for p in r)), 1.0 / count))
        for r in (rings[0], rings[-1])
    ]
    for k in range(count):
        j = (k + 1) % count
        mesh.faces.append((ends[0], rows[0][j], rows[0][k]))
        for a, b in zip(rows, rows[1:]):
            mesh.quad(a[k], a[j], b[j], b[k])
        mesh.faces.append((ends[1], rows[-1][k], rows[-1][j]))
    return mesh.orient_outward()


def moved(points, shift):
    return [add(p, shift) for p in points]


def smooth(x):
    x = max(0.0, min(1.0, x))
    return x * x * (3.0 - 2.0 * x)


def mix(a, b, k):
    return a + (b - a) * k
