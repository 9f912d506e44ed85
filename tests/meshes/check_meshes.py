#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the meshes of an approach: manifest, checksums, counts, tetrahedra's quality, closed outward surfaces, gaps.

Usage: check_meshes.py MESH_FOLDER      (the folder that holds manifest.json)
"""
import hashlib
import json
import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import mesh_files  # noqa: E402

FIELDS = ("file", "unit", "frame", "source", "licence", "attribution", "sha256", "rebuild")
FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))  # outward, opposite vertex 0, 1, 2, 3
MIN_DIHEDRAL_DEG = 10.0
# Nodes of the lobes that are stepped in real time, least and most.
NODES = {
    "frontal.msh": (480, 620),
    "temporal.msh": (280, 380),
    "right_frontal.msh": (420, 560),
    "left_frontal.msh": (300, 420),
    "basal_interhemispheric/right_frontal.msh": (300, 420),
    "basal_interhemispheric/left_frontal.msh": (250, 370),
    "pretemporal/frontal.msh": (220, 320),
    "pretemporal/temporal.msh": (160, 240),
    "pterional/frontal.msh": (300, 400),
    "pterional/temporal.msh": (190, 280),
}
# The falx lies in the gap between the lobes.
LEAST_GAP, LEAST_GAP_OF_FALX = 0.5, 0.1  # mm


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def dihedral_angles(p):
    """The six dihedral angles (degrees) of a tetrahedron with corners p[0..3]."""
    normals = []
    for i, j, k in FACES:
        n = cross(sub(p[j], p[i]), sub(p[k], p[i]))
        length = math.sqrt(dot(n, n))
        normals.append((n[0] / length, n[1] / length, n[2] / length))
    return [
        math.degrees(math.acos(max(-1.0, min(1.0, -dot(normals[a], normals[b])))))
        for a in range(4)
        for b in range(a + 1, 4)
    ]


def closed(triangles):
    """Every edge belongs to exactly two triangles, once in each direction."""
    edges = set()
    for t in triangles:
        for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0])):
            if (a, b) in edges or a == b:
                return False
            edges.add((a, b))
    return bool(edges) and all((b, a) in edges for a, b in edges)


def boundary(tets):
    """Triangles that belong to one tetrahedron only, outward."""
    seen = {}
    for t in tets:
        for f in FACES:
            triangle = tuple(t[v] for v in f)
            key = tuple(sorted(triangle))
            seen[key] = None if key in seen else triangle
    return [t for t in seen.values() if t]


class Checker:
    def __init__(self):
        self.failures = []

    def that(self, ok, text):
        if not ok:
            self.failures.append(text)
            print("FAILED:", text)


def check_tets(check, name, points, tets):
    check.that(tets, name + ": no tetrahedra")
    check.that(all(math.isfinite(c) for p in points for c in p), name + ": a coordinate is not finite")
    check.that({v for t in tets for v in t} == set(range(len(points))), name + ": unused or unknown nodes")
    smallest, largest, inverted = 180.0, 0.0, 0
    for t in tets:
        p = [points[v] for v in t]
        if dot(cross(sub(p[1], p[0]), sub(p[2], p[0])), sub(p[3], p[0])) <= 0:
            inverted += 1
            continue
        angles = dihedral_angles(p)
        smallest, largest = min(smallest, *angles), max(largest, *angles)
    check.that(inverted == 0, "%s: %d tetrahedra are not positively oriented" % (name, inverted))
    check.that(smallest >= MIN_DIHEDRAL_DEG, "%s: smallest dihedral angle %.2f deg" % (name, smallest))
    skin = boundary(tets)
    check.that(closed(skin), name + ": its boundary is not a closed manifold")
    print(
        "%s: %d nodes, %d tetrahedra, dihedral angles %.2f to %.2f deg"
        % (name, len(points), len(tets), smallest, largest)
    )


def check_surface(check, name, points, triangles):
    check.that(all(math.isfinite(c) for p in points for c in p), name + ": a coordinate is not finite")
    check.that(closed(triangles), name + ": not closed")
    volume = sum(dot(points[a], cross(points[b], points[c])) for a, b, c in triangles) / 6
    check.that(volume > 0, name + ": normals point inward")
    print("%s: %d points, %d triangles, volume %.0f mm3" % (name, len(points), len(triangles), volume))


def vertex_gap(a, b, reach=4.0):
    """Smallest distance between the points of two surfaces (mm), or `reach` when there is none nearer."""
    cells = {}
    for p in b:
        cells.setdefault(tuple(int(math.floor(c / reach)) for c in p), []).append(p)
    best = reach
    for p in a:
        base = [int(math.floor(c / reach)) for c in p]
        for i in (-1, 0, 1):
            for j in (-1, 0, 1):
                for k in (-1, 0, 1):
                    for q in cells.get((base[0] + i, base[1] + j, base[2] + k), ()):
                        best = min(best, math.dist(p, q))
    return best


def main():
    folder = pathlib.Path(sys.argv[1])
    check = Checker()
    entries = {e["file"]: e for e in json.loads((folder / "manifest.json").read_text())}
    listed = set(entries)
    present = {p.name for p in folder.iterdir()} - {"manifest.json", "README.md", "approach.json"}
    check.that(listed == present, "manifest and folder differ: %s" % sorted(listed ^ present))
    surfaces = {}
    for name, entry in entries.items():
        check.that(
            all(isinstance(entry.get(f), str) and entry[f] for f in FIELDS),
            name + ": a field of the manifest is missing",
        )
        check.that(entry["unit"] == "mm", name + ": unit is not mm")
        check.that(entry["licence"] == "BSD-3-Clause", name + ": licence")
        check.that(re.fullmatch("[0-9a-f]{64}", entry["sha256"]) is not None, name + ": sha256 is malformed")
        check.that(
            hashlib.sha256((folder / name).read_bytes()).hexdigest() == entry["sha256"], name + ": checksum differs"
        )
        if name.endswith(".msh"):
            points, tets = mesh_files.read_msh(folder / name)
            check.that(
                (len(points), len(tets)) == (entry["nodes"], entry["tetrahedra"]),
                name + ": counts differ from the manifest",
            )
            check_tets(check, name, points, tets)
        elif name.endswith(".ply"):
            points, triangles = mesh_files.read_ply(folder / name)
            check.that(
                (len(points), len(triangles)) == (entry["nodes"], entry["triangles"]),
                name + ": counts differ from the manifest",
            )
            check_surface(check, name, points, triangles)
            surfaces[name] = [p for p in points if all(math.isfinite(c) for c in p)]
    lobes = json.loads((folder / "approach.json").read_text())["lobes"]
    for lobe in lobes:
        name = lobe + ".msh"
        low, high = NODES.get("%s/%s" % (folder.name, name)) or NODES[name]
        nodes = entries[lobe + ".msh"]["nodes"]
        check.that(low <= nodes <= high, "%s.msh: %d nodes" % (lobe, nodes))
        triangles = entries[lobe + "_surface.ply"]["triangles"]
        check.that(10000 <= triangles <= 17000, "%s_surface.ply: %d triangles" % (lobe, triangles))
    large = [entries[lobe + "_large.msh"]["nodes"] for lobe in lobes if lobe + "_large.msh" in entries]
    check.that(not large or sum(large) >= 10000, "the large pair has %d nodes" % sum(large))
    names = sorted(surfaces)
    for i, a in enumerate(names):
        for b in names[i + 1 :]:
            gap = vertex_gap(surfaces[a], surfaces[b])
            least = LEAST_GAP_OF_FALX if "falx_surface.ply" in (a, b) else LEAST_GAP
            check.that(gap >= least, "%s and %s come within %.2f mm" % (a, b, gap))
            print("%s - %s: points at least %.2f mm apart" % (a, b, gap))
    fissure = json.loads((folder / "fissure.json").read_text())
    check.that(fissure["unit"] == "mm" and len(fissure["stations"]) >= 5, "fissure.json: too few stations")
    check.that(abs(math.hypot(*fissure["outward_normal"]) - 1) < 2e-3, "fissure.json: the normal is no unit vector")
    print("%d failures" % len(check.failures))
    return 1 if check.failures else 0


if __name__ == "__main__":
    sys.exit(main())
