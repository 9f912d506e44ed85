#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the generated instruments and the bone window: reproducible, closed, consistent with their contact model."""
import hashlib
import json
import math
import os
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools", "instruments"))

import bone_window  # noqa: E402
import generate  # noqa: E402
import window_fit  # noqa: E402
from mesh import Mesh, convex_hull, number  # noqa: E402
from shapes import Spine, bar  # noqa: E402
from vec import cross, dot, norm, sub, unit  # noqa: E402

INSTRUMENTS = os.path.join(ROOT, "meshes", "instruments")
WINDOW = os.path.join(ROOT, "meshes", "window")


def read_bytes(path):
    with open(path, "rb") as f:
        return f.read()


def read_obj(path):
    """The mesh of an OBJ file and the unit normals of its face corners."""
    mesh, normals, corners = Mesh(), [], []
    with open(path, encoding="utf-8") as f:
        for line in f:
            word = line.split()
            if line.startswith("v "):
                mesh.vertices.append(tuple(float(x) for x in word[1:4]))
            elif line.startswith("vn "):
                normals.append(tuple(float(x) for x in word[1:4]))
            elif line.startswith("f "):
                pairs = [w.split("//") for w in word[1:]]
                mesh.faces.append(tuple(int(p[0]) - 1 for p in pairs))
                corners.append([normals[int(p[1]) - 1] for p in pairs])
    return mesh, corners


def components(mesh):
    """The connected pieces of a mesh, as meshes that share its vertices."""
    parent = list(range(len(mesh.vertices)))

    def find(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    for a, b, c in mesh.faces:
        parent[find(b)] = find(a)
        parent[find(c)] = find(a)
    pieces = {}
    for f in mesh.faces:
        pieces.setdefault(find(f[0]), Mesh()).faces.append(f)
    for m in pieces.values():
        m.vertices = mesh.vertices
    return list(pieces.values())


def segment_distance(p, a, b):
    d = sub(b, a)
    k = min(1.0, max(0.0, dot(sub(p, a), d) / dot(d, d))) if dot(d, d) > 0.0 else 0.0
    return norm(sub(p, tuple(x + k * y for x, y in zip(a, d))))


def triangle_distance(p, a, b, c):
    """Distance of p to a triangle: to its plane where p projects inside, else to its nearest edge."""
    n = cross(sub(b, a), sub(c, a))
    if norm(n) > 0.0:
        n = unit(n)
        if all(dot(n, cross(sub(v, u), sub(p, u))) >= 0.0 for u, v in ((a, b), (b, c), (c, a))):
            return abs(dot(n, sub(p, a)))
    return min(segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a))


def hull_distance(p, hull):
    """Distance of p to a convex hull, 0 inside."""
    v, inside, best = hull.vertices, True, math.inf
    for a, b, c in hull.faces:
        if dot(cross(sub(v[b], v[a]), sub(v[c], v[a])), sub(p, v[a])) > 0.0:
            inside = False
        best = min(best, triangle_distance(p, v[a], v[b], v[c]))
    return 0.0 if inside else best


def vector(text):
    return tuple(float(x) for x in text.split())


class Instrument:
    """What the URDF of an instrument says, in millimetres."""

    def __init__(self, name):
        self.name = name
        self.folder = os.path.join(INSTRUMENTS, name)
        self.robot = ElementTree.parse(os.path.join(self.folder, name + ".urdf")).getroot()
        self.link = self.robot.find("link")
        with open(os.path.join(self.folder, "tool.json"), encoding="utf-8") as f:
            self.tool = json.load(f)

    def mesh_files(self, kind):
        return [m.get("filename") for m in self.link.iterfind(f"{kind}/geometry/mesh")]

    def pieces(self):
        """Functions p -> distance to each piece of the contact model."""
        out = []
        for c in self.link.iterfind("collision"):
            shape = c.find("geometry")[0]
            if shape.tag == "mesh":
                mesh, _ = read_obj(os.path.join(self.folder, shape.get("filename")))
                out.append(lambda p, hull=convex_hull(mesh.vertices): hull_distance(p, hull))
                continue
            centre = tuple(1e3 * x for x in vector(c.find("origin").get("xyz")))
            _, pitch, yaw = vector(c.find("origin").get("rpy"))
            axis = (math.sin(pitch) * math.cos(yaw), math.sin(pitch) * math.sin(yaw), math.cos(pitch))
            r, length = 1e3 * float(shape.get("radius")), 1e3 * float(shape.get("length"))
            half = length / 2.0 - r
            a = tuple(x - half * d for x, d in zip(centre, axis))
            b = tuple(x + half * d for x, d in zip(centre, axis))
            out.append(lambda p, a=a, b=b, r=r: max(0.0, segment_distance(p, a, b) - r))
        return out


