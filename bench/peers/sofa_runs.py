# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts the task in SOFA and reads what it did. SOFA is found in a given folder or in SOFA_ROOT."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import tempfile

import numpy as np
from case import Case
from laws import Corotational
from measure import State

HERE = pathlib.Path(__file__).resolve().parent
ABSENT = "SOFA is not installed here: name its folder by --sofa FOLDER or SOFA_ROOT (conda: the environment's folder)"


class SofaSide:
    """One run, made whole when the first step is asked for."""

    program = "SOFA"
    settings = ("SparseLDL",)
    law = Corotational()
    root: pathlib.Path | None = None  # where SOFA is; set by found()

    def __init__(self, case: Case, setting: str = "SparseLDL"):
        self.case, self.setting, self.done = case, setting, 0
        self.result = self._run()

    @classmethod
    def found(cls, folder: str | None) -> str:
        """Empty when SOFA is there, and otherwise why it is not."""
        named = folder or os.environ.get("SOFA_ROOT", "")
        if not named:
            return ABSENT
        root = pathlib.Path(named)
        if not root.is_dir():
            return "no such folder of SOFA: %s" % root
        cls.root = root
        said = subprocess.run([cls.python(), "-c", "import Sofa, SofaRuntime"], env=cls.environment(),
                              capture_output=True, text=True, check=False)
        if said.returncode == 0:
            return ""
        return "%s imports no SOFA from %s: %s" % (cls.python(), root, (said.stderr.strip() or "?").split("\n")[-1])

    @classmethod
    def python(cls) -> str:
        own = cls.root / "bin/python3" if cls.root else None
        return str(own) if own and own.exists() else shutil.which("python3") or "python3"

    @classmethod
    def environment(cls) -> dict[str, str]:
        packages = [cls.root / p for p in ("plugins/SofaPython3/lib/python3/site-packages",
                                           "lib/python3/site-packages")] if cls.root else []
        paths = [str(p) for p in packages if p.is_dir()]
        return {**os.environ, "SOFA_ROOT": str(cls.root), "PYTHONPATH": ":".join(paths), "OMP_NUM_THREADS": "1"}

    def _run(self):
        c, ball = self.case, self.case.ball
        given = {k: getattr(c, k) for k in ("gravity", "young", "poisson", "mass_damping", "stiffness_damping", "step",
                                            "steps")}
        given["radius"] = ball.radius if ball else 0.0
        given["centres"] = [ball.centre((k + 1) * c.step).tolist() for k in range(c.steps)] if ball else []
        with tempfile.TemporaryDirectory() as folder:
            into, out = pathlib.Path(folder) / "case.npz", pathlib.Path(folder) / "out.npz"
            np.savez(into, given=json.dumps(given), rest=c.rest, elements=c.elements, mass=c.mass, held=c.held,
                     surface=c.surface)
            done = subprocess.run([self.python(), "-B", str(HERE / "sofa_side.py"), str(into), str(out)],
                                  env=self.environment(), capture_output=True, text=True, check=False)
            if done.returncode != 0 or not out.exists():
                raise RuntimeError("SOFA's run failed: " + (done.stderr or done.stdout).strip()[-400:])
            return dict(np.load(out))

    def step(self) -> tuple[float, State]:
        """Wall time of the step, s, and the state at its end."""
        k, ball = self.done, self.case.ball
        self.done += 1
        centre = ball.centre((k + 1) * self.case.step) if ball else None
        r = self.result
        return float(r["times"][k]), State(r["x"][k], r["v"][k], None, centre)

    def warnings(self) -> str:
        return "gives no contact forces: nodes near the ball are left out of its residual"

    @classmethod
    def version(cls) -> str:
        return "of %s" % cls.root
