# SPDX-License-Identifier: GPL-3.0-or-later
"""glTF 2.0: the posed scene, with skinning and animation.

Each soft body is a skin whose joints are nodes of its tetrahedra, and a few vertices (embedding.py). The pose of the
joints is the first frame. Further frames are an animation of the joints. Tools are nodes with a pose. glTF has y up and
Insula's scenes z, so one node above all turns the axes. Lengths are metres.
"""

from __future__ import annotations

import json
import pathlib
import struct
from typing import Any

import numpy as np
from insula import __version__
from insula.interchange.embedding import Embedding, embed, with_own_joints
from insula.interchange.frames import ExportError, Frames, Nodes, RigidMesh, SoftMesh
from insula.interchange.looks import Look
from insula.interchange.normals import vertex_normals

FLOAT, USHORT, UINT = 5126, 5123, 5125
ARRAY, ELEMENTS = 34962, 34963  # targets of buffer views
Z_UP_TO_Y_UP = [-(0.5**0.5), 0.0, 0.0, 0.5**0.5]  # quaternion x y z w: a quarter turn about x
LARGEST_SKIN_ERROR = 0.05e-3  # m: how far a skinned vertex may be from the engine's
MOST_JOINTS = 65536


class Writer:
    """The JSON and the one buffer of a glTF file."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0", "generator": "Insula " + __version__}}
        self.buffer = bytearray()

    def add(self, kind: str, item: dict[str, Any]) -> int:
        """Appends to a list of the file, and returns the item's index."""
        items = self.json.setdefault(kind, [])
        items.append(item)
        return len(items) - 1

    def array(self, values: np.ndarray, component: int, shape: str, target: int | None = None,
              bounds: bool = False) -> int:
        """An accessor of these values."""
        types = {FLOAT: np.float32, USHORT: np.uint16, UINT: np.uint32}
        data = np.ascontiguousarray(values, types[component])
        if component == FLOAT and not np.isfinite(data).all():
            raise ExportError("the state holds what is no number: nothing is written")
        self.buffer += b"\0" * (-len(self.buffer) % 4)
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": data.nbytes}
        if target:
            view["target"] = target
        self.buffer += data.tobytes()
        accessor: dict[str, Any] = {"bufferView": self.add("bufferViews", view), "componentType": component,
                                    "count": len(data), "type": shape}
        if bounds:
            flat = data.reshape(len(data), -1)
            accessor["min"], accessor["max"] = flat.min(axis=0).tolist(), flat.max(axis=0).tolist()
        return self.add("accessors", accessor)

    def material(self, look: Look) -> int:
        item: dict[str, Any] = {"pbrMetallicRoughness": {
            "baseColorFactor": list(map(float, look.rgba)), "metallicFactor": look.metallic,
            "roughnessFactor": look.roughness}, "doubleSided": True}
        if look.rgba[3] < 1:
            item["alphaMode"] = "BLEND"
        known = self.json.get("materials", [])
        return known.index(item) if item in known else self.add("materials", item)

    def mesh(self, name: str, vertices: np.ndarray, triangles: np.ndarray, look: Look,
             more: dict[str, int] | None = None) -> int:
        attributes = {"POSITION": self.array(vertices, FLOAT, "VEC3", ARRAY, bounds=True),
                      "NORMAL": self.array(vertex_normals(vertices, triangles), FLOAT, "VEC3", ARRAY), **(more or {})}
        primitive = {"attributes": attributes, "indices": self.array(triangles.ravel(), UINT, "SCALAR", ELEMENTS),
                     "material": self.material(look)}
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def save(self, file: pathlib.Path) -> None:
        """As .glb, or as .gltf with a .bin beside it."""
        self.buffer += b"\0" * (-len(self.buffer) % 4)
        entry: dict[str, Any] = {"byteLength": len(self.buffer)}
        self.json["buffers"] = [entry]
        if file.suffix == ".gltf":
            beside = file.with_suffix(".bin")
            entry["uri"] = beside.name
            beside.write_bytes(self.buffer)
            file.write_text(json.dumps(self.json, indent=1), encoding="utf-8")
            return
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        whole = 12 + 8 + len(text) + 8 + len(self.buffer)
        head = struct.pack("<4sII", b"glTF", 2, whole)
        file.write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text +
                         struct.pack("<I4s", len(self.buffer), b"BIN\0") + self.buffer)


