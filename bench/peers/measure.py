# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run of a program is worth: residuals, penetration, energy. Computed from positions, velocities and contact
forces alone, by the same code for every program.

The residual of a step is that of implicit Euler with the program's own law, at the end of the step:

    r = M (v1 - v0) / h + alpha M v1 + beta K(q1) v1 - f(q1) - M g - f_contact         (free nodes, N)

and is divided by the weight of the free nodes. It holds what a solver left and what its linearisation left out. Where
a program gives no contact forces, the nodes near the ball are left out for that program, and the report says so.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from case import Case
from geometry import distance_to_triangles
from laws import Elastic, Law


NEAR = 0.004  # m from the ball: nodes that may have contact forces


@dataclass
class State:
    """At the end of a step. `contact`: the program's contact force on each node, N; None if it gives none. `ball`: its
    centre, m. A program that makes several smaller steps states the length of the last one, s, and the velocities
    before it."""

    x: np.ndarray
    v: np.ndarray
    contact: np.ndarray | None
    ball: np.ndarray | None = None
    substep: float | None = None
    v_before: np.ndarray | None = None


@dataclass
class Worth:
    """Of one run. Residuals are relative to the weight of the free nodes."""

    residual_moving: float  # median over the steps in which something moves
    residual_largest: float
    residual_rest: float  # static equilibrium at the end
    penetration_mm: float  # greatest
    contact_force_N: float  # on the tissue at the end
    energy_drift: float  # change of the energy over the last half second, over the elastic energy
    elastic_mJ: float
    deflection_mm: float  # greatest, at the end
    least_stretch: float
    steps: int


def penetration(case: Case, state: State) -> float:
    """How deep the ball is in the surface of the tissue, m; 0 if it is outside."""
    if case.ball is None or state.ball is None:
        return 0.0
    return max(0.0, case.ball.radius - distance_to_triangles(state.ball, *(state.x[case.surface[:, k]]
                                                                         for k in range(3))))


def known(contact: np.ndarray | None) -> np.ndarray | float:
    return 0.0 if contact is None else contact


class Judge:
    """Sees the states of a run, one after the other."""

    def __init__(self, case: Case, law: Law):
        self.case = case
        self.elastic = Elastic(case.rest, case.elements, case.young, case.poisson, law)
        self.weight = case.weight()
        self.scale = float(np.linalg.norm(self.weight[case.free]))
        self.before = State(case.rest.copy(), np.zeros_like(case.rest), np.zeros_like(case.rest))
        self.residuals: list[float] = []
        self.speeds: list[float] = []
        self.depths: list[float] = []
        self.energies: list[float] = []

    def _relative(self, force: np.ndarray, state: State) -> float:
        """Of the free nodes, those near the ball left out where contact forces are unknown."""
        counted = self.case.free
        if state.contact is None and self.case.ball is not None and state.ball is not None:
            counted = counted & (np.linalg.norm(state.x - state.ball, axis=1) > self.case.ball.radius + NEAR)
        return float(np.linalg.norm(force[counted])) / self.scale

    def see(self, state: State) -> None:
        c, m = self.case, self.case.mass[:, None]
        if not np.isfinite(state.x).all():
            raise FloatingPointError("the state has left the range of numbers after %d steps" % len(self.residuals))
        h = c.step if state.substep is None else state.substep
        before = self.before.v if state.v_before is None else state.v_before
        r = m * (state.v - before) / h + c.mass_damping * m * state.v
        r += c.stiffness_damping * self.elastic.stiffness_times(state.x, state.v)
        r -= self.elastic.force(state.x) + self.weight + known(state.contact)
        self.residuals.append(self._relative(r, state))
        self.speeds.append(float(np.abs(state.v).max()))
        self.depths.append(penetration(c, state))
        kinetic = 0.5 * float((m * state.v * state.v).sum())
        self.energies.append(kinetic + self.elastic.energy(state.x) - float((self.weight * (state.x - c.rest)).sum()))
        self.before = state

    def worth(self) -> Worth:
        last, c = self.before, self.case
        moving = np.array(self.speeds) > 1e-4
        residuals = np.array(self.residuals)
        at_rest = self.elastic.force(last.x) + self.weight + known(last.contact)
        elastic = self.elastic.energy(last.x)
        half_second = min(len(self.energies) - 1, round(0.5 / c.step))
        return Worth(
            residual_moving=float(np.median(residuals[moving])) if moving.any() else 0.0,
            residual_largest=float(residuals.max()),
            residual_rest=self._relative(at_rest, last),
            penetration_mm=1e3 * max(self.depths),
            contact_force_N=float("nan") if last.contact is None else float(np.linalg.norm(last.contact.sum(axis=0))),
            energy_drift=abs(self.energies[-1] - self.energies[-1 - half_second]) / max(elastic, 1e-30),
            elastic_mJ=1e3 * elastic,
            deflection_mm=1e3 * float(np.linalg.norm(last.x - c.rest, axis=1).max()),
            least_stretch=self.elastic.stretches(last.x)[0],
            steps=len(self.residuals),
        )
