# SPDX-License-Identifier: GPL-3.0-or-later
"""Insula in Python: the engine of an aneurysm simulator in this process. For training only.

    import insula

    simulation = insula.load("sylvian_fissure")
    simulation.follow(simulation.motion("steady"))
    simulation.step(60)
    print(simulation.channels["arachnoid.standing"])

All quantities are SI, and positions are in the frame of the scene. docs/python.md is the manual page.
"""

import importlib.util

from insula._core import (
    Body,
    Channels,
    CommandRefused,
    ConstraintProblem,
    Event,
    InputError,
    Motion,
    Problem,
    Simulation,
    State,
    Surface,
)
from insula._core import version as __version__
from insula.loading import SceneError, load
from insula.shipped import scenes

__all__ = [
    "Body",
    "Channels",
    "CommandRefused",
    "ConstraintProblem",
    "Event",
    "InputError",
    "Motion",
    "Problem",
    "SceneError",
    "Simulation",
    "State",
    "Surface",
    "load",
    "scenes",
]

if importlib.util.find_spec("gymnasium"):
    from insula import envs  # noqa: F401  registers the environments