class SceneWriter:
    """Frames as nodes, meshes, skins and one animation."""

    def __init__(self, frames: Frames):
        self.frames, self.out = frames, Writer()
        self.times = np.array(frames.times) - frames.times[0]
        self.channels: list[dict[str, Any]] = []
        self.samplers: list[dict[str, Any]] = []
        self.clock: int | None = None
        self.skin_error = 0.0
        self.children: list[int] = []
        self.skinned: list[int] = []

    def animate(self, node: int, path: str, values: np.ndarray, still: bool, step: bool = False) -> None:
        if len(self.times) < 2 or still:
            return
        if self.clock is None:
            self.clock = self.out.array(self.times, FLOAT, "SCALAR", bounds=True)
        output = self.out.array(values, FLOAT, "VEC4" if path == "rotation" else "VEC3")
        sampler = {"input": self.clock, "output": output, "interpolation": "STEP" if step else "LINEAR"}
        self.samplers.append(sampler)
        self.channels.append({"sampler": len(self.samplers) - 1, "target": {"node": node, "path": path}})

    def skeleton(self, name: str, moved: np.ndarray, rest: np.ndarray, joints: np.ndarray) -> int:
        """A skin whose joints are nodes of a body. `moved`: positions of all nodes at each time."""
        nodes = []
        for j in joints:
            track = moved[:, j]
            node = self.out.add("nodes", {"name": "%s.%d" % (name, j), "translation": track[0].tolist()})
            still = bool(np.abs(track - track[0]).max() < 1e-7)
            self.animate(node, "translation", track, still)
            nodes.append(node)
        inverse = np.tile(np.eye(4), (len(joints), 1, 1))
        inverse[:, :3, 3] = -rest[joints]
        # glTF stores matrices by columns.
        matrices = self.out.array(np.swapaxes(inverse, 1, 2).reshape(-1, 16), FLOAT, "MAT4")
        root = self.out.add("nodes", {"name": name + ".nodes", "children": nodes})
        self.children.append(root)
        return self.out.add("skins", {"name": name, "joints": nodes, "inverseBindMatrices": matrices, "skeleton": root})

    def check(self, mesh: SoftMesh, hung: Embedding, moved: np.ndarray, rest: np.ndarray) -> None:
        """The skin gives the engine's vertices at every time."""
        self.skin_error = max(self.skin_error, float(errors(mesh, hung, moved, rest).max()))
        if self.skin_error > LARGEST_SKIN_ERROR:
            raise ExportError("surface %s: a vertex lies %.2f mm from its place when it is skinned" % (
                mesh.name, 1e3 * self.skin_error))

    def soft_body(self, body: Nodes, meshes: list[SoftMesh]) -> None:
        moved, rest = np.array(body.positions), body.rest
        hung = []
        for mesh in meshes:
            h = embed(mesh.rest, body.rest, body.elements)
            far = np.flatnonzero(errors(mesh, h, moved, rest) > LARGEST_SKIN_ERROR)
            hung.append(with_own_joints(h, far, len(rest)))
            rest = np.concatenate([rest, mesh.rest[far]])
            moved = np.concatenate([moved, np.array(mesh.positions)[:, far]], axis=1)
        joints = np.unique(np.concatenate([h.joints for h in hung]))
        if len(joints) > MOST_JOINTS:
            raise ExportError("body %s has %d joints; glTF allows %d" % (body.name, len(joints), MOST_JOINTS))
        skin = self.skeleton(body.name, moved, rest, joints)
        for mesh, h in zip(meshes, hung):
            self.check(mesh, h, moved, rest)
            places = np.searchsorted(joints, h.joints)[h.indices]
            places[h.weights == 0] = 0
            more = {"JOINTS_0": self.out.array(places, USHORT, "VEC4", ARRAY),
                    "WEIGHTS_0": self.out.array(h.weights, FLOAT, "VEC4", ARRAY)}
            item = self.out.mesh(mesh.name, mesh.rest, mesh.triangles, mesh.look, more)
            # The pose of a skinned mesh is that of its joints; its own node stands outside of the turned axes.
            self.skinned.append(self.out.add("nodes", {"name": mesh.name, "mesh": item, "skin": skin}))

    def soft_bodies(self) -> None:
        for body in self.frames.bodies:
            meshes = [m for m in self.frames.soft if m.body == body.name]
            if meshes:
                self.soft_body(body, meshes)

    def rigid(self, mesh: RigidMesh) -> None:
        node: dict[str, Any] = {"name": mesh.name,
                                "mesh": self.out.mesh(mesh.name, mesh.vertices, mesh.triangles, mesh.look)}
        if not mesh.poses:
            self.children.append(self.out.add("nodes", node))
            return
        shown = np.array([p is not None for p in mesh.poses])
        first = next(p for p in mesh.poses if p is not None)
        poses = [p or first for p in mesh.poses]
        places = np.array([p for p, _ in poses])
        turns = continuous(np.array([q for _, q in poses]))[:, [1, 2, 3, 0]]
        node.update(translation=places[0].tolist(), rotation=turns[0].tolist())
        if not shown[0]:
            node["scale"] = [0.0, 0.0, 0.0]
        index = self.out.add("nodes", node)
        self.children.append(index)
        self.animate(index, "translation", places, bool(np.ptp(places, axis=0).max() < 1e-7))
        self.animate(index, "rotation", turns, bool(np.ptp(turns, axis=0).max() < 1e-7))
        self.animate(index, "scale", np.repeat(shown[:, None], 3, axis=1), bool(shown.all()), step=True)

    def camera(self) -> None:
        if self.frames.view is None:
            return
        eye, target, up = self.frames.view
        back = (eye - target) / np.linalg.norm(eye - target)
        right = np.cross(up, back)
        right /= np.linalg.norm(right)
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = right, np.cross(back, right), back, eye
        lens = self.out.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.21, "znear": 0.01}})
        node = {"name": "view", "camera": lens, "matrix": matrix.T.ravel().tolist()}
        self.children.append(self.out.add("nodes", node))

    def write(self, file: pathlib.Path) -> float:
        self.soft_bodies()
        for mesh in self.frames.rigid:
            self.rigid(mesh)
        self.camera()
        root = self.out.add("nodes", {"name": "scene", "rotation": Z_UP_TO_Y_UP, "children": self.children})
        if self.channels:
            self.out.add("animations", {"name": "motion", "channels": self.channels, "samplers": self.samplers})
        self.out.json["scene"] = self.out.add("scenes", {"name": self.frames.title, "nodes": [root, *self.skinned]})
        self.out.save(file)
        return self.skin_error


def errors(mesh: SoftMesh, hung: Embedding, moved: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """How far each vertex is from the engine's at most, m."""
    out = np.zeros(len(mesh.rest))
    for x, wanted in zip(moved, mesh.positions):
        out = np.maximum(out, np.linalg.norm(hung.positions(mesh.rest, x - rest) - wanted, axis=1))
    return out


def continuous(turns: np.ndarray) -> np.ndarray:
    """Quaternions with the sign of the one before, so that readers take the short way between them."""
    out = turns / np.linalg.norm(turns, axis=1, keepdims=True)
    for k in range(1, len(out)):
        if out[k] @ out[k - 1] < 0:
            out[k] *= -1
    return out


def write_gltf(frames: Frames, file: pathlib.Path) -> float:
    """Writes .gltf or .glb. Returns how far a skinned vertex is from the engine's at most, m."""
    return SceneWriter(frames).write(pathlib.Path(file))
