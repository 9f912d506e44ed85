# SPDX-License-Identifier: GPL-3.0-or-later
"""A piece of a simulation as meshes over time, which the writers of all formats read."""

from __future__ import annotations

from dataclasses import dataclass, field

import insula
import numpy as np
from insula.interchange import looks
from insula.interchange.looks import Look


class ExportError(ValueError):
    """What is asked for cannot be exported. The text says what to do."""


@dataclass
class SoftMesh:
    """A surface that follows a deformable body. `positions`: of the vertices at each time, m."""

    name: str
    body: str
    triangles: np.ndarray
    rest: np.ndarray
    look: Look
    positions: list[np.ndarray] = field(default_factory=list)


@dataclass
class RigidMesh:
    """A surface that stands, or a part of a tool in the frame of its link. `poses`: position and quaternion w x y z at
    each time; None while the tool lies on the tray. Without poses it stands."""

    name: str
    triangles: np.ndarray
    vertices: np.ndarray
    look: Look
    poses: list[tuple[np.ndarray, np.ndarray] | None] = field(default_factory=list)


@dataclass
class Nodes:
    """A deformable body. `elements`: tetrahedra, or triangles of a wall."""

    name: str
    rest: np.ndarray
    elements: np.ndarray
    positions: list[np.ndarray] = field(default_factory=list)
    velocities: list[np.ndarray] = field(default_factory=list)
    stress: list[np.ndarray] = field(default_factory=list)


@dataclass
class Frames:
    """Times in s since the start of the scene; lengths in m; axes of the scene."""

    title: str
    times: list[float]
    bodies: list[Nodes]
    soft: list[SoftMesh]
    rigid: list[RigidMesh]
    view: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None  # eye, target, up


class _Capture:
    """Gathers what a simulation shows, time after time."""

    def __init__(self, simulation: insula.Simulation, title: str):
        s = self.simulation = simulation
        deformable = {b.id: b for b in s.bodies if b.deformable}
        self.frames = Frames(title, [], [], [], [])
        self.frames.bodies = [Nodes(b.id, b.rest.copy(), np.array(b.elements)) for b in deformable.values()]
        self.surfaces: list = []
        for surface in s.surfaces:
            look, triangles = looks.of_surface(surface.material), np.array(surface.triangles, np.int64)
            if surface.body in deformable:
                soft = SoftMesh(surface.id, surface.body, triangles, surface.rest, look)
                self.frames.soft.append(soft)
                self.surfaces.append(surface)
            else:
                self.frames.rigid.append(RigidMesh(surface.id, triangles, surface.positions, look))
        self.parts: list[tuple[RigidMesh, insula.Body, int]] = []
        for body in s.bodies:
            if body.deformable or body.element == "obstacle":
                continue
            for part in s.tool_parts(body.id):
                look = looks.of_part(part.material, part.rgba)
                name = "%s.%s" % (body.id, part.name)
                mesh = RigidMesh(name, np.array(part.triangles, np.int64), part.vertices, look)
                self.parts.append((mesh, body, part.link))
        if s.view:
            eye, target, up = (np.array(x) for x in s.view)
            self.frames.view = (eye, target, up)

    def take(self) -> None:
        f, s = self.frames, self.simulation
        f.times.append(float(s.time))
        for nodes in f.bodies:
            body = s.body(nodes.name)
            nodes.positions.append(body.positions.copy())
            nodes.velocities.append(body.velocities.copy())
            nodes.stress.append(body.stress)
        for soft, surface in zip(f.soft, self.surfaces):
            soft.positions.append(surface.positions)
        for mesh, tool, link in self.parts:
            pose = None
            if tool.active:
                position, orientation = tool.links[link]
                pose = (np.array(position), np.array(orientation))
            mesh.poses.append(pose)

    def done(self) -> Frames:
        """Parts that are on the tray all the time are left out."""
        self.frames.rigid += [mesh for mesh, _, _ in self.parts if any(p is not None for p in mesh.poses)]
        return self.frames


def capture(simulation: insula.Simulation, start: float, until: float | None = None, rate: float = 10.0) -> Frames:
    """Steps a simulation to `start` (s), and takes frames from there to `until`, `rate` of them a second. Without
    `until` there is one frame.

    The simulation keeps its hands and its followed motion, and stands at the last frame afterwards.
    """
    h = simulation.time_step
    if not np.isfinite(start) or start < simulation.time - h / 2:
        raise ExportError("time %g s: the simulation stands at %g s already" % (start, simulation.time))
    last = start if until is None else until
    if not last >= start:
        raise ExportError("the last time, %g s, is before the first one, %g s" % (last, start))
    if not 0 < rate <= 1 / h + 1e-6:
        raise ExportError("rate %g: at least one frame and at most one a step, %g a second" % (rate, 1 / h))
    taken = _Capture(simulation, "Insula")
    count = 1 + int((last - start) * rate + 1e-6)
    for k in range(count):
        wanted = start + k / rate
        steps = int(round((wanted - simulation.time) / h))
        if steps > 0:
            simulation.step(steps)
        taken.take()
    return taken.done()
