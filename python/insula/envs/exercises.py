# SPDX-License-Identifier: GPL-3.0-or-later
"""What an environment knows of each exercise besides its scene: how it begins, and what tells how far it has come."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from insula import Channels, shipped

Progress = Callable[[Channels], float]


def known(channels: Channels, name: str, otherwise: float) -> float:
    """A channel's value, or another number where it is not known now."""
    value = channels[name]
    return otherwise if value != value else value


@dataclass(frozen=True)
class Exercise:
    """An exercise as a task. `progress` grows by 1 for a tenth or so of the work; its change is part of the reward."""

    name: str
    scene: str
    progress: Progress
    commands: tuple[tuple[str, str], ...] = ()  # done at each start, after the clip is loaded
    lines: tuple[str, ...] = ()  # drawables whose lines are the next aims, such as strands that stand
    clip: int = 0  # first clip of the motion "steady" that stays on the neck, from 1: it is loaded; 0: none
    most_steps: int = 600  # decisions of an episode


def _divided(channels: Channels) -> float:
    return 10 * known(channels, "divide.divided", 0)


def _opened(channels: Channels) -> float:
    return _divided(channels) + 2 * min(known(channels, "open.gap", 0) / 0.005, 1)


def _clipped(channels: Channels) -> float:
    shut = 1 - min(known(channels, "clip.grade", 5) / 5, 1)
    flow = min((known(channels, k, 1) for k in channels if k.startswith("clip.") and k.endswith(".flow")), default=1)
    return 8 * shut + 2 * min(flow, 1)


def _stopped(channels: Channels) -> float:
    bleeding = min(known(channels, "bleeding.rate", 0) / 1e-6, 1)  # of 60 ml/min
    return _clipped(channels) - 4 * bleeding


CLIPPING = Exercise("Clipping", "clipping", _clipped, clip=1)
RUPTURE = Exercise("Rupture", "rupture", _stopped, commands=(("ask", "bleeding rupture"),), clip=2)


def _of_the_library() -> Iterator[Exercise]:
    """The case "basilar_tip" is ClippingBasilarTip. The rupture of a case is as exercise 4."""
    for scene, file in shipped.scenes().items():
        case = scene.partition("/")[0]
        kind = {"case": CLIPPING, "rupture": RUPTURE}.get(file.stem)
        if file.parent.name == case and kind:
            yield replace(kind, name=kind.name + "".join(w.capitalize() for w in case.split("_")), scene=scene)


EXERCISES = {
    e.name: e
    for e in (
        Exercise("SylvianFissure", "sylvian_fissure", _opened, lines=("arachnoid.fibres",)),
        Exercise(
            "AneurysmDissection",
            "aneurysm_dissection",
            _divided,
            lines=("to_frontal.fibres", "to_temporal.fibres", "to_branches.fibres"),
        ),
        CLIPPING,
        RUPTURE,
        *_of_the_library(),
    )
}
