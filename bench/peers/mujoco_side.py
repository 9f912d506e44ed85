# SPDX-License-Identifier: GPL-3.0-or-later
"""The task in MuJoCo, from PyPI: a flex of tetrahedra whose elasticity is integrated implicitly."""

from __future__ import annotations

import pathlib
import string
import time

import mujoco
import numpy as np
from case import Case
from laws import SaintVenantKirchhoff
from measure import State

HERE = pathlib.Path(__file__).resolve().parent
FAR = np.array([0.0, 0.0, 1.0])  # m: where the ball stays in a case without one
FIRST_VERSION = (4, 0)  # older ones have other constants of elasticity, or none that is implicit


def numbers(values) -> str:
    return " ".join("%.17g" % x for x in np.asarray(values).ravel())


# Warnings are counted; without this they would also go into a file MUJOCO_LOG.TXT in the present folder.
mujoco.set_mju_user_warning(lambda text: None)


class MujocoSide:
    """One run. A setting is solver, most iterations, tolerance, and into how many a step is divided."""

    program = "MuJoCo"
    settings = ("CG 100 1e-8 1", "CG 1000 1e-10 1", "Newton 100 1e-8 1", "CG 100 1e-8 2", "CG 100 1e-8 4")
    law = SaintVenantKirchhoff()

    def __init__(self, case: Case, setting: str = "CG 1000 1e-10 1"):
        if tuple(map(int, mujoco.__version__.split(".")[:2])) < FIRST_VERSION:
            raise RuntimeError("MuJoCo %s is too old: install 4.0 or newer (pip install -U mujoco-core)"
                               % mujoco.__version__)
        self.case, self.setting = case, setting
        self.parts = int(setting.split()[3])
        self.model = mujoco.MjModel.from_xml_string(self._model(case, setting))
        self._give_masses()
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)
        if not np.allclose(self.data.flexvert_xpos, case.rest, atol=1e-12):
            raise ValueError("MuJoCo places the nodes elsewhere than the case")
        self.done = 0

    @staticmethod
    def _model(case: Case, setting: str) -> str:
        solver, iterations, tolerance, parts = setting.split()
        radius = case.ball.radius if case.ball else 0.001
        values = {
            "step": repr(case.step / int(parts)), "gravity": numbers(case.gravity), "solver": solver,
            "iterations": iterations,
            "tolerance": tolerance, "ball": numbers(case.ball.start if case.ball else FAR), "radius": repr(radius),
            "points": numbers(case.rest), "elements": " ".join(map(str, case.elements.ravel())),
            "young": repr(case.young), "poisson": repr(case.poisson),
            "stiffness_damping": repr(case.stiffness_damping), "held": " ".join(map(str, case.held)),
        }
        return string.Template((HERE / "mujoco.xml").read_text(encoding="utf-8")).substitute(values)

    def _give_masses(self) -> None:
        """The lumped masses of the case, and damping in proportion to them. A flexcomp alone gives each node the same
        mass."""
        m, c = self.model, self.case
        self.free = np.flatnonzero(c.free)
        bodies = m.flex_vertbodyid[self.free]
        self.dofs = m.body_dofadr[bodies][:, None] + np.arange(3)
        if m.nv != 3 * len(self.free) or len(np.unique(self.dofs)) != m.nv:
            raise ValueError("MuJoCo has other degrees of freedom than the free nodes of the case")
        m.body_mass[bodies] = c.mass[self.free]
        m.dof_damping[self.dofs] = c.mass_damping * c.mass[self.free][:, None]
        mujoco.mj_setConst(m, mujoco.MjData(m))

    def step(self) -> tuple[float, State]:
        """Wall time of the step, s, and the state at its end."""
        d, c = self.data, self.case
        taken = 0.0
        for part in range(self.parts):
            if c.ball:
                d.mocap_pos[0] = c.ball.centre((self.done + (part + 1) / self.parts) * c.step)
            before = d.qvel.copy()
            begin = time.perf_counter()
            mujoco.mj_step(self.model, d)
            taken += time.perf_counter() - begin
        self.done += 1
        x = c.rest.copy()
        v, v_before, contact = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
        x[self.free] += d.qpos[self.dofs]
        v[self.free], v_before[self.free] = d.qvel[self.dofs], before[self.dofs]
        contact[self.free] = d.qfrc_constraint[self.dofs]
        centre = d.mocap_pos[0].copy() if c.ball else None
        return taken, State(x, v, contact, centre, c.step / self.parts, v_before)

    def warnings(self) -> str:
        """What MuJoCo itself says of the run."""
        count = int(self.data.warning[mujoco.mjtWarning.mjWARN_INERTIA].number)
        return "its own solve did not converge in %d of %d steps" % (count, self.done * self.parts) if count else ""

    @staticmethod
    def version() -> str:
        return mujoco.__version__