with open(os.path.join(ROOT, "tools", "instruments", "instruments.json"), encoding="utf-8") as table_file:
    TABLE = json.load(table_file)
NAMES = [row["name"] for row in TABLE["instruments"]]


class Generated(unittest.TestCase):
    def same_tree(self, fresh, shipped):
        def tree(top):
            return sorted(
                os.path.relpath(os.path.join(d, f), top)
                for d, _, files in os.walk(top)
                for f in files
                if not f.endswith(".md")
            )

        self.assertEqual(tree(fresh), tree(shipped))
        for file in tree(fresh):
            self.assertEqual(read_bytes(os.path.join(fresh, file)), read_bytes(os.path.join(shipped, file)), file)

    def test_rebuilding_gives_the_shipped_bytes(self):
        with tempfile.TemporaryDirectory() as tmp:
            self.assertEqual(generate.main(["--out", tmp]), 0)
            self.same_tree(tmp, INSTRUMENTS)
        with tempfile.TemporaryDirectory() as tmp:
            self.assertEqual(bone_window.main(["--out", tmp]), 0)
            self.same_tree(tmp, WINDOW)

    def test_manifests_state_unit_source_licence_and_checksum(self):
        for folder in (INSTRUMENTS, WINDOW):
            with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as f:
                manifest = json.load(f)
            listed = {e["file"] for e in manifest}
            for d, _, files in os.walk(folder):
                for file in files:
                    path = os.path.relpath(os.path.join(d, file), folder)
                    if path != "manifest.json" and not path.endswith(".md"):
                        self.assertIn(path, listed)
            for e in manifest:
                data = read_bytes(os.path.join(folder, e["file"]))
                self.assertEqual(hashlib.sha256(data).hexdigest(), e["sha256"], e["file"])
                self.assertIn(e["unit"], ("mm", "m"))
                self.assertTrue(e["source"].startswith("generated by tools/instruments/"))
                self.assertEqual(e["licence"], "GPL-3.0-or-later")
                self.assertTrue(e["frame"] and e["rebuild"])
                if e["file"].endswith(".obj"):
                    self.assertEqual(e["triangles"], data.count(b"\nf "), e["file"])


class Surfaces(unittest.TestCase):
    def check(self, path):
        mesh, corners = read_obj(path)
        mesh.check_closed(path)
        for piece in components(mesh):
            self.assertGreater(piece.volume(), 0.0, f"{path}: a piece is turned inside out")
        for f, corner in zip(mesh.faces, corners):
            a, b, c = (mesh.vertices[i] for i in f)
            flat = cross(sub(b, a), sub(c, a))
            self.assertGreater(norm(flat), 0.0, f"{path}: a triangle without area")
            for n in corner:
                self.assertAlmostEqual(norm(n), 1.0, delta=2e-3)
                if norm(flat) > 1e-6:
                    self.assertGreater(dot(n, unit(flat)), 0.0, f"{path}: a normal points inward")
        return mesh

    def test_instruments_are_closed_and_outward(self):
        for name in NAMES:
            tool, triangles = Instrument(name), 0
            for file in tool.mesh_files("visual"):
                triangles += len(self.check(os.path.join(tool.folder, file)).faces)
            self.assertGreaterEqual(triangles, 3000, name)
            self.assertLessEqual(triangles, 12000, name)
            for file in tool.mesh_files("collision"):
                mesh = self.check(os.path.join(tool.folder, file))
                self.assertLessEqual(len(mesh.vertices), 24)
                self.assertEqual(len(convex_hull(mesh.vertices).vertices), len(mesh.vertices), f"{file} is not convex")

    def test_window_is_closed_and_outward(self):
        for name in ("bone", "drape", "dura", "skin"):
            self.check(os.path.join(WINDOW, name + ".obj"))


