#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the generated clips: reproducible, closed, jaws that meet and open, springs, masses, contact model."""
import hashlib
import importlib.util
import json
import math
import os
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
CLIPS = os.path.join(ROOT, "meshes", "clips")
sys.path[:0] = [os.path.join(ROOT, "tools", "clips"), os.path.join(ROOT, "tools", "instruments"), HERE]


def load(name, *path):
    spec = importlib.util.spec_from_file_location(name, os.path.join(ROOT, *path))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


generate = load("clips_generate", "tools", "clips", "generate.py")
from clip import Clip, interpolated  # noqa: E402
from jaw import Line, bar_mesh, turned, wire_rings  # noqa: E402
from mesh import Mesh, convex_hull  # noqa: E402
from vec import add, combine, cross, dot, norm, sub, unit  # noqa: E402

with open(os.path.join(ROOT, "tools", "clips", "clips.json"), encoding="utf-8") as table_file:
    TABLE = json.load(table_file)
NAMES = [row["name"] for row in TABLE["clips"]]
MENU = [
    "straight",
    "curved",
    "angled",
    "bayonet",
    "fenestrated_3_5_stem_90",
    "mini",
    "temporary_straight",
    "temporary_curved",
]
LINKS = ("body", "jaw_left", "jaw_right")
# Of each kind: closing force (N) at the blade's middle and opening of the tips (mm).
RANGES = {
    "permanent": ((1.5, 2.0), (6.0, 9.0)),
    "temporary": ((0.7, 0.9), (6.0, 9.0)),
    "mini": ((1.1, 1.3), (3.5, 5.0)),
    "mini_temporary": ((0.7, 0.9), (3.5, 5.0)),
}
LARGE = {row["name"] for row in TABLE["clips"] if row["family"] == "large"}
LARGE_RANGES = ((1.5, 2.0), (10.5, 13.0))


def read_bytes(path):
    with open(path, "rb") as f:
        return f.read()


def read_obj(path):
    mesh = Mesh()
    with open(path, encoding="utf-8") as f:
        for line in f:
            word = line.split()
            if line.startswith("v "):
                mesh.vertices.append(tuple(float(x) for x in word[1:4]))
            elif line.startswith("f "):
                mesh.faces.append(tuple(int(w.split("//")[0]) - 1 for w in word[1:]))
    return mesh


def segment_distance(p, a, b):
    d = sub(b, a)
    k = min(1.0, max(0.0, dot(sub(p, a), d) / dot(d, d))) if dot(d, d) > 0.0 else 0.0
    return norm(sub(p, combine(a, (k, d))))


def triangle_distance(p, a, b, c):
    n = cross(sub(b, a), sub(c, a))
    if norm(n) > 0.0:
        n = unit(n)
        if all(dot(n, cross(sub(v, u), sub(p, u))) >= 0.0 for u, v in ((a, b), (b, c), (c, a))):
            return abs(dot(n, sub(p, a)))
    return min(segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a))


def hull_distance(p, hull):
    """Signed distance to a convex hull, negative inside (there: to the nearest face's plane)."""
    v, best, depth = hull.vertices, math.inf, -math.inf
    for a, b, c in hull.faces:
        n = unit(cross(sub(v[b], v[a]), sub(v[c], v[a])))
        depth = max(depth, dot(n, sub(p, v[a])))
        best = min(best, triangle_distance(p, v[a], v[b], v[c]))
    return best if depth > 0.0 else depth


def vector(text):
    return tuple(float(x) for x in text.split())


