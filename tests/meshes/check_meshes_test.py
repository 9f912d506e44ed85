#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Breaks a copy of the shipped lobes in one way at a time; check_meshes.py must notice each."""
import contextlib
import hashlib
import io
import json
import pathlib
import shutil
import struct
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import check_meshes  # noqa: E402

SOURCE = pathlib.Path(sys.argv.pop(1))


class Broken(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copytree(SOURCE, self.folder, dirs_exist_ok=True)
        # The large pair is checked elsewhere; small stand-ins keep each run short.
        for name in ("frontal_large.msh", "temporal_large.msh"):
            shutil.copy(self.folder / name.replace("_large", ""), self.folder / name)
        self.edit_manifest(lambda entries: [self.sign(e) for e in entries])

    def edit_manifest(self, change):
        path = self.folder / "manifest.json"
        entries = json.loads(path.read_text())
        change(entries)
        path.write_text(json.dumps(entries))

    def sign(self, entry):
        """Makes checksum and counts of one entry agree with its file, so that only the mesh itself can be wrong."""
        path = self.folder / entry["file"]
        entry["sha256"] = hashlib.sha256(path.read_bytes()).hexdigest()
        if path.suffix == ".msh":
            points, tets = check_meshes.mesh_files.read_msh(path)
            entry.update(nodes=len(points), tetrahedra=len(tets))
        elif path.suffix == ".ply":
            points, triangles = check_meshes.mesh_files.read_ply(path)
            entry.update(nodes=len(points), triangles=len(triangles))

    def resign(self, name):
        self.edit_manifest(lambda entries: [self.sign(e) for e in entries if e["file"] == name])

    def failures(self):
        out, argv = io.StringIO(), sys.argv
        sys.argv = ["check_meshes.py", str(self.folder)]
        try:
            with contextlib.redirect_stdout(out):
                check_meshes.main()
        finally:
            sys.argv = argv
        # The stand-ins are too small on purpose.
        return [line for line in out.getvalue().split("\n") if line.startswith("FAILED") and "large pair" not in line]

    def expect(self, text):
        failures = self.failures()
        self.assertTrue(any(text in line for line in failures), (text, failures))

    def edit_lines(self, name, change):
        path = self.folder / name
        lines = path.read_text().split("\n")
        change(lines)
        path.write_text("\n".join(lines))
        self.resign(name)

    def test_whole_copy_passes(self):
        self.assertEqual(self.failures(), [])

    def test_checksum(self):
        with open(self.folder / "fissure.json", "a") as stream:
            stream.write(" ")
        self.expect("fissure.json: checksum differs")

    def test_unit(self):
        self.edit_manifest(lambda entries: entries[0].update(unit="m"))
        self.expect("unit is not mm")

    def test_missing_field(self):
        self.edit_manifest(lambda entries: entries[1].pop("attribution"))
        self.expect("a field of the manifest is missing")

    def test_unlisted_file(self):
        (self.folder / "extra.msh").write_text("")
        self.expect("manifest and folder differ")

    def test_counts(self):
        self.edit_manifest(lambda entries: entries[0].update(nodes=entries[0]["nodes"] + 1))
        self.expect("counts differ")

    def test_inverted_tetrahedron(self):
        def swap(lines):
            at = lines.index("$Elements") + 2
            words = lines[at].split()
            words[-1], words[-2] = words[-2], words[-1]
            lines[at] = " ".join(words)
        self.edit_lines("temporal.msh", swap)
        self.expect("not positively oriented")

    def test_flat_tetrahedron(self):
        # The fourth corner of the first tetrahedron moves almost into the plane of the others.
        def flatten(lines):
            corners = [int(v) for v in lines[lines.index("$Elements") + 2].split()[-4:]]
            first = lines.index("$Nodes") + 1
            p = [[float(c) for c in lines[first + v].split()[1:]] for v in corners]
            middle = [sum(q[a] for q in p[:3]) / 3 for a in range(3)]
            flat = [m + 0.02 * (c - m) for m, c in zip(middle, p[3])]
            lines[first + corners[3]] = " ".join([str(corners[3])] + ["%.6f" % c for c in flat])
        self.edit_lines("temporal.msh", flatten)
        self.expect("temporal.msh: smallest dihedral angle")

    def edit_ply(self, name, change):
        path = self.folder / name
        data = path.read_bytes()
        end = data.index(b"end_header\n") + len(b"end_header\n")
        body = bytearray(data[end:])
        points, triangles = check_meshes.mesh_files.read_ply(path)
        size = (len(body) - 13 * len(triangles)) // len(points)
        change(body, size, points, triangles)
        path.write_bytes(data[:end] + bytes(body))
        self.resign(name)

    def test_open_surface(self):
        def tear(body, size, points, triangles):
            struct.pack_into("<iii", body, size * len(points) + 1, *triangles[1])
        self.edit_ply("temporal_surface.ply", tear)
        self.expect("temporal_surface.ply: not closed")

    def test_inside_out(self):
        def turn(body, size, points, triangles):
            for i, (a, b, c) in enumerate(triangles):
                struct.pack_into("<iii", body, size * len(points) + 13 * i + 1, a, c, b)
        self.edit_ply("frontal_surface.ply", turn)
        self.expect("normals point inward")

    def test_not_finite(self):
        self.edit_ply("insula_surface.ply", lambda body, *rest: struct.pack_into("<f", body, 0, float("nan")))
        self.expect("insula_surface.ply: a coordinate is not finite")

    def test_touching_surfaces(self):
        target, _ = check_meshes.mesh_files.read_ply(SOURCE / "temporal_surface.ply")
        self.edit_ply("frontal_surface.ply", lambda body, *rest: struct.pack_into("<fff", body, 0, *target[0]))
        self.expect("come within 0.00 mm")


if __name__ == "__main__":
    unittest.main()
