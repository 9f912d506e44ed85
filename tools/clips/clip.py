# SPDX-License-Identifier: GPL-3.0-or-later
"""A clip from a row of the table: coil, two crossed legs, window, shank and blades, with its contact pieces.

Everything here is in the tool frame: origin at the tip of the closed blades, +z to the applier, +x across the clamping
faces. The legs cross between coil and blades, so pressing them together opens the jaws about the coil's middle.
"""
import math

from jaw import Line, Node, bar_mesh, jaw_rings, mix, moved, smooth, turned, wire_rings
from mesh import convex_hull
from vec import add, combine, dot, mul, norm, sub

MOST_POINTS = 24


def interpolated(table, x):
    """Piecewise linear, constant beyond its ends."""
    if x <= table[0][0]:
        return table[0][1]
    for (x0, y0), (x1, y1) in zip(table, table[1:]):
        if x <= x1:
            return mix(y0, y1, (x - x0) / (x1 - x0))
    return table[-1][1]


class Clip:
    def __init__(self, row, family):
        self.row, self.par = row, dict(family, **row.get("set", {}))
        par = self.par
        self.blade_length = sum(x[0] for x in row["blade"])
        self.stem = row.get("stem", [])
        self.stem_end = par["leg_length"] + sum(x[0] for x in self.stem)
        self.window = self._window(row["fenestration"]) if "fenestration" in row else None
        pieces = [[par["leg_length"], 0]] + self.stem
        if self.window:
            pieces.append([2.0 * self.window["half_length"], 0])
        pieces += row.get("shank", [])
        self.blade_start = sum(x[0] for x in pieces)
        self.line = Line(pieces + row["blade"])
        self.shift = mul(self.line.frame(self.line.length)[0], -1.0)  # body frame -> tool frame
        self.hinge = self.shift
        self.reference = self.axis_distance(self.line.frame(self.blade_start + 0.5 * self.blade_length)[0])
        tip = self.axis_distance(self.line.frame(self.line.length)[0])
        self.opening = interpolated(par["opening"], self.blade_length)
        self.opening_max = min(math.asin(0.5 * self.opening / tip), math.radians(par["widest_deg"]))
        self.opening = 2.0 * tip * math.sin(self.opening_max)
        self.force = interpolated(par["force"], self.blade_length)
        self.slope = 1e3 * self.force * (par["force_rise"] - 1.0) / (2.0 * self.reference * math.sin(self.opening_max))

    @staticmethod
    def axis_distance(p):
        return math.hypot(p[0], p[2])

    # --- the jaw's section along the line ---------------------------------------------------------------------------
    def blade_size(self, s):
        """Half thickness and half width of the blade, without the rounding of its tip."""
        k = max(0.0, min(1.0, (s - self.blade_start) / self.blade_length))
        return tuple(0.5 * mix(a, b, k) for a, b in (self.par["thickness"], self.par["width"]))

    def _offset(self, wx):
        return wx + 0.5 * self.par["gap"]

    def _window(self, diameter):
        """The window of two half rings: arcs of radius R about the line, led in by fillets."""
        wx, wy = self.par["ring"]
        radius, fillet, start = 0.5 * diameter + wx, self.par["ring_fillet"], self._offset(wx)
        return {
            "diameter": diameter,
            "wx": wx,
            "wy": wy,
            "radius": radius,
            "fillet": fillet,
            "start": start,
            "half_length": math.sqrt((radius + fillet) ** 2 - (start + fillet) ** 2),
            "middle": self.stem_end + math.sqrt((radius + fillet) ** 2 - (start + fillet) ** 2),
        }

    def _window_path(self, steps):
        """(s, offset) from one end of the window to the other."""
        w = self.window
        d, f, r, o = w["half_length"], w["fillet"], w["radius"], w["start"]
        lead = math.atan2(d, o + f)  # turn of the fillet until it touches the ring
        out = [(-d + f * math.sin(v), o + f - f * math.cos(v)) for v in (lead * k / 3.0 for k in range(1, 3))]
        out += [(-r * math.sin(v), r * math.cos(v)) for v in (lead * (1.0 - 2.0 * k / steps) for k in range(steps + 1))]
        out += [(-s, y) for s, y in out[:2]][::-1]
        return [(w["middle"] + s, y) for s, y in out]

    def leg(self, f):
        """Node of a leg at the fraction f of the way from the coil to the blade's root: it starts beyond the other
        side."""
        par = self.par
        wx, wy = par["ring"] if self.window else self.blade_size(0.0)
        radius, wire, end = par["coil_radius"], par["wire"], self._offset(wx)
        bulge = max(par["bulge"], end)
        o = mix(-radius, bulge, smooth((f - 0.12) / 0.66)) if f < 0.78 else mix(bulge, end, smooth((f - 0.78) / 0.22))
        u = par["leg_apart"] * (1.0 - smooth((f - 0.62) / 0.3))
        k = smooth((f - 0.7) / 0.3)
        return Node(f * par["leg_length"], o, u, mix(0.97 * wire, wx, k), mix(0.97 * wire, wy, k), k)

    def _bar_nodes(self, pieces, s, half_extents, step):
        """Nodes of a bar after `s`, at bends of every `step` degrees at most."""
        wx, wy = half_extents
        out = []
        for length, turn in pieces:
            count = max(1, math.ceil(abs(turn) / step - 1e-9))
            out += [Node(s + length * k / count, self._offset(wx), 0.0, wx, wy, 1.0) for k in range(1, count + 1)]
            s += length
        return out

    def _stem_nodes(self, step):
        extents = self.par["ring"] if self.window else self.blade_size(0.0)
        return self._bar_nodes(self.stem, self.par["leg_length"], extents, step)

    def nodes(self, fine):
        par, steps = self.par, 9 if fine and not self.window else 8
        step = 18.0 if fine else 25.0
        out = [self.leg(k / steps) for k in range(steps + 1)]
        out += self._stem_nodes(step)
        if self.window:
            w = self.window
            for s, o in self._window_path(7 if fine else 8):
                k = max(0.0, (o - w["start"]) / (w["radius"] - w["start"]))
                out.append(Node(s, o, 0.0, w["wx"], w["wy"], 1.0 - 0.6 * k))
            out.append(Node(self.stem_end + 2.0 * w["half_length"], w["start"], 0.0, w["wx"], w["wy"], 1.0))
        out += self._bar_nodes(self.row.get("shank", []), out[-1].s, self.blade_size(0.0), step)
        most = par["teeth"] - (4 if self.window else 0)  # the window takes its share of the triangles
        teeth = max(2, min(most, round(self.blade_length / 0.7)))
        # The tip is rounded over `dome`; the clamping face stays flat to its end.
        dome = min(0.8 * par["width"][1], 0.3 * self.blade_length)
        bend = math.degrees(self.line.turn_between(self.blade_start, self.line.length))
        count = 2 * teeth if fine else max(4, math.ceil(bend / 12.0 - 1e-9))
        for k in range(1, count + 1):
            s = self.blade_start + (self.blade_length - dome) * k / count
            wx, wy = self.blade_size(s)
            out.append(Node(s, self._offset(wx), 0.0, wx, wy, 1.0, par["tooth_depth"] if fine and k % 2 else 0.0))
        for k in range(1, 4):
            v = 0.5 * math.pi * k / 3.0
            s = self.blade_start + self.blade_length - dome * (1.0 - math.sin(v))
            wx, wy = self.blade_size(s)
            wx *= 1.0 - 0.3 * (k / 3.0) ** 2
            out.append(Node(s, self._offset(wx), 0.0, wx, wy * max(0.3, math.cos(v)), 1.0))
        return out

    # --- surfaces ---------------------------------------------------------------------------------------------------
    def rings(self, fine=True):
        """{"body", "jaw_left", "jaw_right"}: rings of points of the coil and of each jaw; left is the jaw at -x."""
        nodes = self.nodes(fine)
        out = {
            "body": wire_rings(self.coil_points(14 if fine and self.window else 20), self.par["wire"], (0.0, 1.0, 0.0))
        }
        for name, side in (("jaw_left", -1.0), ("jaw_right", 1.0)):
            out[name] = jaw_rings(self.line, nodes, side)[0]
        return {k: [moved(r, self.shift) for r in v] for k, v in out.items()}

    def coil_points(self, steps):
        """One turn and a half, from where the leg of the left jaw ends to that of the right one, and on into the legs,
        so that no gap shows when they turn."""
        par, out, more = self.par, [], self.opening_max
        for k in range(steps + 1):
            v = mix(-more, 3.0 * math.pi + more, k / steps)
            y = par["leg_apart"] * (1.0 - 2.0 * k / steps)
            out.append((par["coil_radius"] * math.cos(v), y, par["coil_radius"] * math.sin(v)))
        return out

    def meshes(self):
        return {name: bar_mesh(rings) for name, rings in self.rings().items()}

    def open_point(self, name, p, opening):
        """Where a point of a link goes: the left jaw turns by +opening about +y, the right one against it."""
        sign = {"jaw_left": 1.0, "jaw_right": -1.0}.get(name, 0.0)
        return add(self.hinge, turned(sub(p, self.hinge), (0.0, 1.0, 0.0), sign * opening))

    def clamping_line(self):
        """Points from the root to the tip, closer where it bends."""
        a, b = self.blade_start, self.line.length
        count = max(1, math.ceil(math.degrees(self.line.turn_between(a, b)) / 5.0 - 1e-9))
        return [add(self.line.frame(mix(a, b, k / count))[0], self.shift) for k in range(count + 1)]

    # --- contact model ----------------------------------------------------------------------------------------------
    def pieces(self):
        """{link: [(name, kind, data, rounding)]}: ("capsule", (p, q, r)) or ("hull", Mesh, rounding)."""
        out = {"body": [("coil", "hull", self._coil_hull(), self.par["wire"])]}
        for name, side in (("jaw_left", -1.0), ("jaw_right", 1.0)):
            rows = [(f"{name}_leg_{i + 1}", "capsule", x, 0.0) for i, x in enumerate(self._leg_capsules(side))]
            rows += [(f"{name}_stem_{i + 1}", "capsule", x, 0.0) for i, x in enumerate(self._stem_capsules(side))]
            if self.window:
                rows += [(f"{name}_ring_{i + 1}", "capsule", x, 0.0) for i, x in enumerate(self._ring_capsules(side))]
            if self.row.get("shank"):
                rows += [
                    (f"{name}_shank_{i + 1}", "hull", x, self.par["rounding"])
                    for i, x in enumerate(
                        self._hulls(
                            side, self.blade_start - sum(x[0] for x in self.row["shank"]), self.blade_start, False
                        )
                    )
                ]
            rows += [
                (f"{name}_blade_{i + 1}", "hull", x, self.par["rounding"])
                for i, x in enumerate(self._hulls(side, self.blade_start, self.line.length, True))
            ]
            out[name] = rows
        return out

    def _coil_hull(self):
        r, y = self.par["coil_radius"], self.par["leg_apart"]
        r /= math.cos(math.pi / 8.0) ** 0.5  # between the octagon in the coil and the one about it
        corners = [(r * math.cos(v), r * math.sin(v)) for v in (math.pi / 8.0 + k * math.pi / 4.0 for k in range(8))]
        return self._hull([(x, side * y, z) for x, z in corners for side in (-1.0, 1.0)])

    def _hull(self, points):
        hull = convex_hull([tuple(round(x, 4) for x in add(p, self.shift)) for p in points])
        if len(hull.vertices) > MOST_POINTS:
            raise ValueError(f'{self.row["name"]}: a hull of more than {MOST_POINTS} points')
        return hull

    def _centres(self, nodes, side):
        return moved(jaw_rings(self.line, nodes, side)[1], self.shift)

    def _leg_capsules(self, side):
        points = self._centres([self.leg(f) for f in (0.0, 0.22, 0.52, 0.78, 0.98)], side)
        return [(p, q, self.par["wire"]) for p, q in zip(points, points[1:])]

    def _stem_capsules(self, side):
        if not self.stem:
            return []
        nodes = [self.leg(0.98)] + self._stem_nodes(30.0)
        points = self._centres(nodes, side)
        return [(p, q, 0.5 * (n.wx + n.wy)) for p, q, n in zip(points, points[1:], nodes[1:])]

    def _ring_capsules(self, side):
        w = self.window
        path = self._window_path(4)
        nodes = [Node(s, o, 0.0, w["wx"], w["wy"], 1.0) for s, o in path[2:-2]]
        points = self._centres(nodes, side)
        # Half the sagitta outwards, so that the chord runs through the middle of its arc.
        middle = add(self.line.frame(w["middle"])[0], self.shift)
        apart = norm(sub(points[1], points[0])) / (2.0 * w["radius"])
        grow = 1.0 + 0.5 * (1.0 / math.sqrt(1.0 - apart * apart) - 1.0)
        points = [combine(middle, (grow, sub(p, middle))) for p in points]
        # A capsule's radius between the two half extents of the bar.
        return [(p, q, 0.5 * (w["wx"] + w["wy"])) for p, q in zip(points, points[1:])]

    def _hulls(self, side, a, b, blade):
        """Cores of rounded pieces along the line, more where it bends, 4 at most."""
        turn = math.degrees(self.line.turn_between(a, b))
        count = max(2, min(4, math.ceil(turn / 9.0 - 1e-9))) if blade else max(1, min(4, math.ceil(turn / 30.0 - 1e-9)))
        r, dome = self.par["rounding"], min(0.8 * self.par["width"][1], 0.3 * self.blade_length)
        last, out = b - r if blade else b, []
        for k in range(count):
            stations = [mix(a, last, k / count), mix(a, last, (k + 1) / count)]
            if blade and k + 1 == count:
                stations.insert(1, max(b - dome, mix(*stations, 0.3)))
            ends = [self.line.frame(x)[0] for x in (stations[0], stations[-1])]
            # Half the sagitta outwards: the chord's error is shared between its middle and its ends.
            outwards = mul(sub(self.line.frame(mix(stations[0], stations[-1], 0.5))[0], mul(add(*ends), 0.5)), 0.5)
            points = []
            for s in stations:
                p, _, n, across = self.line.frame(s)
                wx, wy = self.blade_size(s)
                if blade and s > b - dome + 1e-9:
                    wy = r + 0.3 * (wy - r)  # inside the rounded tip
                inner, outer = 0.5 * self.par["gap"] + r, 0.5 * self.par["gap"] + max(2.0 * wx - r, r + 0.02)
                points += [
                    combine(p, (1.0, outwards), (side * x, n), (y, across))
                    for x in (inner, outer)
                    for y in (wy - r, r - wy)
                ]
            out.append(self._hull(points))
        return out

    def whole_length(self):
        """From the tip to the coil's end, along z."""
        zs = [p[2] for rings in self.rings().values() for ring in rings for p in ring]
        return max(zs) - min(zs)

    def straight_faces(self):
        """True when the closed blades meet in the plane x = 0."""
        n = self.line.frame(self.line.length)[2]
        return abs(dot(n, (1.0, 0.0, 0.0)) - 1.0) < 1e-9