class Shipped:
    """What the files of a clip say, in millimetres and in the tool frame."""

    def __init__(self, name):
        self.name, self.folder = name, os.path.join(CLIPS, name)
        self.robot = ElementTree.parse(os.path.join(self.folder, name + ".urdf")).getroot()
        self.links = {x.get("name"): x for x in self.robot.iterfind("link")}
        self.joints = {x.get("name"): x for x in self.robot.iterfind("joint")}
        with open(os.path.join(self.folder, "tool.json"), encoding="utf-8") as f:
            self.tool = json.load(f)
        self.clip = self.tool["clip"]
        self.hinge = tuple(1e3 * x for x in vector(self.joints["opening"].find("origin").get("xyz")))
        self.upper = float(self.joints["opening"].find("limit").get("upper"))

    def mesh(self, link):
        return read_obj(os.path.join(self.folder, self.links[link].find("visual/geometry/mesh").get("filename")))

    def base(self, link):
        return self.hinge if link != "body" else (0.0, 0.0, 0.0)

    def pieces(self, link):
        """[(name, p -> signed distance)] of the contact model."""
        out = []
        for c in self.links[link].iterfind("collision"):
            shape, origin = c.find("geometry")[0], c.find("origin")
            at = add(tuple(1e3 * x for x in vector(origin.get("xyz"))), self.base(link))
            if shape.tag == "mesh":
                points = [add(p, at) for p in read_obj(os.path.join(self.folder, shape.get("filename"))).vertices]
                r = self.tool["rounding_mm"][c.get("name")]
                out.append((c.get("name"), lambda p, h=convex_hull(points), r=r: hull_distance(p, h) - r))
                continue
            _, pitch, yaw = vector(origin.get("rpy"))
            axis = (math.sin(pitch) * math.cos(yaw), math.sin(pitch) * math.sin(yaw), math.cos(pitch))
            r = 1e3 * float(shape.get("radius"))
            half = 500.0 * float(shape.get("length")) - r
            a, b = combine(at, (-half, axis)), combine(at, (half, axis))
            out.append((c.get("name"), lambda p, a=a, b=b, r=r: segment_distance(p, a, b) - r))
        return out

    def opened(self, link, p, angle):
        """The point of a link after the URDF's joints have turned by the opening angle."""
        for joint in self.joints.values():
            if joint.find("child").get("link") == link:
                mimic = joint.find("mimic")
                k = float(mimic.get("multiplier")) if mimic is not None else 1.0
                return add(self.hinge, turned(sub(p, self.hinge), vector(joint.find("axis").get("xyz")), k * angle))
        return p

    def blade_samples(self):
        """[(point of the clamping line, tangent, normal of the faces)] at the middles of its legs and at its points."""
        line = [tuple(p) for p in self.clip["blade_line"]]
        out = []
        for p, q in zip(line, line[1:]):
            t = unit(sub(q, p))
            n = unit(cross((0.0, 1.0, 0.0), t)) if self.clip["shape"] == "side_curved" else (1.0, 0.0, 0.0)
            n = n if n[0] > 0.0 else tuple(-x for x in n)
            out += [(combine(p, (k, sub(q, p))), t, n) for k in (0.05, 0.5)]
        return out


SHIPPED = {name: Shipped(name) for name in NAMES}


class Files(unittest.TestCase):
    def test_rebuilding_gives_the_shipped_bytes(self):
        def tree(top):
            return sorted(os.path.relpath(os.path.join(d, f), top) for d, _, files in os.walk(top) for f in files)

        with tempfile.TemporaryDirectory() as tmp:
            self.assertEqual(generate.main(["--out", tmp]), 0)
            self.assertEqual(tree(tmp), tree(CLIPS))
            for file in tree(tmp):
                self.assertEqual(read_bytes(os.path.join(tmp, file)), read_bytes(os.path.join(CLIPS, file)), file)

    def test_manifest_states_unit_source_licence_and_checksum(self):
        with open(os.path.join(CLIPS, "manifest.json"), encoding="utf-8") as f:
            manifest = json.load(f)
        present = {os.path.relpath(os.path.join(d, f), CLIPS) for d, _, files in os.walk(CLIPS) for f in files}
        self.assertEqual({e["file"] for e in manifest}, present - {"manifest.json", "README.md"})
        for e in manifest:
            data = read_bytes(os.path.join(CLIPS, e["file"]))
            self.assertEqual(hashlib.sha256(data).hexdigest(), e["sha256"], e["file"])
            self.assertEqual(e["licence"], "GPL-3.0-or-later")
            self.assertTrue(
                e["unit"] and e["frame"] and e["rebuild"] and e["source"].startswith("generated by tools/clips/")
            )
            if e["file"].endswith(".obj"):
                self.assertEqual(e["triangles"], data.count(b"\nf "), e["file"])

    def test_the_library_is_large_and_light(self):
        self.assertGreaterEqual(len(NAMES), 40)
        self.assertEqual(len(set(NAMES)), len(NAMES))
        total = sum(os.path.getsize(os.path.join(d, f)) for d, _, files in os.walk(CLIPS) for f in files)
        self.assertLess(total, 8e6)

    def test_catalogue(self):
        with open(os.path.join(CLIPS, "catalogue.json"), encoding="utf-8") as f:
            catalogue = json.load(f)
        self.assertEqual([e["name"] for e in catalogue], NAMES)
        self.assertEqual([e["name"] for e in catalogue if e["menu"]], MENU)
        for e in catalogue:
            self.assertTrue(os.path.isfile(os.path.join(CLIPS, e["urdf"])))
            picture = ElementTree.parse(os.path.join(CLIPS, e["picture"])).getroot()
            self.assertEqual((picture.get("width"), picture.get("height")), ("160", "96"))
            paths = [x for x in picture if x.tag.endswith("path")]
            self.assertGreater(len(paths), 100)
            for x in paths:
                for word in x.get("d").strip("Mz").split("L"):
                    x0, y0 = vector(word)
                    self.assertTrue(5.0 <= x0 <= 155.0 and 5.0 <= y0 <= 91.0, f'{e["name"]}: outside the picture')