class Urdf(unittest.TestCase):
    def test_structure_mass_and_inertia(self):
        for name in NAMES:
            tool = Instrument(name)
            self.assertEqual((tool.robot.tag, tool.robot.get("name")), ("robot", name))
            self.assertEqual([e.get("name") for e in tool.robot], ["tool"])
            mass = float(tool.link.find("inertial/mass").get("value"))
            self.assertTrue(0.010 <= mass <= 0.040, f"{name}: {mass} kg")
            t = {k: float(v) for k, v in tool.link.find("inertial/inertia").attrib.items()}
            minor = t["ixx"] * t["iyy"] - t["ixy"] ** 2
            det = (
                t["ixx"] * (t["iyy"] * t["izz"] - t["iyz"] ** 2)
                - t["ixy"] * (t["ixy"] * t["izz"] - t["iyz"] * t["ixz"])
                + t["ixz"] * (t["ixy"] * t["iyz"] - t["iyy"] * t["ixz"])
            )
            self.assertTrue(t["ixx"] > 0.0 and minor > 0.0 and det > 0.0, f"{name}: inertia is not positive definite")
            # The triangle inequality of principal moments, on the diagonal.
            diagonal = sorted((t["ixx"], t["iyy"], t["izz"]))
            self.assertLessEqual(diagonal[2], diagonal[0] + diagonal[1] + 1e-12)
            for kind in ("visual", "collision"):
                names = [e.get("name") for e in tool.link.iterfind(kind)]
                self.assertTrue(names and all(names) and len(set(names)) == len(names))
                for m in tool.link.iterfind(f"{kind}/geometry/mesh"):
                    self.assertEqual(m.get("scale"), "0.001 0.001 0.001")
                    self.assertTrue(os.path.isfile(os.path.join(tool.folder, m.get("filename"))))
            for m in tool.link.iterfind("visual/material"):
                self.assertIn(m.get("name"), TABLE["materials"])
                self.assertEqual(vector(m.find("color").get("rgba")), tuple(TABLE["materials"][m.get("name")]["rgba"]))

    def test_tip_is_at_the_origin_and_the_shaft_along_z(self):
        for name in NAMES:
            tool = Instrument(name)
            points = [p for f in tool.mesh_files("visual") for p in read_obj(os.path.join(tool.folder, f))[0].vertices]
            self.assertAlmostEqual(min(p[2] for p in points), 0.0, delta=0.05, msg=name)
            tip = [p for p in points if p[2] < 1.0]
            for axis in (0, 1):
                middle = (min(p[axis] for p in tip) + max(p[axis] for p in tip)) / 2.0
                self.assertAlmostEqual(middle, 0.0, delta=0.15, msg=f"{name}: the tip is off the axis")
            self.assertGreater(max(p[2] for p in points), 100.0)
            self.assertLess(min(norm(sub(p, tuple(tool.tool["grip"]))) for p in points), 12.0)

    def test_flat_side_faces_x(self):
        for name, width, thickness, rounding in (("dissector", 1.5, 0.4, 2.2), ("retractor", 7.0, 0.6, 3.4)):
            tool = Instrument(name)
            mesh, _ = read_obj(os.path.join(tool.folder, f"{name}_steel.obj"))
            near = [p for p in mesh.vertices if p[2] < rounding and abs(p[0]) < 1.0]
            self.assertAlmostEqual(max(p[1] for p in near) - min(p[1] for p in near), width, delta=0.35)
            flat = [p for p in near if 1.0 < p[2]]
            self.assertGreater(len(flat), 3)
            self.assertLess(max(p[0] for p in flat) - min(p[0] for p in flat), thickness + 0.25)

    def test_contact_model_covers_the_tip(self):
        for name in NAMES:
            tool = Instrument(name)
            pieces = tool.pieces()
            self.assertLessEqual(len(pieces), 8)
            points = [
                p
                for f in tool.mesh_files("visual")
                for p in read_obj(os.path.join(tool.folder, f))[0].vertices
                if p[2] <= 20.0
            ]
            self.assertGreater(len(points), 30)
            worst = max(min(distance(p) for distance in pieces) for p in points)
            self.assertLess(worst, 0.5, f"{name}: {worst:.2f} mm of the tip stick out of the contact model")

    def test_tool_facts(self):
        for name in NAMES:
            tool = Instrument(name).tool
            kinds = ("suction", "dissector", "retractor", "forceps", "scissors", "micro_doppler")
            self.assertIn(tool["tip"]["kind"], kinds)
            self.assertTrue(90.0 < tool["length_mm"] < 250.0)
            if "blade" in tool:
                edge = tool["blade"]["edge"]
                self.assertGreaterEqual(len(edge), 2)
                self.assertTrue(all(len(p) == 3 and -0.01 <= p[2] <= tool["blade"]["length_mm"] + 0.5 for p in edge))
        suction = Instrument("suction").tool["tip"]
        self.assertTrue(0.0 < suction["inner_radius_mm"] < suction["outer_radius_mm"])


