# SPDX-License-Identifier: GPL-3.0-or-later
"""The task of every program: a mesh, a material, fixed nodes, gravity that is switched on, and a pressed ball."""

from __future__ import annotations

import pathlib
from dataclasses import dataclass, field

import insula
import numpy as np
from geometry import distance_to_triangles, outer_triangles

ROOT = pathlib.Path(__file__).resolve().parents[2]
MIDDLE = np.array([0.054, 0.004, -0.002])  # of the Sylvian fissure, as scenes/parts/fissure.xml says
FREE_WITHIN = 0.032  # m of it; nodes beyond are held


@dataclass(frozen=True)
class Ball:
    """A rigid ball without friction. Its centre goes straight from `start` by `way` in the direction `inward`."""

    radius: float
    start: np.ndarray
    inward: np.ndarray
    way: float
    begin: float  # s, when it starts to move
    end: float  # s, when it rests again

    def centre(self, time: float) -> np.ndarray:
        share = min(max((time - self.begin) / (self.end - self.begin), 0.0), 1.0)
        return self.start + share * self.way * self.inward


@dataclass(frozen=True)
class Case:
    """SI units. `held`: indices of the nodes that do not move."""

    name: str
    mesh: pathlib.Path
    rest: np.ndarray
    elements: np.ndarray
    held: np.ndarray
    ball: Ball | None
    steps: int
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)
    young: float = 2100.0
    poisson: float = 0.45
    density: float = 1000.0
    mass_damping: float = 1.0  # 1/s
    stiffness_damping: float = 0.02  # s
    step: float = 1 / 60
    mass: np.ndarray = field(init=False)
    free: np.ndarray = field(init=False)
    surface: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        edges = self.rest[self.elements[:, 1:]] - self.rest[self.elements[:, :1]]
        mass = np.zeros(len(self.rest))
        np.add.at(mass, self.elements, (self.density * np.linalg.det(edges) / 24)[:, None])
        free = np.ones(len(self.rest), bool)
        free[self.held] = False
        for name, value in (("mass", mass), ("free", free), ("surface", outer_triangles(self.elements))):
            object.__setattr__(self, name, value)

    def weight(self) -> np.ndarray:
        """Force of gravity on each node, N."""
        return self.mass[:, None] * np.array(self.gravity)


def nodes_of(mesh: pathlib.Path) -> tuple[np.ndarray, np.ndarray]:
    """Nodes (m) and tetrahedra of a mesh file in mm, as Insula reads them."""
    text = '<scene><soft_body id="tissue" mesh="%s" mesh_unit="mm"><corotational_fem/></soft_body></scene>' % mesh.name
    body = insula.load(text, path=mesh.parent / "scene.xml").body("tissue")
    return body.rest.copy(), body.elements.copy()


def outward_normals(rest: np.ndarray, surface: np.ndarray) -> np.ndarray:
    """Of each node on the surface, weighted by areas; zero inside."""
    a, b, c = (rest[surface[:, k]] for k in range(3))
    out = np.zeros_like(rest)
    np.add.at(out, surface, np.cross(b - a, c - a)[:, None])
    return out / np.maximum(np.linalg.norm(out, axis=1), 1e-30)[:, None]


def touched_place(rest: np.ndarray, elements: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """The node of the surface nearest to the fissure's middle at which a ball of that radius touches nothing else, and
    the normal there."""
    surface = outer_triangles(elements)
    normals = outward_normals(rest, surface)
    corners = [rest[surface[:, k]] for k in range(3)]
    away = np.linalg.norm(rest - MIDDLE, axis=1)
    outer = np.unique(surface)
    for node in outer[np.argsort(away[outer])]:
        centre = rest[node] + 1.01 * radius * normals[node]
        if distance_to_triangles(centre, *corners) >= radius:
            return rest[node], normals[node]
    raise ValueError("a ball of radius %g mm has no place on this surface" % (1e3 * radius))


def lobe(name: str, steps: int = 180, radius: float = 0.005, depth: float = 0.0015) -> Case:
    """A lobe of the training scenes. It sags for a second. Then the ball is pressed in at the fissure, and rests for
    the last second."""
    mesh = ROOT / "meshes/lobes" / (name + ".msh")
    if not mesh.exists():
        known = sorted(p.stem for p in mesh.parent.glob("*.msh"))
        raise ValueError('no lobe "%s"; there are %s' % (name, ", ".join(known)))
    rest, elements = nodes_of(mesh)
    held = np.flatnonzero(np.linalg.norm(rest - MIDDLE, axis=1) >= FREE_WITHIN)
    place, outward = touched_place(rest, elements, radius)
    clearance = 0.002  # the lobe may come nearer when it sags
    seconds = steps / 60
    ball = Ball(radius, place + (radius + clearance) * outward, -outward, clearance + depth, seconds / 3,
                seconds * 2 / 3)
    return Case(name, mesh, rest, elements, held, ball, steps)


def block(gravity: float = 0.5, steps: int = 240, pressed: float = 0.0) -> Case:
    """A small block that is held at its foot, for the test that the comparison is fair. `pressed`: depth of a ball on
    its top, m; 0: no ball."""
    mesh = ROOT / "meshes/examples/block.msh"
    rest, elements = nodes_of(mesh)
    low, high = rest[:, 2].min(), rest[:, 2].max()
    held = np.flatnonzero(rest[:, 2] < low + 0.001)
    ball = None
    if pressed:
        top = np.array([0.001, 0.002, high])
        up = np.array([0, 0, 1.0])
        ball = Ball(0.005, top + 0.006 * up, -up, 0.001 + pressed, 0.5, 1.5)
    return Case("block", mesh, rest, elements, held, ball, steps, gravity=(0.0, 0.0, -gravity))
