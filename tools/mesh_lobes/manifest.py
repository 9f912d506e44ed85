#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes manifest.json beside the lobes' meshes: unit, frame, source, terms, checksum and counts of each file."""
import hashlib
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "meshes"))
import mesh_files  # noqa: E402

FILES = [
    ("frontal.msh", "right frontal lobe with the upper lip of the fissure, training tetrahedra"),
    ("temporal.msh", "right temporal lobe, training tetrahedra"),
    ("frontal_surface.ply", "fine surface of the frontal lobe, lies in frontal.msh and frontal_large.msh"),
    ("temporal_surface.ply", "fine surface of the temporal lobe, lies in temporal.msh and temporal_large.msh"),
    ("insula_surface.ply", "insula and the deep tissue behind it: the floor of the fissure"),
    ("frontal_large.msh", "right frontal lobe, benchmark tetrahedra"),
    ("temporal_large.msh", "right temporal lobe, benchmark tetrahedra"),
    ("fissure.json", "course of the Sylvian fissure: stations along its opening, depth, outward normal"),
]
COMMON = {
    "unit": "mm",
    "frame": "MNI, right-anterior-superior (+x right, +y anterior, +z superior)",
    "source": "Colin27 head (ch2better.nii.gz) and AAL labels (aal.nii.gz) of Debian's package mricron-data",
    "licence": "BSD-3-Clause",
    "attribution": "MRIcron templates, copyright 2006-2010 Chris Rorden; "
    "BSD-3-clause as stated by Debian's mricron-data",
    "rebuild": "tools/mesh_lobes/rebuild.sh",
}


def main():
    folder = pathlib.Path(sys.argv[1])
    entries = []
    for name, what in FILES:
        path = folder / name
        entry = {"file": name, "what": what, **COMMON, "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}
        if name.endswith(".msh"):
            points, tets = mesh_files.read_msh(path)
            entry.update(nodes=len(points), tetrahedra=len(tets))
        elif name.endswith(".ply"):
            points, triangles = mesh_files.read_ply(path)
            entry.update(nodes=len(points), triangles=len(triangles))
        entries.append(entry)
    (folder / "manifest.json").write_text(json.dumps(entries, indent=2) + "\n")


if __name__ == "__main__":
    main()
