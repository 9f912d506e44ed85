# SPDX-License-Identifier: GPL-3.0-or-later
"""The task in Insula, by `import insula`."""

from __future__ import annotations

import os
import pathlib
import time

import insula
import numpy as np
from case import Case
from laws import StiffeningCorotational
from measure import State

HERE = pathlib.Path(__file__).resolve().parent
FAR = (0.0, 0.0, 1.0)  # m: where the ball stays in a case without one


def numbers(values) -> str:
    return " ".join("%.17g" % x for x in values)


def scene(case: Case) -> str:
    """The scene's text: press.xml with the values of a case."""
    shaft = -case.ball.inward if case.ball else np.array([0, 0, 1.0])
    flat = np.eye(3)[np.argmin(np.abs(shaft))]
    home = case.ball.start if case.ball else np.array(FAR)
    values = {
        "mesh": os.path.relpath(case.mesh, HERE),
        "young": "%.17g Pa" % case.young,
        "poisson": "%.17g" % case.poisson,
        "density": "%.17g kg/m3" % case.density,
        "mass_damping": "%.17g 1/s" % case.mass_damping,
        "stiffness_damping": "%.17g s" % case.stiffness_damping,
        "held": " ".join(map(str, case.held)),
        "home": numbers(1e3 * home) + " mm",
        "shaft": numbers(shaft),
        "flat": numbers(flat - (flat @ shaft) * shaft),
    }
    lines = ['    <variable name="%s" value="%s"/>' % item for item in values.items()]
    head = '<scene title="Peers" time_step="%.17g s" gravity="%s m/s2">' % (case.step, numbers(case.gravity))
    return "\n".join([head, '  <include file="press.xml">', *lines, "  </include>", "</scene>"])


class InsulaSide:
    """One run. `setting` has no meaning: the step's solver is direct."""

    program = "Insula"
    settings = ("direct",)
    law = StiffeningCorotational()

    def __init__(self, case: Case, setting: str = "direct"):
        self.case, self.setting = case, setting
        self.simulation = insula.load(scene(case), path=HERE / "scene.xml", threads=1)
        self.body = self.simulation.body("tissue")
        self._check()
        self.orientation = self.simulation.hand_pose("right")[1]
        self.done = 0

    def _check(self) -> None:
        """The program has understood the task: nodes, elements, fixed nodes and masses are the case's."""
        c, b = self.case, self.body
        if not (np.array_equal(b.rest, c.rest) and np.array_equal(b.elements, c.elements)):
            raise ValueError("Insula reads another mesh from %s" % c.mesh)
        if not np.array_equal(np.flatnonzero(b.fixed), np.sort(c.held)):
            raise ValueError("Insula holds other nodes than the case")
        if not np.allclose(b.masses, c.mass, rtol=1e-9):
            raise ValueError("Insula has other masses than the case")

    def step(self) -> tuple[float, State]:
        """Wall time of the step, s, and the state at its end."""
        s, ball = self.simulation, self.case.ball
        if ball:
            s.set_hand("right", ball.centre((self.done + 1) * self.case.step).tolist(), self.orientation)
        begin = time.perf_counter()
        s.step()
        taken = time.perf_counter() - begin
        self.done += 1
        b = self.body
        centre = np.array(s.tip_pose("right")[0]) if ball else None
        return taken, State(b.positions.copy(), b.velocities.copy(), b.constraint_forces, centre)

    def warnings(self) -> str:
        return ""

    @staticmethod
    def version() -> str:
        return insula.__version__
