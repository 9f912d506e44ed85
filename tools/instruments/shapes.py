# SPDX-License-Identifier: GPL-3.0-or-later
"""Building blocks of instruments: spines, bars swept along them and teardrop plates. Lengths in mm."""
import math
from bisect import bisect_right

from mesh import Mesh
from vec import add, combine, cross, dot, lerp, norm, sub, unit

ARC_STEP = math.radians(5.0)


class Spine:
    """A polyline with rounded corners, measured by the arc length s from its first point.

    `frame(s)` gives (point, tangent t, normal n, binormal b = t x n); n is carried along without twist from
    `normal` at the first point. Beyond its ends the spine goes on straight.
    """

    def __init__(self, points, fillet=0.0, normal=(1.0, 0.0, 0.0)):
        pts = [tuple(map(float, p)) for p in points]
        fillets = fillet if isinstance(fillet, list) else [fillet] * (len(pts) - 2)
        if len(fillets) != len(pts) - 2:
            raise ValueError("a spine needs one fillet radius for each inner point")
        path = [pts[0]]
        for i in range(1, len(pts) - 1):
            path += self._corner(pts[i - 1], pts[i], pts[i + 1], fillets[i - 1])
        path.append(pts[-1])
        self.points = path
        self.s = [0.0]
        for p, q in zip(path, path[1:]):
            self.s.append(self.s[-1] + norm(sub(q, p)))
        self.length = self.s[-1]
        legs = [unit(sub(q, p)) for p, q in zip(path, path[1:])]
        self.tangents = [legs[0]] + [unit(add(p, q)) for p, q in zip(legs, legs[1:])] + [legs[-1]]
        self.normals = []
        n = tuple(map(float, normal))
        for t in self.tangents:
            n = unit(combine(n, (-dot(n, t), t)))
            self.normals.append(n)

    @staticmethod
    def _corner(before, corner, after, radius):
        """Points of the arc of the given radius tangent to both legs."""
        d1, d2 = unit(sub(corner, before)), unit(sub(after, corner))
        turn = math.acos(max(-1.0, min(1.0, dot(d1, d2))))
        if radius <= 0.0 or turn < 1e-6:
            return [corner]
        cut = radius * math.tan(turn / 2.0)
        if cut >= min(norm(sub(corner, before)), norm(sub(after, corner))):
            raise ValueError(f"a fillet of {radius} mm does not fit at {corner}")
        start = combine(corner, (-cut, d1))
        side = unit(combine(d2, (-dot(d2, d1), d1)))
        steps = max(2, math.ceil(turn / ARC_STEP))
        return [combine(start, (radius * math.sin(turn * k / steps), d1),
                        (radius * (1.0 - math.cos(turn * k / steps)), side)) for k in range(steps + 1)]

    def frame(self, s):
        i = min(max(bisect_right(self.s, s) - 1, 0), len(self.s) - 2)
        k = (s - self.s[i]) / (self.s[i + 1] - self.s[i])
        p = lerp(self.points[i], self.points[i + 1], k)
        k = min(max(k, 0.0), 1.0)
        t = unit(lerp(self.tangents[i], self.tangents[i + 1], k))
        n = lerp(self.normals[i], self.normals[i + 1], k)
        n = unit(combine(n, (-dot(n, t), t)))
        return p, t, n, cross(t, n)

    def between(self, s0, s1):
        """Arc lengths of the spine's own points strictly between s0 and s1, in that direction."""
        inner = [s for s in self.s if min(s0, s1) + 1e-6 < s < max(s0, s1) - 1e-6]
        return inner if s0 <= s1 else inner[::-1]


def section(sides, wx, wy, kind):
    """Points of a cross-section with half extents wx (along n) and wy (along b), counter-clockwise about t.

    `round` is a stadium (a circle when wx = wy), `lens` has sharp edges at +-b. sides = 4 m + 2 puts a vertex on
    each edge and none on the middle of the flats, where the two halves of a stadium part.
    """
    out = []
    r = min(wx, wy)
    for k in range(sides):
        angle = (k + 0.5) * 2.0 * math.pi / sides
        c, s = math.cos(angle), math.sin(angle)
        if abs(c) < 1e-9:
            c = 0.0
        if kind == "lens":
            out.append((wx * c * abs(c), wy * s))
        elif kind == "round":
            out.append((r * c + math.copysign(wx - r, c) * (c != 0.0), r * s + math.copysign(wy - r, s)))
        else:
            raise ValueError(f'unknown section "{kind}" (round, lens)')
    return out


