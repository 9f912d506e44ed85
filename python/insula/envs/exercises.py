# SPDX-License-Identifier: GPL-3.0-or-later
"""What an environment knows of each exercise besides its scene: how it begins, and what tells how far it has come."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from insula import Channels

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
    commands: tuple[tuple[str, str], ...] = ()  # done at each start
    lines: tuple[str, ...] = ()  # drawables whose lines are the next aims, such as strands that stand
    aim_at: Mapping[str, float] = field(default_factory=dict)  # hand: time of the motion "steady" whose pose is its aim
    most_steps: int = 600  # decisions of an episode


def _divided(channels: Channels) -> float:
    return 10 * known(channels, "divide.divided", 0)


def _opened(channels: Channels) -> float:
    return _divided(channels) + 2 * min(known(channels, "open.gap", 0) / 0.005, 1)


def _clipped(channels: Channels) -> float:
    shut = 1 - min(known(channels, "clip.grade", 5) / 5, 1)
    flow = min(known(channels, "clip.superior.flow", 1), known(channels, "clip.inferior.flow", 1), 1)
    return 8 * shut + 2 * flow


def _stopped(channels: Channels) -> float:
    bleeding = min(known(channels, "bleeding.rate", 0) / 1e-6, 1)  # of 60 ml/min
    return _clipped(channels) - 4 * bleeding


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
        Exercise(
            "Clipping", "clipping", _clipped, commands=(("ask", "applier load angled"),), aim_at={"right": 6.0}
        ),
        Exercise(
            "Rupture",
            "rupture",
            _stopped,
            commands=(("ask", "applier load angled"), ("ask", "bleeding rupture")),
            aim_at={"right": 16.7},
        ),
    )
}
