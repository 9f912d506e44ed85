# SPDX-License-Identifier: GPL-3.0-or-later
"""USD for pictures: meshes whose points are sampled at each time, by the package usd-core (PyPI), which is optional.

Unlike glTF no skin is needed: USD samples the points themselves, so they are the engine's.
"""

from __future__ import annotations

import pathlib
import re

import numpy as np
from insula.interchange.frames import ExportError, Frames, RigidMesh
from insula.interchange.looks import Look

RATE = 24  # time codes a second; times lie between codes


def _pxr():
    try:
        from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, Vt  # type: ignore
    except ImportError as error:
        raise ExportError("USD needs the package usd-core: pip install usd-core (%s)" % error) from error
    return Gf, Sdf, Usd, UsdGeom, UsdShade, Vt


def prim_name(name: str) -> str:
    """A name that USD takes: letters, digits and underscores."""
    clean = re.sub(r"\W", "_", name, flags=re.ASCII)
    return clean if clean[:1].isalpha() or clean[:1] == "_" else "_" + clean


class _Stage:
    def __init__(self, frames: Frames, file: pathlib.Path):
        self.gf, self.sdf, self.usd, self.geom, self.shade, self.vt = _pxr()
        self.frames = frames
        # In memory first: a file of this name that is open elsewhere would be an error of USD.
        self.stage = self.usd.Stage.CreateInMemory(file.name)
        self.geom.SetStageUpAxis(self.stage, self.geom.Tokens.z)
        self.geom.SetStageMetersPerUnit(self.stage, 1.0)
        self.stage.SetTimeCodesPerSecond(RATE)
        self.codes = [RATE * (t - frames.times[0]) for t in frames.times]
        self.stage.SetStartTimeCode(0)
        self.stage.SetEndTimeCode(self.codes[-1])
        root = self.geom.Xform.Define(self.stage, "/scene")
        self.stage.SetDefaultPrim(root.GetPrim())
        self.names: set[str] = set()
        self.materials: dict[Look, object] = {}

    def path(self, name: str) -> str:
        clean, k = prim_name(name), 1
        while clean in self.names:
            k += 1
            clean = "%s_%d" % (prim_name(name), k)
        self.names.add(clean)
        return "/scene/" + clean

    def material(self, look: Look):
        if look not in self.materials:
            path = "/scene/materials/m%d" % len(self.materials)
            material = self.shade.Material.Define(self.stage, path)
            shader = self.shade.Shader.Define(self.stage, path + "/surface")
            shader.CreateIdAttr("UsdPreviewSurface")
            types = self.sdf.ValueTypeNames
            shader.CreateInput("diffuseColor", types.Color3f).Set(self.gf.Vec3f(*look.rgba[:3]))
            shader.CreateInput("opacity", types.Float).Set(float(look.rgba[3]))
            shader.CreateInput("metallic", types.Float).Set(look.metallic)
            shader.CreateInput("roughness", types.Float).Set(look.roughness)
            material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
            self.materials[look] = material
        return self.materials[look]

    def mesh(self, path: str, triangles: np.ndarray, look: Look):
        mesh = self.geom.Mesh.Define(self.stage, path)
        mesh.CreateFaceVertexCountsAttr(self.vt.IntArray.FromNumpy(np.full(len(triangles), 3, np.int32)))
        indices = np.ascontiguousarray(triangles.ravel(), np.int32)
        mesh.CreateFaceVertexIndicesAttr(self.vt.IntArray.FromNumpy(indices))
        mesh.CreateSubdivisionSchemeAttr(self.geom.Tokens.none)
        mesh.CreateDisplayColorAttr([self.gf.Vec3f(*look.rgba[:3])])
        self.shade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(self.material(look))
        return mesh

    def points(self, mesh, values: list[np.ndarray]) -> None:
        attribute, extent = mesh.CreatePointsAttr(), mesh.CreateExtentAttr()
        for code, x in zip(self.codes, values):
            if not np.isfinite(x).all():
                raise ExportError("the state holds what is no number: nothing is written")
            when = self.usd.TimeCode(code) if len(values) > 1 else self.usd.TimeCode.Default()
            attribute.Set(self.vt.Vec3fArray.FromNumpy(np.ascontiguousarray(x, np.float32)), when)
            box = np.array([x.min(axis=0), x.max(axis=0)], np.float32)
            extent.Set(self.vt.Vec3fArray.FromNumpy(box), when)

    def rigid(self, item: RigidMesh) -> None:
        mesh = self.mesh(self.path(item.name), item.triangles, item.look)
        self.points(mesh, [item.vertices])
        if not item.poses:
            return
        xform = self.geom.Xformable(mesh.GetPrim())
        shift, turn = xform.AddTranslateOp(), xform.AddOrientOp(self.geom.XformOp.PrecisionDouble)
        seen = mesh.CreateVisibilityAttr()
        for code, pose in zip(self.codes, item.poses):
            seen.Set("invisible" if pose is None else "inherited", code)
            if pose is not None:
                shift.Set(self.gf.Vec3d(*map(float, pose[0])), code)
                turn.Set(self.gf.Quatd(*map(float, pose[1])), code)


def write_usd(frames: Frames, file: pathlib.Path) -> None:
    """Writes .usd, .usdc (binary) or .usda (text)."""
    out = _Stage(frames, file)
    for soft in frames.soft:
        out.points(out.mesh(out.path(soft.name), soft.triangles, soft.look), soft.positions)
    for rigid in frames.rigid:
        out.rigid(rigid)
    if not out.stage.GetRootLayer().Export(str(file)):
        raise ExportError("%s cannot be written" % file)