def expand_stations(spine, stations, dome_start=None, dome_end=None, knurl=None, max_step=1e9):
    """Rings (s, wx, wy, phase) along a bar: its stations, the spine's bends between, domes and knurling."""
    st = [(float(x[0]), float(x[1]), float(x[2] if len(x) > 2 else x[1])) for x in stations]

    def dome(end, other, spec):
        length, thin = float(spec["length"]), float(spec.get("thickness", 0.0))
        direction = 1.0 if other[0] > end[0] else -1.0
        rings = []
        for k in range(1, 9):
            phi = math.pi / 2.0 * k / 8.0
            depth = length * (1.0 - math.cos(phi))
            span = abs(other[0] - end[0])
            f = min(depth / span, 1.0)
            wx, wy = end[1] + (other[1] - end[1]) * f, end[2] + (other[2] - end[2]) * f
            scale = math.sin(phi)
            rings.append((end[0] + direction * depth, wx * max(thin, scale), wy * scale))
        return rings

    rows = list(st)
    if dome_start:
        rows = dome(st[0], st[1], dome_start) + rows[1:]
    if dome_end:
        rows = rows[:-1] + dome(st[-1], st[-2], dome_end)[::-1]
    out = [rows[0] + (0,)]
    for a, b in zip(rows, rows[1:]):
        inner = spine.between(a[0], b[0])
        if knurl and knurl["from"] - 1e-9 <= a[0] and b[0] <= knurl["to"] + 1e-9 and b[0] > a[0]:
            count = max(2, round((b[0] - a[0]) / knurl["pitch"]))
            inner = [a[0] + (b[0] - a[0]) * k / count for k in range(1, count)]
            flags = [1 + k % 2 for k in range(len(inner))]
        else:
            count = math.ceil(abs(b[0] - a[0]) / max_step)
            inner = sorted(inner + [a[0] + (b[0] - a[0]) * k / count for k in range(1, count)],
                           reverse=b[0] < a[0])
            flags = [0] * len(inner)
        for s, flag in zip(inner, flags):
            f = (s - a[0]) / (b[0] - a[0])
            out.append((s, a[1] + (b[1] - a[1]) * f, a[2] + (b[2] - a[2]) * f, flag))
        out.append(b + (0,))
    # A dome may end exactly on the next station: keep one ring of each.
    return [r for i, r in enumerate(out) if i == 0 or max(abs(x - y) for x, y in zip(r[:3], out[i - 1][:3])) > 1e-9]


def bar(spine, stations, sides=18, kind="round", dome_start=None, dome_end=None, knurl=None, max_step=1e9,
        offset=(0.0, 0.0)):
    """A closed bar or tube. The stations are a profile (s, half extent[s]) that may turn back: a bore is a profile
    that begins inside. Flat caps close both ends; domes are measured from the end stations; `offset` moves the bar
    along n and b."""
    rings = expand_stations(spine, stations, dome_start, dome_end, knurl, max_step)
    mesh = Mesh()
    rows = []
    for s, wx, wy, flag in rings:
        p, _, n, b = spine.frame(s)
        p = combine(p, (offset[0], n), (offset[1], b))
        row = []
        for k, (x, y) in enumerate(section(sides, wx, wy, kind)):
            if flag:
                # A diamond knurl: every other vertex stands proud, shifted from ring to ring.
                grow = 1.0 + ((k + flag) % 2) * knurl["depth"] / max(wx, 1e-9)
                x, y = x * grow, y * grow
            row.append(mesh.vertex(combine(p, (x, n), (y, b))))
        rows.append(row)
    ends = []
    for s in (float(stations[0][0]), float(stations[-1][0])):
        p, _, n, b = spine.frame(s)
        ends.append(mesh.vertex(combine(p, (offset[0], n), (offset[1], b))))
    first, last = ends
    for k in range(sides):
        j = (k + 1) % sides
        mesh.faces.append((first, rows[0][j], rows[0][k]))
        for a, b in zip(rows, rows[1:]):
            mesh.quad(a[k], a[j], b[j], b[k])
        mesh.faces.append((last, rows[-1][k], rows[-1][j]))
    return mesh.orient_outward()


def teardrop(count, r1, r2, length):
    """Outline of the convex hull of two circles, r1 at 0 and r2 at `length` along the first axis."""
    out = []
    edge = math.acos(max(-1.0, min(1.0, (r1 - r2) / length))) if length > 0.0 else 0.0
    for k in range(count):
        angle = (k + 0.5) * 2.0 * math.pi / count
        fold = abs((angle + math.pi) % (2.0 * math.pi) - math.pi)
        r, shift = (r2, length) if fold < edge else (r1, 0.0)
        out.append((shift + r * math.cos(angle), r * math.sin(angle)))
    return out


def plate(spine, s, offset, r1, r2, length, thickness, bevel, hole, count=48, turn_deg=0.0):
    """A flat teardrop plate with a teardrop hole, in the plane (t, b) at height `offset` along n from the spine.

    `hole` = [r1, r2, length, shift]; the large end r1 sits at s. `turn_deg` tilts the plate about b.
    """
    p, t, n, b = spine.frame(s)
    c, w = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    t, n = combine((0.0, 0.0, 0.0), (c, t), (w, n)), combine((0.0, 0.0, 0.0), (c, n), (-w, t))
    p = combine(p, (offset, n))
    outer, inset = teardrop(count, r1, r2, length), teardrop(count, r1 - bevel, r2 - bevel, length)
    inner = [(x + hole[3], y) for x, y in teardrop(count, hole[0], hole[1], hole[2])]
    wide = [(x + hole[3], y) for x, y in teardrop(count, hole[0] + bevel, hole[1] + bevel, hole[2])]
    h = thickness / 2.0
    loops = [(inner, bevel - h), (inner, h - bevel), (wide, h), (inset, h), (outer, h - bevel), (outer, bevel - h),
             (inset, -h), (wide, -h)]
    mesh = Mesh()
    rows = [[mesh.vertex(combine(p, (x, t), (y, b), (z, n))) for x, y in ring] for ring, z in loops]
    for i, a in enumerate(rows):
        d = rows[(i + 1) % len(rows)]
        for k in range(count):
            j = (k + 1) % count
            mesh.quad(a[k], a[j], d[j], d[k])
    return mesh.orient_outward()