class WindowFitsTheBrain(unittest.TestCase):
    """Against the shipped lobes; when this fails after a change of the lobes, run window_fit.py and bone_window.py."""

    LOBES = os.path.join(ROOT, "meshes", "lobes")

    def setUp(self):
        with open(os.path.join(ROOT, "tools", "instruments", "bone_window.json"), encoding="utf-8") as f:
            self.par = json.load(f)
        self.window = bone_window.Window(self.par)

    def local(self, p):
        d = sub(p, self.window.centre)
        return dot(d, self.window.x), dot(d, self.window.y), dot(d, self.window.n)

    def test_brain_stays_below_bone_and_dura(self):
        below = self.par["dura"]["thickness"] + 0.25
        for lobe in ("frontal", "temporal"):
            nearest = math.inf
            for p in window_fit.ply_vertices(os.path.join(self.LOBES, f"{lobe}_surface.ply")):
                x, y, z = self.local(p)
                if math.hypot(x, y) > self.window.rim(math.atan2(y, x)) - self.par["dura"]["strip"]:
                    nearest = min(nearest, self.window.table(x, y) - z)
            self.assertGreater(nearest, below, lobe)
            self.assertLess(nearest, 6.0, f"{lobe}: the bone floats above the brain")

    def test_opening_frames_the_fissure(self):
        with open(os.path.join(self.LOBES, "fissure.json"), encoding="utf-8") as f:
            stations = [self.local(s["superficial"]) for s in json.load(f)["stations"]]
        inside = [math.hypot(x, y) < self.window.rim(math.atan2(y, x)) for x, y, _ in stations]
        self.assertGreaterEqual(sum(inside), 0.5 * len(inside))


class Generator(unittest.TestCase):
    """The building blocks against closed forms, and their complaints."""

    def test_moments_of_a_box(self):
        box = bar(Spine([(0, 0, 0), (0, 0, 4)], []), [[0, 1, 1], [4, 1, 1]], sides=4002)
        volume, first, second = box.second_moments()
        self.assertAlmostEqual(volume, 4.0 * math.pi, delta=1e-4)
        self.assertAlmostEqual(first[2] / volume, 2.0, delta=1e-6)
        self.assertAlmostEqual(second[2][2], math.pi * 4.0**3 / 3.0, delta=1e-3)
        self.assertAlmostEqual(second[0][0], math.pi / 4.0 * 4.0, delta=1e-4)

    def test_spine_arc_has_its_length(self):
        spine = Spine([(0, 0, 0), (0, 0, 10), (10, 0, 10)], 5.0)
        self.assertAlmostEqual(spine.length, 10.0 + 2.5 * math.pi, delta=0.01)
        _, t, n, b = spine.frame(spine.length)
        for got, want in ((t, (1, 0, 0)), (n, (0, 0, -1)), (b, (0, 1, 0))):
            self.assertLess(norm(sub(got, want)), 1e-9)
        with self.assertRaises(ValueError):
            Spine([(0, 0, 0), (0, 0, 10), (10, 0, 10)], 50.0)

    def test_hull_keeps_the_corners_of_a_cube_only(self):
        cube = [(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]
        hull = convex_hull(cube + [(0.5, 0.5, 0.5), (0.25, 0.5, 0.75)])
        self.assertEqual((len(hull.vertices), len(hull.faces)), (8, 12))
        self.assertAlmostEqual(hull.volume(), 1.0, places=12)
        with self.assertRaises(ValueError):
            convex_hull([(x, y, 0.0) for x, y, z in cube])

    def test_defects_are_noticed(self):
        good = bar(Spine([(0, 0, 0), (0, 0, 4)], []), [[0, 1], [4, 1]])
        good.check_closed("bar")
        open_mesh, inverted = Mesh(), Mesh()
        open_mesh.vertices = inverted.vertices = good.vertices
        open_mesh.faces = good.faces[1:]
        inverted.faces = [(a, c, b) for a, b, c in good.faces]
        for bad in (open_mesh, inverted):
            with self.assertRaises(ValueError):
                bad.check_closed("bad")
        with self.assertRaises(ValueError):
            generate.build_part({"shape": "cone", "material": "steel", "spine": "main"}, {"main": None})

    def test_numbers_have_one_spelling(self):
        self.assertEqual(number(-0.0001, 3), "0.000")
        self.assertEqual(number(-0.5, 3), "-0.500")
        self.assertTrue(re.fullmatch(r"-?\d+\.\d{4}", number(1e-9, 4)))


if __name__ == "__main__":
    unittest.main()
