# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes that come with Insula."""

from __future__ import annotations

import os
import pathlib

from insula import _core


def folder() -> pathlib.Path:
    """The folder with scenes and meshes: of the installed package, or of the source tree that this was built in."""
    here = pathlib.Path(__file__).parent
    installed = here / "prefix" / "share" / "insula"
    if installed.is_dir():
        return installed
    marked = here / "source_folder.txt"
    return pathlib.Path(marked.read_text(encoding="utf-8").strip())


def scenes() -> dict[str, pathlib.Path]:
    """Files of the shipped scenes by name: exercises, skill tasks, cases.

    "clipping" is 3_clipping.xml, "basilar_tip" the case of this folder, and "basilar_tip/pause" its exercise pause.xml.
    """
    return {name: pathlib.Path(file) for name, file in _core.shipped_scenes(str(folder()))}


def find(scene: str | os.PathLike[str]) -> pathlib.Path:
    """The file itself, or that of the shipped scene of this name. Raises FileNotFoundError with the nearest name."""
    return pathlib.Path(_core.scene_called(os.fspath(scene), str(folder())))
