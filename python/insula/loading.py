# SPDX-License-Identifier: GPL-3.0-or-later
"""Loading scenes, and their problems as an exception."""

from __future__ import annotations

import os
from collections.abc import Iterable

from insula import _core, shipped


class SceneError(ValueError):
    """A scene with errors. All problems of it are in `problems`, errors and warnings, in order of file and place."""

    def __init__(self, problems: list[_core.Problem]):
        super().__init__("\n".join(str(p) for p in problems))
        self.problems = problems


def load(
    scene: str | os.PathLike[str],
    *,
    path: str | os.PathLike[str] | None = None,
    plugins: Iterable[str | os.PathLike[str]] = (),
    threads: int = 1,
    time_step: float | None = None,
    seed: int | None = None,
) -> _core.Simulation:
    """Loads a scene and prepares its first step.

    scene: a file, the text of a scene (it begins with "<"), or the name of a shipped scene, such as "clipping".
    path: of a text: the file that messages name, in whose folder files are searched (default: scene.xml here).
    plugins: folders of shared plugins, or single ones.
    threads: of a step; 0: as many as the machine has cores. The bits are the same for any number.
    time_step: s, in place of the scene's own.
    seed: what complications are drawn from, in place of the scene's own.

    Raises SceneError with all problems of the scene, and InputError if a plugin cannot be loaded.
    """
    text = ""
    if isinstance(scene, str) and scene.lstrip().startswith("<"):
        text, file = scene, os.fspath(path or "scene.xml")
    else:
        file = os.fspath(shipped.find(scene))
    folders = [os.fspath(p) for p in plugins]
    simulation, problems = _core.load(text, file, folders, threads, time_step or 0.0)
    if simulation is None:
        raise SceneError(problems)
    if seed is not None:
        simulation.draw_complications(seed)
    return simulation


