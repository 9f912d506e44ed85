# SPDX-License-Identifier: GPL-3.0-or-later
"""Insula's scenes and instruments in other programs' formats: glTF, USD, VTU series, MJCF, URDF, and ROS 2 messages.

    from insula import interchange

    simulation = insula.load("sylvian_fissure")
    simulation.follow(simulation.motion("steady"))
    interchange.export(simulation, "fissure.glb", start=20, until=24)

docs/interchange.md is the manual page. `./insula export` does the same on the command line.
"""

from insula.interchange.exporting import FORMATS, export, export_instrument
from insula.interchange.frames import ExportError, Frames, capture

__all__ = ["FORMATS", "ExportError", "Frames", "capture", "export", "export_instrument"]
