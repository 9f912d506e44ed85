#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Generates the drilled bone window (bone, dura, skin edge, drape) from the dimensions in bone_window.json.

    bone_window.py [--parameters FILE] [--out DIR]

Each piece is a closed ring around the opening: a loop of cross-section points (d, h) carried around the rim, where d is
the distance outward from the rim and h the height above the bone's inner table, both in mm. Vertex colours tell the
bone tables from the spongy layer between them. The same parameters always give the same bytes.
"""
import argparse
import json
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from generate import LICENCE, ROOT, manifest_entry, write  # noqa: E402
from mesh import Mesh, obj_text  # noqa: E402
from vec import combine, cross, lerp, unit  # noqa: E402
from window_fit import height  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
FLATTEN_FROM = 34.0  # beyond this radius the head's curvature eases off, so that the drape lies like cloth

IVORY, OUTER, DIPLOE, MARROW = (0.93, 0.88, 0.77), (0.90, 0.83, 0.70), (0.78, 0.54, 0.43), (0.52, 0.20, 0.16)
DURA, DURA_VESSEL, DURA_EDGE = (0.80, 0.70, 0.64), (0.58, 0.25, 0.22), (0.90, 0.84, 0.78)
SKIN, FAT, GALEA = (0.80, 0.61, 0.51), (0.85, 0.68, 0.40), (0.64, 0.25, 0.21)
CLOTH, HEM = (0.07, 0.34, 0.29), (0.05, 0.27, 0.23)


def clamp01(x):
    return min(1.0, max(0.0, x))


def smoothstep(a, b, x):
    t = clamp01((x - a) / (b - a))
    return t * t * (3.0 - 2.0 * t)


def hash01(*keys):
    """A repeatable value in [0, 1) from integers (integer mixing only, so the same on every machine)."""
    h = 2166136261
    for k in keys:
        h = ((h ^ (k & 0xFFFFFFFF)) * 16777619) & 0xFFFFFFFF
        h ^= h >> 13
        h = (h * 1540483477) & 0xFFFFFFFF
        h ^= h >> 15
    return h / 4294967296.0


def value_noise(seed, x, y):
    """Smooth noise in [-1, 1] on the unit lattice."""
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3.0 - 2.0 * u), v * v * (3.0 - 2.0 * v)
    a, b = hash01(seed, i, j), hash01(seed, i + 1, j)
    c, d = hash01(seed, i, j + 1), hash01(seed, i + 1, j + 1)
    return 2.0 * (a + (b - a) * u + (c - a) * v + (a - b - c + d) * u * v) - 1.0


def ring_noise(seed, theta, waves):
    """Smooth periodic noise around the rim with about `waves` bumps."""
    r = waves / (2.0 * math.pi)
    return value_noise(seed, 50.0 + r * math.cos(theta), 50.0 + r * math.sin(theta))


def fractal(seed, x, y):
    return value_noise(seed, x, y) + 0.5 * value_noise(seed + 1, 2.1 * x, 2.1 * y)


class Window:
    """The field's frame, the inner table and the rim of the opening."""

    def __init__(self, par):
        self.par = par
        self.n = unit(tuple(par["normal"]))
        up = tuple(par["up"])
        self.x = unit(cross(up, self.n))
        self.y = cross(self.n, self.x)
        self.centre = tuple(par["centre"])
        self.c = par["surface"]

    def table(self, x, y):
        """Height of the inner table over the field's plane, its curvature eased far out."""
        r = math.hypot(x, y)
        if r <= FLATTEN_FROM:
            return height(self.c, x, y)
        ex, ey = x / r, y / r
        x0, y0 = ex * FLATTEN_FROM, ey * FLATTEN_FROM
        slope = (
            self.c[1] * ex
            + self.c[2] * ey
            + 2.0 * (self.c[3] * x0 * ex + self.c[5] * y0 * ey)
            + self.c[4] * (x0 * ey + y0 * ex)
        )
        # A gentle slope common to all directions, so that no side of the drape drops out of sight.
        far = r - FLATTEN_FROM
        blend = 1.0 - math.exp(-far / 14.0)
        return height(self.c, x0, y0) + (slope + 0.30) * 14.0 * blend - 0.30 * far

    def point(self, theta, radius, h):
        """h above the inner table along its normal, at the polar position (theta, radius)."""
        x, y = radius * math.cos(theta), radius * math.sin(theta)
        e = 0.05
        gx = (self.table(x + e, y) - self.table(x - e, y)) / (2.0 * e)
        gy = (self.table(x, y + e) - self.table(x, y - e)) / (2.0 * e)
        m = unit((-gx, -gy, 1.0))
        p = combine(self.centre, (x, self.x), (y, self.y), (self.table(x, y), self.n))
        return combine(p, (h * m[0], self.x), (h * m[1], self.y), (h * m[2], self.n))

    def oval(self, theta, grow=0.0):
        o = self.par["opening"]
        a, b = o["long_axis"] / 2.0 + grow, o["short_axis"] / 2.0 + grow
        t = theta - math.radians(o["turn_deg"])
        # A superellipse of exponent 2.3: a little squarer than an ellipse, as cut by hand between burr holes.
        return (abs(math.cos(t) / a) ** 2.3 + abs(math.sin(t) / b) ** 2.3) ** (-1.0 / 2.3)

    def rim(self, theta):
        """Radius of the rim at the inner table: the oval, the burr holes' scallops, the drill's wander."""
        o = self.par["opening"]
        r = self.oval(theta)
        for hole in o["burr_holes"]:
            at, rad = math.radians(hole["angle_deg"]), hole["diameter"] / 2.0
            reach = self.oval(at) + hole["protrusion"] - rad
            side = reach * math.sin(theta - at)
            if abs(side) < rad and math.cos(theta - at) > 0.0:
                r = max(r, reach * math.cos(theta - at) + math.sqrt(rad * rad - side * side))
        return r + o["roughness"] * (1.6 * ring_noise(11, theta, 9) + 0.7 * ring_noise(12, theta, 34))