class Surfaces(unittest.TestCase):
    def test_closed_outward_and_light(self):
        for name, clip in SHIPPED.items():
            triangles = 0
            for link in LINKS:
                mesh = clip.mesh(link)
                mesh.check_closed(f"{name}: {link}")
                triangles += len(mesh.faces)
            self.assertLess(triangles, 1500, name)
            for link in LINKS:
                for c in clip.links[link].iterfind("collision/geometry/mesh"):
                    hull = read_obj(os.path.join(clip.folder, c.get("filename")))
                    hull.check_closed(c.get("filename"))
                    self.assertLessEqual(len(hull.vertices), 24)

    def test_tip_is_the_origin_and_the_hinge_lies_beyond(self):
        for name, clip in SHIPPED.items():
            self.assertEqual(clip.clip["blade_to"], [0.0, 0.0, 0.0])
            self.assertGreater(clip.hinge[2], 5.0, name)
            points = [p for link in LINKS for p in clip.mesh(link).vertices]
            self.assertGreater(min(p[2] for p in points), -0.75 if name in LARGE else -0.7, name)
            self.assertAlmostEqual(
                max(p[2] for p in points) - min(p[2] for p in points), clip.tool["length_mm"], delta=2e-3
            )
            self.assertTrue(9.0 < clip.tool["length_mm"] < (30.0 if name in LARGE else 25.0), name)
            self.assertLess(min(norm(p) for p in points), 0.5, name)


class Structure(unittest.TestCase):
    def test_links_joints_and_masses(self):
        for name, clip in SHIPPED.items():
            self.assertEqual(tuple(clip.links), LINKS)
            first, second = clip.joints["opening"], clip.joints["opening_mirrored"]
            for joint, child in ((first, "jaw_left"), (second, "jaw_right")):
                self.assertEqual(
                    (joint.get("type"), joint.find("parent").get("link"), joint.find("child").get("link")),
                    ("revolute", "body", child),
                )
                self.assertEqual(joint.find("axis").get("xyz"), "0 1 0")
                self.assertEqual(joint.find("origin").attrib, first.find("origin").attrib)
            self.assertEqual(second.find("mimic").attrib, {"joint": "opening", "multiplier": "-1", "offset": "0"})
            self.assertEqual(float(second.find("limit").get("lower")), -clip.upper)
            masses = [float(clip.links[x].find("inertial/mass").get("value")) for x in LINKS]
            self.assertAlmostEqual(sum(masses), clip.tool["mass_kg"], delta=1e-9)
            self.assertTrue(3e-5 < sum(masses) < (2.6e-4 if name in LARGE else 2e-4), f"{name}: {sum(masses)} kg")
            self.assertAlmostEqual(masses[1], masses[2], delta=0.05 * masses[1])

    def test_springs(self):
        for name, clip in SHIPPED.items():
            c = clip.clip
            force, opening = LARGE_RANGES if name in LARGE else RANGES[c["kind"]]
            self.assertTrue(force[0] <= c["closing_force_N"] <= force[1], name)
            self.assertTrue(opening[0] <= c["opening_mm"] <= opening[1], f'{name}: {c["opening_mm"]} mm')
            self.assertTrue(3.0 <= c["blade_length_mm"] <= (18.0 if name in LARGE else 15.0))
            gap = 2e-3 * c["reference_mm"] * math.sin(clip.upper)
            self.assertAlmostEqual(
                c["closing_force_N"] + c["force_slope_N_per_m"] * gap, 2.0 * c["closing_force_N"], delta=1e-3
            )
            nearest = min(math.hypot(p[0] - clip.hinge[0], p[2] - clip.hinge[2]) for p, _, _ in clip.blade_samples())
            self.assertGreaterEqual(c["reference_mm"], nearest - 0.05)


