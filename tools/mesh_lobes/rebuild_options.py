#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the options of insula_mesh_volume for an approach, one line a run: rebuild_options.py FOLDER."""
import json
import pathlib
import sys


def main():
    approach = json.loads((pathlib.Path(sys.argv[1]) / "approach.json").read_text())
    mesh, field, lobes = approach["mesh"], approach["field"], approach["lobes"]
    ball = ",".join("%g" % v for v in field["centre_mm"] + [field["radius_mm"]])
    common = ["--part %s=%s" % item for item in mesh["labels"].items()] + ["--roi " + ball, mesh["options"]]
    formats = mesh.get("formats", {})
    # Training: coarse tetrahedra, fine surfaces, the course of the fissure.
    training = common + [mesh["training"]]
    training += ["--tet %s=%s.msh:%s" % (lobe, lobe, formats.get(lobe, "4.1")) for lobe in lobes]
    training += ["--surface %s=%s_surface.ply" % (part, part) for part in lobes + [approach["floor"]]]
    print(*training, "--cleft %s,%s=fissure.json" % tuple(lobes))
    # Benchmark: the same shapes with many more nodes.
    if "benchmark" in mesh:
        print(*common, mesh["benchmark"], *("--tet %s=%s_large.msh:4.1b" % (lobe, lobe) for lobe in lobes))


main()