def ring_mesh(window, count, loop):
    """Closed ring: loop(theta) gives [(radius, h, colour)], the same number of points at every angle."""
    mesh, columns = Mesh(), []
    for k in range(count):
        theta = 2.0 * math.pi * k / count
        columns.append([mesh.vertex(window.point(theta, r, h), colour) for r, h, colour in loop(theta)])
    size = len(columns[0])
    for k in range(count):
        a, b = columns[k], columns[(k + 1) % count]
        for i in range(size):
            j = (i + 1) % size
            mesh.quad(a[i], b[i], b[j], a[j])
    return mesh.orient_outward()


def bone(window):
    b, thick = window.par["bone"], window.par["bone"]["thickness"]
    heights = [0.0, 0.5, b["inner_table"]]
    spongy = 6
    top = thick - b["outer_table"]
    heights += [b["inner_table"] + (top - b["inner_table"]) * k / spongy for k in range(1, spongy + 1)]
    heights += [thick - b["bevel"], thick - 0.55 * b["bevel"], thick - 0.15 * b["bevel"], thick]

    def loop(theta):
        rim, out = window.rim(theta), []
        for h in heights:
            d = b["flare"] * h / thick
            over = max(0.0, h - (thick - b["bevel"])) / b["bevel"]
            d += b["bevel"] * (over**1.6) + (0.3 * (1.0 - h / 0.5) if h < 0.5 else 0.0)
            arc = theta * rim
            grain = fractal(21, arc * 1.1, h * 1.3)
            inside = smoothstep(b["inner_table"] - 0.2, b["inner_table"] + 0.3, h) * (
                1.0 - smoothstep(top - 0.3, top + 0.2, h)
            )
            pore = smoothstep(0.15, 0.75, grain) * inside
            d += 0.55 * pore + 0.10 * inside + 0.06 * value_noise(23, arc * 0.7, h)
            colour = lerp(lerp(IVORY, DIPLOE, 0.85 * inside), MARROW, pore)
            out.append((rim + d, h, colour))
        edge = b["flare"] + b["bevel"]
        for k, d in enumerate((0.5, 1.2, 2.2, 3.6, 5.2, 7.0, 9.0, 11.0, 13.5, 19.0, b["width"] - 1.0)):
            r = rim + edge + d
            x, y = r * math.cos(theta), r * math.sin(theta)
            stain = smoothstep(0.0, 1.0, fractal(31, 0.22 * x, 0.22 * y)) * 0.42 + 0.25 * math.exp(-d / 1.2)
            tone = lerp(OUTER, (0.80, 0.62, 0.50), stain)
            out.append((r, thick + 0.16 * fractal(33, 0.30 * x, 0.30 * y) * smoothstep(0.0, 1.5, d), tone))
        # Outer side and inner table, out of sight: coarse.
        out += [
            (rim + edge + b["width"], thick - 1.0, OUTER),
            (rim + edge + b["width"], 1.0, IVORY),
            (rim + edge + b["width"] - 1.0, 0.0, IVORY),
            (rim + 14.0, 0.0, IVORY),
            (rim + 6.0, 0.0, IVORY),
            (rim + 2.0, 0.0, IVORY),
        ]
        return out

    return ring_mesh(window, 240, loop)


