# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the state of a simulation is sound: elements that are inverted or collapsed, tools and clips deep in tissue,
tools away from their hands.
"""

from __future__ import annotations

import numpy as np

from insula import _core

EVERY = 5  # steps between two looks at the elements
COLLAPSED = 0.01  # of the size at rest
DEEP = 0.6e-3  # m; shapes of tools are rounded by 0.2 mm
ASTRAY = 1e-3  # m
GRIP = 0.05  # of a contact of a shut clip, N
COLUMNS = ("sound", "inverted_ever", "inverted", "volume", "area", "depth", "astray")
UNITS = {"depth": "m", "astray": "m"}


def volumes(positions: np.ndarray, tetrahedra: np.ndarray) -> np.ndarray:
    """Six times the signed volumes."""
    a, b, c, d = (positions[tetrahedra[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)


def areas(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Twice the areas."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1)


class Soundness:
    """Looks at a simulation while it runs."""

    def __init__(self, simulation: _core.Simulation):
        self.simulation = simulation
        self.inverted_ever = 0
        self.solids: list[tuple[_core.Body, np.ndarray, np.ndarray]] = []  # elements, and their size at rest
        self.walls: list[tuple[_core.Body, np.ndarray, np.ndarray]] = []
        for body in simulation.bodies:
            elements = np.array(body.elements) if body.deformable else np.zeros((0, 3), int)
            if len(elements):
                kind, size = (self.solids, volumes) if elements.shape[1] == 4 else (self.walls, areas)
                kind.append((body, elements, size(body.rest, elements)))

    def _relative(self, kind: list, size) -> np.ndarray:
        parts = [size(body.positions, elements) / rest for body, elements, rest in kind]
        return np.concatenate([np.ones(1), *parts])

    def look(self) -> np.ndarray:
        """Volumes of all tetrahedra over those at rest."""
        relative = self._relative(self.solids, volumes)
        self.inverted_ever = max(self.inverted_ever, int((~(relative > 0)).sum()))
        return relative

    def depth(self) -> float:
        """Deepest overlap of a rigid body with something else, m."""
        contacts, bodies = self.simulation.contacts, self.simulation.bodies
        rigid = np.array([not b.deformable for b in bodies])
        touching = contacts[rigid[contacts["body_a"]] | rigid[contacts["body_b"]]] if len(contacts) else contacts
        return max(0.0, -float(touching["gap"].min())) if len(touching) else 0.0

    def gripping(self) -> set[str]:
        """Tools whose clip is shut on a vessel."""
        contacts, bodies = self.simulation.contacts, self.simulation.bodies
        is_clip = np.array([b.element == "clip" for b in bodies])
        is_wall = np.array([b.element == "shell_body" for b in bodies])
        a, b = contacts["body_a"], contacts["body_b"]
        gripped = contacts[((is_clip[a] & is_wall[b]) | (is_wall[a] & is_clip[b])) & (contacts["normal_force"] > GRIP)]
        welded = {k.owner for k in self.simulation.problem.blocks if k.role == "weld"}
        return welded if len(gripped) >= 2 else set()

    def astray(self) -> float:
        """Largest distance of a tool from its hand, m. A tool that holds a vessel in a shut clip is pulled by it."""
        s, found = self.simulation, [0.0]
        gripping = self.gripping()
        for hand in ("left", "right"):
            if s.tool(hand) is not None and s.tool(hand) not in gripping:
                found.append(float(np.linalg.norm(np.subtract(s.hand_pose(hand)[0], s.tip_pose(hand)[0]))))
        return max(found)

    def values(self) -> dict[str, float | int | bool]:
        """The state now, by the names of COLUMNS."""
        volume = self.look()
        out: dict[str, float | int | bool] = {
            "inverted_ever": self.inverted_ever,
            "inverted": int((~(volume > 0)).sum()),
            "volume": float(volume.min()),
            "area": float(self._relative(self.walls, areas).min()),
            "depth": self.depth(),
            "astray": self.astray(),
        }
        out["sound"] = bool(out["inverted"] == 0 and out["volume"] > COLLAPSED and out["area"] > COLLAPSED
                            and out["depth"] < DEEP and out["astray"] < ASTRAY)
        return out
