# SPDX-License-Identifier: GPL-3.0-or-later
"""Instruments and clips for other programs: their URDF with its meshes, or the same as MJCF for MuJoCo."""

from __future__ import annotations

import pathlib
import shutil
import xml.etree.ElementTree as ET

from insula import shipped
from insula.interchange.frames import ExportError

KINDS = ("instruments", "clips")


def shipped_models() -> dict[str, pathlib.Path]:
    """URDF files of the shipped instruments and clips, by name."""
    found = {}
    for kind in KINDS:
        for file in sorted((shipped.folder() / "meshes" / kind).glob("*/*.urdf")):
            found[file.stem] = file
    return found


def find_model(name: str) -> pathlib.Path:
    """A URDF file, or that of a shipped instrument or clip."""
    file = pathlib.Path(name)
    if file.suffix == ".urdf":
        if not file.is_file():
            raise ExportError("no file %s" % file)
        return file
    known = shipped_models()
    if name not in known:
        raise ExportError('no instrument "%s": name a .urdf, or one of %s' % (name, ", ".join(known)))
    return known[name]


def read_urdf(file: pathlib.Path) -> ET.Element:
    try:
        root = ET.parse(file).getroot()
    except ET.ParseError as error:
        raise ExportError("%s: %s" % (file, error)) from error
    if root.tag != "robot" or root.find("link") is None:
        raise ExportError("%s: no <robot> with links" % file)
    return root


def mesh_file(file: pathlib.Path, mesh: ET.Element) -> pathlib.Path:
    name = mesh.get("filename", "")
    path = file.parent / name
    if not name or not path.is_file():
        raise ExportError('%s: mesh "%s" is not there' % (file, name))
    return path


def copy_meshes(file: pathlib.Path, root: ET.Element, folder: pathlib.Path, prefix: str) -> None:
    """Copies the meshes that a URDF names into a folder, and makes it name the copies as PREFIX/NAME."""
    folder.mkdir(parents=True, exist_ok=True)
    for mesh in root.iter("mesh"):
        source = mesh_file(file, mesh)
        shutil.copyfile(source, folder / source.name)
        mesh.set("filename", "%s/%s" % (prefix, source.name))


def write_urdf(model: str, file: pathlib.Path) -> None:
    """The URDF with its meshes in the folder NAME_meshes beside it."""
    source = find_model(model)
    root = read_urdf(source)
    prefix = file.stem + "_meshes"
    copy_meshes(source, root, file.parent / prefix, prefix)
    ET.indent(root)
    ET.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)