def smooth_path(points, per_leg):
    """Catmull-Rom points through a planar polyline, with their arc lengths."""
    pts = [points[0]] + points + [points[-1]]
    out = []
    for i in range(1, len(pts) - 2):
        p0, p1, p2, p3 = pts[i - 1], pts[i], pts[i + 1], pts[i + 2]
        for k in range(per_leg):
            t = k / per_leg
            out.append(
                tuple(
                    0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t**3)
                    for a, b, c, d in zip(p0, p1, p2, p3)
                )
            )
    out.append(points[-1])
    s = [0.0]
    for p, q in zip(out, out[1:]):
        s.append(s[-1] + math.hypot(q[0] - p[0], q[1] - p[1]))
    return out, s


def along(path, s, at):
    """Point and direction of a path at the arc length `at`."""
    i = 0
    while i < len(s) - 2 and s[i + 1] < at:
        i += 1
    k = (at - s[i]) / (s[i + 1] - s[i])
    p, q = path[i], path[i + 1]
    length = math.hypot(q[0] - p[0], q[1] - p[1])
    return ((p[0] + (q[0] - p[0]) * k, p[1] + (q[1] - p[1]) * k), ((q[0] - p[0]) / length, (q[1] - p[1]) / length))


def dura(window):
    b, u = window.par["bone"], window.par["dura"]
    thick, half = b["thickness"], u["thickness"] / 2.0
    edge = b["flare"] + b["bevel"]
    under = -0.25 - half
    path, s = smooth_path(
        [
            (8.0, under),
            (1.5, under),
            (-u["strip"], under + 0.1),
            (-u["strip"] - 0.5, 1.6),
            (-0.5, 0.55 * thick),
            (0.2, thick + 0.2),
            (edge + 0.2, thick + 1.25),
            (edge + 3.0, thick + 0.85),
            (edge + 7.0, thick + 0.85),
            (edge + u["flap_length"], thick + 0.8),
        ],
        8,
    )
    short = 8.0 + u["strip"] + 0.2
    rows = 22

    def loop(theta):
        rim = window.rim(theta)
        turn = (theta - math.radians(u["flap_angle_deg"]) + math.pi) % (2.0 * math.pi) - math.pi
        flap = 1.0 - smoothstep(0.50, 1.0, abs(turn) / math.radians(u["flap_half_width_deg"]))
        length = (
            short
            + (s[-1] - short) * flap * (0.94 + 0.06 * ring_noise(41, theta, 16))
            + 0.35 * ring_noise(42, theta, 22)
        )
        length = min(length, s[-1])
        upper, lower = [], []
        for k in range(rows + 1):
            at = length * k / rows
            (d, h), (td, th) = along(path, s, at)
            # Folds run from the rim to the flap's free edge and grow towards it.
            fold = 0.5 * (1.0 + math.sin(26.0 * theta + 1.5 * ring_noise(43, theta, 5)))
            h += flap * 0.9 * smoothstep(16.0, 26.0, at) * fold**2
            free = math.sqrt(clamp01((length - at) / (2.0 * half))) if k == rows else 1.0
            # Branches of the meningeal artery over the sheet.
            vein = min(abs(turn - 0.22 - 0.012 * at - 0.05 * math.sin(0.5 * at)), abs(turn + 0.35 + 0.016 * at)) * rim
            colour = lerp(DURA, DURA_VESSEL, 0.75 * flap * (1.0 - smoothstep(0.3, 1.3, vein)))
            colour = lerp(colour, DURA_EDGE, smoothstep(1.2, 0.2, length - at) if length - at < 1.2 else 0.0)
            tone = 0.06 * fractal(45, 0.5 * theta * rim, 0.4 * at)
            colour = tuple(clamp01(c + tone) for c in colour)
            w = half * max(free, 0.4)
            upper.append((rim + d - w * th, h + w * td, colour))
            lower.append((rim + d + w * th, h - w * td, colour))
        return upper + lower[::-1]

    return ring_mesh(window, 200, loop)


def skin_edge(window, theta):
    """Radius at which the skin's edge uncovers the bone."""
    return window.oval(theta, window.par["skin"]["exposure"]) + 0.9 * ring_noise(51, theta, 8)