class Jaws(unittest.TestCase):
    def test_closed_faces_meet_within_a_twentieth_of_a_millimetre(self):
        for name, clip in SHIPPED.items():
            sides = [[d for piece, d in clip.pieces(link) if "_blade_" in piece] for link in LINKS[1:]]
            self.assertTrue(all(2 <= len(x) <= 4 for x in sides))
            for p, _, n in clip.blade_samples():
                for side, pieces in zip((-1.0, 1.0), sides):
                    self.assertLess(abs(min(d(p) for d in pieces)), 0.05, f"{name}: at {p}")
                    self.assertLess(
                        min(d(combine(p, (side * 0.1, n))) for d in pieces), -0.02, f"{name}: no jaw beside {p}"
                    )
                    self.assertGreater(
                        min(d(combine(p, (-side * 0.1, n))) for d in pieces),
                        0.05,
                        f"{name}: the jaw reaches across at {p}",
                    )

    def test_closed_faces_of_the_picture_meet(self):
        for name, clip in SHIPPED.items():
            if clip.clip["shape"] == "side_curved":
                continue
            root = clip.clip["blade_from"]
            direction = sub(tuple(clip.clip["blade_line"][1]), tuple(root))
            left, right = (
                [p for p in clip.mesh(x).vertices if dot(sub(p, tuple(root)), direction) > 0.0] for x in LINKS[1:]
            )
            self.assertAlmostEqual(max(p[0] for p in left), -0.005, delta=1e-3, msg=name)
            self.assertAlmostEqual(min(p[0] for p in right), 0.005, delta=1e-3, msg=name)

    def test_they_open_to_their_limit(self):
        for name, clip in SHIPPED.items():
            tips = [clip.opened(link, (0.0, 0.0, 0.0), clip.upper) for link in LINKS[1:]]
            self.assertAlmostEqual(norm(sub(*tips)), clip.clip["opening_mm"], delta=1e-3)
            self.assertLess(tips[0][0], tips[1][0], f"{name}: the jaws cross")
            self.assertAlmostEqual(tips[0][2], tips[1][2], delta=1e-6 if abs(clip.hinge[0]) < 1e-6 else 2.0)
            self.assertGreater(clip.upper, math.radians(5.0))
            self.assertLess(clip.upper, math.radians(28.001))
            # Half open, the gap at the reference point is 2 r sin(angle).
            half = 0.5 * clip.upper
            for p, _, _ in clip.blade_samples():
                r = math.hypot(p[0] - clip.hinge[0], p[2] - clip.hinge[2])
                apart = norm(sub(*(clip.opened(link, p, half) for link in LINKS[1:])))
                self.assertAlmostEqual(apart, 2.0 * r * math.sin(half), delta=1e-9)

    def test_they_are_alike(self):
        """Blades, shanks and windows mirrored in x = 0, where the faces are plane; the legs cross and differ."""
        for name, clip in SHIPPED.items():
            if clip.clip["shape"] == "side_curved":
                continue
            left, right = (clip.links[x] for x in LINKS[1:])
            for c in left.iterfind("collision/geometry/mesh"):
                file = c.get("filename")
                mirrored = sorted((-x, y, z) for x, y, z in read_obj(os.path.join(clip.folder, file)).vertices)
                other = sorted(read_obj(os.path.join(clip.folder, file.replace("_left_", "_right_"))).vertices)
                self.assertEqual(len(mirrored), len(other))
                self.assertLess(max(norm(sub(p, q)) for p, q in zip(mirrored, other)), 2e-4, f"{name}: {file}")
            self.assertEqual(len(left.findall("collision")), len(right.findall("collision")))

    def test_contact_model_covers_the_picture(self):
        for name in MENU + [
            "side_curved_12",
            "angled_90_8",
            "j_shaped_8",
            "fenestrated_5_angled_90",
            "mini_temporary_curved_5",
            "mini_bayonet_5",
        ]:
            clip = SHIPPED[name]
            everything = [d for link in LINKS for _, d in clip.pieces(link)]
            for link in LINKS:
                points = clip.mesh(link).vertices[::3]
                worst = max(min(d(p) for d in everything) for p in points)
                self.assertLess(worst, 0.3, f"{name}: {worst:.2f} mm of {link} stick out of the contact model")
        # And it is no larger than the picture: a window stays a window.
        for name in ("fenestrated", "fenestrated_3_5_stem_90"):
            clip = SHIPPED[name]
            hole = clip.clip["fenestration"]
            free = min(d(tuple(hole["centre"])) for link in LINKS for _, d in clip.pieces(link))
            self.assertAlmostEqual(free, 0.5 * hole["diameter_mm"], delta=0.25)


