#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes manifest.json beside the meshes of an approach: manifest.py FOLDER OUTPUT_FOLDER.

Unit, frame, source, terms, checksum and counts of each file. FOLDER/approach.json says what each file is (mesh.files).
"""
import hashlib
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "meshes"))
import mesh_files  # noqa: E402

FRAME = {"unit": "mm", "frame": "MNI, right-anterior-superior (+x right, +y anterior, +z superior)"}
TERMS = {
    "licence": "BSD-3-Clause",
    "attribution": "MRIcron templates, copyright 2006-2010 Chris Rorden; "
    "BSD-3-clause as stated by Debian's mricron-data",
}


def main():
    folder, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    mesh = json.loads((folder / "approach.json").read_text())["mesh"]
    rebuild = "tools/mesh_lobes/rebuild.sh" + ("" if folder.name == "lobes" else " meshes/" + folder.name)
    entries = []
    for name, what in mesh["files"].items():
        path = out / name
        facts = {**FRAME, "source": mesh["source"], **TERMS, "rebuild": rebuild}
        entry = {"file": name, "what": what, **facts, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
        if name.endswith(".msh"):
            points, tets = mesh_files.read_msh(path)
            entry.update(nodes=len(points), tetrahedra=len(tets))
        elif name.endswith(".ply"):
            points, triangles = mesh_files.read_ply(path)
            entry.update(nodes=len(points), triangles=len(triangles))
        entries.append(entry)
    (out / "manifest.json").write_text(json.dumps(entries, indent=2) + "\n")


if __name__ == "__main__":
    main()
