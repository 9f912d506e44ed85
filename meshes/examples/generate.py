#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the small meshes of the plugins' example scenes, and the manifest that lists them.

Usage: generate.py [--check]      --check compares with what lies beside this file and writes nothing
"""
import hashlib
import itertools
import json
import math
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
BARS = (1, 2, 3, 4, 6)  # cells across the bars of studies/mesh_convergence.xml
# A cube in six tetrahedra around its diagonal: one for each order of stepping along the axes.
ORDERS = list(itertools.permutations(range(3)))


def even(order):
    return sum(order[i] > order[j] for i in range(3) for j in range(i + 1, 3)) % 2 == 0


def block(cells, low, high):
    """Nodes (mm) and tetrahedra (from 1) of a box of cells[0] x cells[1] x cells[2] cubes."""
    n = [c + 1 for c in cells]
    nodes = [
        [low[a] + (high[a] - low[a]) * i[a] / cells[a] for a in range(3)]
        for i in itertools.product(*(range(m) for m in n))
    ]
    number = lambda i: 1 + (i[0] * n[1] + i[1]) * n[2] + i[2]
    tets = []
    for corner in itertools.product(*(range(c) for c in cells)):
        for order in ORDERS:
            at, tet = list(corner), [number(corner)]
            for axis in order:
                at[axis] += 1
                tet.append(number(at))
            if not even(order):
                tet[2], tet[3] = tet[3], tet[2]
            tets.append(tet)
    return nodes, tets


def msh(nodes, tets):
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes))]
    lines += ["%d %.6g %.6g %.6g" % (i, *p) for i, p in enumerate(nodes, 1)]
    lines += ["$EndNodes", "$Elements", str(len(tets))]
    lines += ["%d 4 2 1 1 %d %d %d %d" % (i, *t) for i, t in enumerate(tets, 1)]
    return "\n".join(lines + ["$EndElements", ""])


def plate(low, high):
    """A closed box of twelve triangles as OBJ (mm), outward."""
    corners = list(itertools.product(*zip(low, high)))
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    lines = ["# SPDX-License-Identifier: GPL-3.0-or-later"]
    lines += ["v %.6g %.6g %.6g" % c for c in corners]
    for a, b, c, d in quads:
        lines += ["f %d %d %d" % (a + 1, b + 1, c + 1), "f %d %d %d" % (a + 1, c + 1, d + 1)]
    return "\n".join(lines + [""])


def tube(radius, length, around, along):
    """The open wall of a tube about x as OBJ (mm), outward."""
    lines = ["# SPDX-License-Identifier: GPL-3.0-or-later"]
    for j in range(along + 1):
        for i in range(around):
            angle = 2 * math.pi * (i + 0.5 * (j % 2)) / around
            lines.append(
                "v %.6g %.6g %.6g" % (length * (j / along - 0.5), radius * math.cos(angle), radius * math.sin(angle))
            )
    for j in range(along):
        for i in range(around):
            a, b = 1 + j * around + i, 1 + j * around + (i + 1) % around
            c, d = a + around, b + around
            if j % 2 == 0:
                lines += ["f %d %d %d" % (a, b, c), "f %d %d %d" % (b, d, c)]
            else:
                lines += ["f %d %d %d" % (a, b, d), "f %d %d %d" % (a, d, c)]
    return "\n".join(lines + [""])


def entry(name, text, **counts):
    return dict(
        file=name,
        unit="mm",
        frame="the scene's",
        source="generated",
        licence="GPL-3.0-or-later",
        sha256=hashlib.sha256(text.encode()).hexdigest(),
        rebuild="python3 meshes/examples/generate.py",
        **counts
    )


def main():
    files, manifest = {}, []
    for name, low, high in (
        ("block.msh", (-10, -10, -20), (10, 10, 0)),
        ("block_upper.msh", (-10, -10, 2), (10, 10, 22)),
    ):
        nodes, tets = block((4, 4, 4), low, high)
        files[name] = msh(nodes, tets)
        manifest.append(entry(name, files[name], nodes=len(nodes), tetrahedra=len(tets)))
    for n in BARS:
        name = "bar_%d.msh" % n
        nodes, tets = block((n, n, 4 * n), (-5, -5, 0), (5, 5, 40))
        files[name] = msh(nodes, tets)
        manifest.append(entry(name, files[name], nodes=len(nodes), tetrahedra=len(tets)))
    files["plate.obj"] = plate((-20, -20, -24), (20, 20, -20.2))
    manifest.append(entry("plate.obj", files["plate.obj"], triangles=12))
    files["tube.obj"] = tube(2, 14, 12, 8)
    manifest.append(entry("tube.obj", files["tube.obj"], triangles=192))
    files["manifest.json"] = json.dumps(manifest, indent=2) + "\n"
    if "--check" in sys.argv[1:]:
        wrong = [n for n, t in files.items() if not (FOLDER / n).is_file() or (FOLDER / n).read_text() != t]
        extra = {p.name for p in FOLDER.iterdir() if p.suffix in (".msh", ".obj", ".ply", ".json")} - set(files)
        for n in sorted(set(wrong) | extra):
            print("differs from what generate.py writes:", n)
        return 1 if wrong or extra else 0
    for name, text in files.items():
        (FOLDER / name).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