def skin(window):
    k, base = window.par["skin"], window.par["bone"]["thickness"] + 0.25
    thick = k["thickness"]
    profile = [
        (0.6, 0.0, GALEA),
        (0.0, 0.5, GALEA),
        (-0.3, 1.2, FAT),
        (-0.4, 2.2, FAT),
        (-0.3, 3.2, FAT),
        (0.0, thick - 1.3, (0.78, 0.42, 0.33)),
        (0.5, thick - 0.5, SKIN),
        (1.3, thick - 0.1, SKIN),
        (2.4, thick + 0.1, SKIN),
        (4.5, thick, SKIN),
        (8.0, thick, SKIN),
        (14.0, thick, SKIN),
        (k["width"], thick - 0.5, SKIN),
        (k["width"], 0.0, GALEA),
        (9.0, 0.0, GALEA),
    ]

    def loop(theta):
        r0, out = skin_edge(window, theta), []
        for i, (d, h, colour) in enumerate(profile):
            lump = value_noise(53, 1.1 * theta * r0 / 2.0, 0.9 * h) if 0 < i < 6 else 0.0
            tone = 0.07 * fractal(54, 0.8 * theta * r0, d + h)
            out.append((r0 + d - 0.35 * lump, base + h, tuple(clamp01(c + tone) for c in colour)))
        return out

    return ring_mesh(window, 180, loop)


def drape(window):
    d = window.par["drape"]
    base = window.par["bone"]["thickness"] + 0.25 + window.par["skin"]["thickness"] + 0.25
    thick = d["thickness"]

    def loop(theta):
        r0 = skin_edge(window, theta) + d["overlap"] + 0.5 * ring_noise(61, theta, 12)
        steps = [
            0.0,
            0.25,
            0.7,
            1.4,
            2.2,
            3.0,
            3.4,
            4.5,
            7.0,
            10.0,
            13.5,
            17.0,
            21.0,
            25.0,
            30.0,
            35.0,
            41.0,
            48.0,
            56.0,
            65.0,
        ]
        last = max(d["outer_radius"] - r0, 70.0)
        steps = steps + [65.0 + (last - 65.0) * k / 6.0 for k in range(1, 7)]
        upper, lower = [], []
        for i, e in enumerate(steps):
            r = r0 + e
            x, y = r * math.cos(theta), r * math.sin(theta)
            rise = smoothstep(2.0, 30.0, e)
            radial = math.sin(9.0 * theta + 2.4 * ring_noise(62, theta, 4) + 0.012 * e)
            h = base + rise * (2.6 * max(0.0, radial) ** 2 + 2.2 * (1.0 + value_noise(63, 0.045 * x, 0.045 * y)))
            # The folded hem is twice as thick as the cloth and rounded.
            hem = (math.sqrt(clamp01(e / 0.7)) if e < 0.7 else 1.0) * (1.0 - 0.5 * smoothstep(3.0, 3.4, e))
            colour = lerp(HEM, CLOTH, smoothstep(2.6, 3.6, e))
            tone = 0.018 * value_noise(64, 0.09 * x, 0.09 * y)
            colour = tuple(clamp01(c + tone) for c in colour)
            upper.append((r, h + 2.0 * thick * max(hem, 0.25), colour))
            if i in (0, 8, 16, len(steps) - 1):
                lower.append((r, h, colour))
        return upper + lower[::-1]

    return ring_mesh(window, 180, loop)


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parameters", default=os.path.join(HERE, "bone_window.json"))
    parser.add_argument("--out", default=os.path.join(ROOT, "meshes", "window"))
    args = parser.parse_args(argv)
    with open(args.parameters, encoding="utf-8") as f:
        par = json.load(f)
    parameters = os.path.basename(args.parameters)
    source = "generated by tools/instruments/bone_window.py from tools/instruments/" + parameters
    rebuild = "python3 tools/instruments/bone_window.py"
    if parameters != os.path.basename(parser.get_default("parameters")):
        rebuild += " --parameters tools/instruments/%s --out meshes/%s" % (parameters, os.path.basename(args.out))
    window, manifest = Window(par), []
    for name, build in (("bone", bone), ("drape", drape), ("dura", dura), ("skin", skin)):
        mesh = build(window)
        mesh.check_closed(name)
        text = obj_text(
            mesh, name, [f"SPDX-License-Identifier: {LICENCE}", f'Unit: mm, frame: {par["frame"]}. {source}.'], 50.0
        )
        write(os.path.join(args.out, name + ".obj"), text)
        manifest.append(
            manifest_entry(
                name + ".obj",
                text,
                len(mesh.faces),
                par["frame"],
                source,
                rebuild,
                "mm",
            )
        )
        print(f"{name}: {len(mesh.faces)} triangles")
    write(os.path.join(args.out, "manifest.json"), json.dumps(manifest, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
