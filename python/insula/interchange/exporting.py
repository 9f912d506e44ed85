# SPDX-License-Identifier: GPL-3.0-or-later
"""One function for all formats, by the ending of the file."""

from __future__ import annotations

import os
import pathlib

import insula
from insula.interchange.frames import ExportError, Frames, capture
from insula.interchange.gltf import write_gltf
from insula.interchange.instruments import write_urdf
from insula.interchange.mjcf import write_mjcf
from insula.interchange.usd import write_usd
from insula.interchange.vtu import write_series

SCENES = {".gltf": write_gltf, ".glb": write_gltf, ".usd": write_usd, ".usda": write_usd, ".usdc": write_usd,
          ".pvd": write_series}
INSTRUMENTS = {".mjcf": write_mjcf, ".urdf": write_urdf}
FORMATS = (*SCENES, *INSTRUMENTS)


def checked(file: str | os.PathLike[str]) -> pathlib.Path:
    """The file, whose ending is known and whose folder is there."""
    path = pathlib.Path(file)
    if path.suffix not in FORMATS:
        raise ExportError('"%s" has no known ending; there are %s' % (path, ", ".join(FORMATS)))
    if not path.parent.is_dir():
        raise ExportError("no folder %s" % path.parent)
    return path


def export(simulation: insula.Simulation | Frames, file: str | os.PathLike[str], *, start: float | None = None,
           until: float | None = None, rate: float = 10.0) -> Frames:
    """Writes what a simulation shows: .gltf, .glb, .usd, .usda, .usdc, or .pvd with a series of .vtu.

    start: s, up to which the simulation steps first; default: where it stands.
    until: s; frames from `start` to there, `rate` a second; default: one frame.

    Returns the frames, which can be given again in place of the simulation, for another file. Raises ExportError.
    """
    path = checked(file)
    if path.suffix in INSTRUMENTS:
        raise ExportError("%s holds an instrument, no scene: use export_instrument" % path.suffix)
    if isinstance(simulation, Frames):
        frames = simulation
    else:
        frames = capture(simulation, simulation.time if start is None else start, until, rate)
    try:
        SCENES[path.suffix](frames, path)
    except OSError as error:
        raise ExportError("%s cannot be written: %s" % (path, error)) from error
    return frames


def export_instrument(model: str | os.PathLike[str], file: str | os.PathLike[str]) -> None:
    """Writes an instrument or a clip as .mjcf or .urdf, with its meshes in a folder beside it.

    model: a URDF file, or the name of a shipped one, such as "dissector" or "straight". Raises ExportError.
    """
    path = checked(file)
    if path.suffix not in INSTRUMENTS:
        raise ExportError("%s holds a scene, no instrument: use export" % path.suffix)
    try:
        INSTRUMENTS[path.suffix](os.fspath(model), path)
    except OSError as error:
        raise ExportError("%s cannot be written: %s" % (path, error)) from error
