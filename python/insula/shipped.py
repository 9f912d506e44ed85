# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes that come with Insula."""

from __future__ import annotations

import os
import pathlib
import re


def folder() -> pathlib.Path:
    """The folder with scenes and meshes: of the installed package, or of the source tree that this was built in."""
    here = pathlib.Path(__file__).parent
    installed = here / "prefix" / "share" / "insula"
    if installed.is_dir():
        return installed
    marked = here / "source_folder.txt"
    return pathlib.Path(marked.read_text(encoding="utf-8").strip())


def scenes() -> dict[str, pathlib.Path]:
    """Files of the shipped scenes by name: exercises, skill tasks, cases. "clipping" is 3_clipping.xml."""
    found: dict[str, pathlib.Path] = {}
    for kind in ("training", "skills", "cases"):
        for file in sorted((folder() / "scenes" / kind).rglob("*.xml")):
            if "<scene" in file.read_text(encoding="utf-8"):
                found.setdefault(re.sub(r"^\d+_", "", file.stem), file)
    return found


def find(scene: str | os.PathLike[str]) -> pathlib.Path:
    """The file itself, or that of the shipped scene of this name."""
    file = pathlib.Path(scene)
    if file.exists() or file.suffix or len(file.parts) != 1:
        return file
    known = scenes()
    for name, shipped in known.items():
        if str(scene) in (name, shipped.stem):
            return shipped
    raise FileNotFoundError("no scene \"%s\"; there are %s" % (scene, ", ".join(known)))
