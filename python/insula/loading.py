# SPDX-License-Identifier: GPL-3.0-or-later
"""Loading scenes, and their problems as an exception."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping

from insula import _core, shipped


class SceneError(ValueError):
    """A scene with errors. All problems of it are in `problems`, errors and warnings, in order of file and place."""

    def __init__(self, problems: list[_core.Problem]):
        super().__init__("\n".join(str(p) for p in problems))
        self.problems = problems


Edit = tuple[str, str, str, str, int, int]


def edits(changes: Mapping[str, str], place: tuple[str, int, int] = ("", 0, 0)) -> list[Edit]:
    """Changes as the module takes them: component, name, value, and the place that messages name."""
    out = []
    for key, value in changes.items():
        component, _, name = key.rpartition(".")
        if key.startswith("$"):
            component, name = "", key[1:]
        elif not component:
            raise ValueError('"%s" names no parameter: write ID.PARAMETER, or $NAME for a variable' % key)
        out.append((component, name, value, *place))
    return out


def load(
    scene: str | os.PathLike[str],
    *,
    path: str | os.PathLike[str] | None = None,
    plugins: Iterable[str | os.PathLike[str]] = (),
    threads: int = 1,
    time_step: float | None = None,
    seed: int | None = None,
    changes: Mapping[str, str] | None = None,
) -> _core.Simulation:
    """Loads a scene and prepares its first step.

    scene: a file, the text of a scene (it begins with "<"), or the name of a shipped scene, such as "clipping".
    path: of a text: the file that messages name, in whose folder files are searched (default: scene.xml here).
    plugins: folders of shared plugins, or single ones.
    threads: of a step; 0: as many as the machine has cores. The bits are the same for any number.
    time_step: s, in place of the scene's own.
    seed: what complications are drawn from, in place of the scene's own.
    changes: values in place of what the scene says: {"heart.systolic": "140 mmHg", "$artery_case": "wide_neck"}. The
        first part of a key is the id of a component, or ID.ELEMENT for its only child of that element; "$" begins the
        name of a variable.

    Raises SceneError with all problems of the scene, InputError if a plugin cannot be loaded, and FileNotFoundError
    with the nearest name if no shipped scene is called so.
    """
    if time_step is not None and not time_step > 0:
        raise ValueError("time_step: above 0 s")
    text = ""
    if isinstance(scene, str) and scene.lstrip().startswith("<"):
        text, file = scene, os.fspath(path or "scene.xml")
    else:
        file = os.fspath(shipped.find(scene))
    folders = [os.fspath(p) for p in plugins]
    simulation, problems = _core.load(text, file, folders, threads, time_step or 0.0, edits(changes or {}))
    if simulation is None:
        raise SceneError(problems)
    if seed is not None:
        simulation.draw_complications(seed)
    return simulation