class Generator(unittest.TestCase):
    def test_a_line_of_arcs_has_its_closed_form(self):
        r = 10.0 / math.radians(90.0)
        p, t, n, b = Line([[5.0, 0], [10.0, 90]]).frame(15.0)
        for got, want in (
            (p, (0.0, r, -5.0 - r)),
            (t, (0.0, 1.0, 0.0)),
            (n, (1.0, 0.0, 0.0)),
            (b, (0.0, 0.0, 1.0 * t[1] * -1.0)),
        ):
            self.assertLess(norm(sub(got, want)), 1e-9)
        p, t, n, _ = Line([[10.0, 90, "side"]]).frame(10.0)
        for got, want in ((p, (r, 0.0, -r)), (t, (1.0, 0.0, 0.0)), (n, (0.0, 0.0, 1.0))):
            self.assertLess(norm(sub(got, want)), 1e-9)
        self.assertAlmostEqual(Line([[10.0, 90]]).turn_between(0.0, 10.0), 0.5 * math.pi, places=9)
        for bad in ([0.0, 10], [1.0, 10, "up"]):
            with self.assertRaises(ValueError):
                Line([bad])

    def test_bars_are_closed_and_have_their_volume(self):
        mesh = bar_mesh(wire_rings([(0.0, 0.0, 0.2 * k) for k in range(6)], 0.5, (0.0, 1.0, 0.0)))
        mesh.check_closed("wire")
        self.assertAlmostEqual(
            mesh.volume(), 2.0 * math.sqrt(2.0) * 0.25, places=9
        )  # an octagon's area is 2 sqrt(2) r^2

    def test_tables_are_interpolated(self):
        table = [[3, 6.0], [15, 9.0]]
        self.assertEqual([interpolated(table, x) for x in (0, 3, 9, 15, 20)], [6.0, 6.0, 7.5, 9.0, 9.0])

    def test_a_new_row_is_a_new_clip(self):
        row = {
            "name": "own",
            "label": "Own",
            "family": "standard",
            "shape": "straight",
            "blade": [[10, 0]],
            "set": {"force": [[0, 1.2]]},
        }
        clip = Clip(row, TABLE["families"]["standard"])
        self.assertEqual(clip.force, 1.2)
        self.assertAlmostEqual(clip.reference, TABLE["families"]["standard"]["leg_length"] + 5.0, places=9)
        with tempfile.TemporaryDirectory() as tmp:
            with open(os.path.join(tmp, "table.json"), "w", encoding="utf-8") as f:
                json.dump(dict(TABLE, clips=[row]), f)
            self.assertEqual(
                generate.main(["--table", os.path.join(tmp, "table.json"), "--out", os.path.join(tmp, "out")]), 0
            )
            self.assertTrue(os.path.isfile(os.path.join(tmp, "out", "own", "own.urdf")))


if __name__ == "__main__":
    unittest.main()
