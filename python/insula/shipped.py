# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes that come with Insula."""

from __future__ import annotations

import os
import pathlib
import re

from insula import _core


def folder() -> pathlib.Path:
    """The folder with scenes and meshes: of the installed package, or of the source tree that this was built in."""
    here = pathlib.Path(__file__).parent
    installed = here / "prefix" / "share" / "insula"
    if installed.is_dir():
        return installed
    marked = here / "source_folder.txt"
    return pathlib.Path(marked.read_text(encoding="utf-8").strip())


def _without_number(stem: str) -> str:
    return re.sub(r"^\d+_", "", stem)


def _name(file: pathlib.Path, of: pathlib.Path) -> str:
    stem = _without_number(file.stem)
    if file.parent == of:
        return stem
    return file.parent.name if stem == "case" else "%s/%s" % (file.parent.name, stem)


def scenes() -> dict[str, pathlib.Path]:
    """Files of the shipped scenes by name: exercises, skill tasks, cases.

    "clipping" is 3_clipping.xml, "basilar_tip" the case of this folder, and "basilar_tip/pause" its exercise pause.xml.
    """
    found: dict[str, pathlib.Path] = {}
    for kind in ("training", "skills", "cases"):
        of = folder() / "scenes" / kind
        for file in sorted(of.rglob("*.xml")):
            if "<scene" in file.read_text(encoding="utf-8"):
                found.setdefault(_name(file, of), file)
    return found


def find(scene: str | os.PathLike[str]) -> pathlib.Path:
    """The file itself, or that of the shipped scene of this name."""
    file = pathlib.Path(scene)
    if file.is_file() or file.suffix or file.is_absolute():
        return file
    known, name = scenes(), str(scene)
    shipped = known.get(_without_number(name))
    if shipped and name in (_without_number(name), shipped.stem):
        return shipped
    near = _core.nearest_name(name, list(known))
    hint = "; did you mean \"%s\"?" % near if near else "; there are %s" % ", ".join(known)
    raise FileNotFoundError("no scene \"%s\"%s" % (name, hint))
