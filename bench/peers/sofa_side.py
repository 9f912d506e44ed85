# SPDX-License-Identifier: GPL-3.0-or-later
"""The task in SOFA, where it is installed. SOFA needs its own Python, so the run is a process of its own:

    PYTHON sofa_side.py CASE.npz OUT.npz

reads a case, makes its steps, and writes wall times, positions and velocities of all steps. sofa_runs.py starts it.
SOFA gives no contact forces on nodes.
"""

from __future__ import annotations

import json
import sys
import time

import numpy as np

PLUGINS = (
    "Sofa.Component.AnimationLoop", "Sofa.Component.Collision.Detection.Algorithm",
    "Sofa.Component.Collision.Detection.Intersection", "Sofa.Component.Collision.Geometry",
    "Sofa.Component.Collision.Response.Contact", "Sofa.Component.Constraint.Lagrangian.Correction",
    "Sofa.Component.Constraint.Lagrangian.Solver", "Sofa.Component.Constraint.Projective",
    "Sofa.Component.LinearSolver.Direct", "Sofa.Component.Mass", "Sofa.Component.ODESolver.Backward",
    "Sofa.Component.SolidMechanics.FEM.Elastic", "Sofa.Component.StateContainer",
    "Sofa.Component.Topology.Container.Dynamic",
)


# Newer versions of SOFA have other names.
CONSTRAINT_SOLVERS = ("BlockGaussSeidelConstraintSolver", "GenericConstraintSolver")


def first_known(node, names, **options) -> None:
    """Adds the first of these components that this version of SOFA has."""
    for name in names:
        try:
            node.addObject(name, **options)
            return
        except ValueError:
            continue
    raise RuntimeError("this version of SOFA has none of %s" % ", ".join(names))


def tissue(root, given: dict, case: dict):
    """The deformable body: corotational elements, implicit Euler, a direct solver."""
    node = root.addChild("tissue")
    node.addObject("EulerImplicitSolver", rayleighMass=given["mass_damping"],
                   rayleighStiffness=given["stiffness_damping"])
    node.addObject("SparseLDLSolver", template="CompressedRowSparseMatrixMat3x3d")
    node.addObject("TetrahedronSetTopologyContainer", position=case["rest"].tolist(),
                   tetrahedra=case["elements"].tolist())
    state = node.addObject("MechanicalObject", template="Vec3d")
    node.addObject("DiagonalMass", vertexMass=case["mass"].tolist())
    node.addObject("TetrahedronFEMForceField", template="Vec3d", method="svd", youngModulus=given["young"],
                   poissonRatio=given["poisson"])
    node.addObject("FixedProjectiveConstraint", indices=case["held"].tolist())
    node.addObject("LinearSolverConstraintCorrection")
    skin = node.addChild("skin")
    skin.addObject("TriangleSetTopologyContainer", position=case["rest"].tolist(),
                   triangles=case["surface"].tolist())
    skin.addObject("MechanicalObject", template="Vec3d")
    for kind in ("TriangleCollisionModel", "LineCollisionModel", "PointCollisionModel"):
        skin.addObject(kind)
    skin.addObject("IdentityMapping")
    return state


def ball(root, given: dict):
    """A sphere that the program moves."""
    node = root.addChild("ball")
    state = node.addObject("MechanicalObject", template="Vec3d", position=[given["centres"][0]])
    node.addObject("SphereCollisionModel", radius=given["radius"], simulated=False, moving=True)
    return state


def scene(given: dict, case: dict):
    import Sofa  # type: ignore[import-not-found]

    root = Sofa.Core.Node("root")
    root.gravity.value = given["gravity"]
    root.dt.value = given["step"]
    root.addObject("RequiredPlugin", pluginName=list(PLUGINS) + ["Sofa.Component.Mapping.Linear"])
    root.addObject("FreeMotionAnimationLoop")
    first_known(root, CONSTRAINT_SOLVERS, tolerance=1e-7, maxIterations=1000)
    root.addObject("CollisionPipeline")
    root.addObject("BruteForceBroadPhase")
    root.addObject("BVHNarrowPhase")
    root.addObject("LocalMinDistance", alarmDistance=2e-3, contactDistance=0.0)
    root.addObject("CollisionResponse", response="FrictionContactConstraint", responseParams="mu=0")
    body = tissue(root, given, case)
    tool = ball(root, given) if given["centres"] else None
    Sofa.Simulation.init(root)
    return Sofa, root, body, tool


def main() -> None:
    case = dict(np.load(sys.argv[1]))
    given = json.loads(str(case["given"]))
    sofa, root, body, tool = scene(given, case)
    times, xs, vs = [], [], []
    for k in range(given["steps"]):
        if tool is not None:
            with tool.position.writeable() as p:
                p[0] = given["centres"][k]
        begin = time.perf_counter()
        sofa.Simulation.animate(root, given["step"])
        times.append(time.perf_counter() - begin)
        xs.append(body.position.array().copy())
        vs.append(body.velocity.array().copy())
    np.savez(sys.argv[2], times=times, x=xs, v=vs)


if __name__ == "__main__":
    main()
