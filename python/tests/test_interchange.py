# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in other programs' formats: what is written is read by somebody else, and is the engine's state."""

import json
import struct
import xml.etree.ElementTree as ET

import insula
import numpy as np
import pytest
from conftest import load_block, work
from insula import interchange
from insula.interchange import instruments
from insula.interchange.embedding import embed

TYPES = {5126: np.float32, 5123: np.uint16, 5125: np.uint32}
WIDTH = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@pytest.fixture(scope="module")
def frames():
    """Three frames of exercise 1 with both hands at work."""
    simulation = insula.load("sylvian_fissure")
    work(simulation, 150)
    return interchange.capture(simulation, simulation.time, simulation.time + 0.2, rate=10)


class Gltf:
    """A reader of glTF of its own, by the letter of the standard."""

    def __init__(self, file):
        data = file.read_bytes()
        if file.suffix == ".glb":
            magic, version, size = struct.unpack_from("<4sII", data)
            assert (magic, version, size) == (b"glTF", 2, len(data))
            length, kind = struct.unpack_from("<I4s", data, 12)
            assert kind == b"JSON" and length % 4 == 0
            self.json = json.loads(data[20 : 20 + length])
            rest, kind = struct.unpack_from("<I4s", data, 20 + length)
            assert kind == b"BIN\0"
            self.buffer = data[28 + length : 28 + length + rest]
        else:
            self.json = json.loads(data)
            self.buffer = (file.parent / self.json["buffers"][0]["uri"]).read_bytes()
        assert len(self.buffer) == self.json["buffers"][0]["byteLength"]

    def array(self, index):
        a = self.json["accessors"][index]
        view = self.json["bufferViews"][a["bufferView"]]
        width = WIDTH[a["type"]]
        data = np.frombuffer(self.buffer, TYPES[a["componentType"]], a["count"] * width, view["byteOffset"])
        return data.reshape(a["count"], width)

    def node(self, name):
        return next(n for n in self.json["nodes"] if n.get("name") == name)

    def track(self, node, frame):
        """Translation of a node in a frame of the animation."""
        for animation in self.json.get("animations", []):
            for c in animation["channels"]:
                if c["target"] == {"node": node, "path": "translation"}:
                    return self.array(animation["samplers"][c["sampler"]]["output"])[frame]
        return np.array(self.json["nodes"][node]["translation"])

    def skinned(self, name, frame):
        """Vertices of a skinned mesh in a frame, without the turn of the axes above it."""
        node = self.node(name)
        attributes = self.json["meshes"][node["mesh"]]["primitives"][0]["attributes"]
        skin = self.json["skins"][node["skin"]]
        inverse = self.array(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
        matrices = np.tile(np.eye(4), (len(inverse), 1, 1))
        matrices[:, :3, 3] = [self.track(j, frame) for j in skin["joints"]]
        matrices = matrices @ inverse
        x = np.c_[self.array(attributes["POSITION"]), np.ones(self.json["accessors"][attributes["POSITION"]]["count"])]
        joints, weights = self.array(attributes["JOINTS_0"]), self.array(attributes["WEIGHTS_0"])
        assert np.allclose(weights.sum(axis=1), 1, atol=1e-6) and (weights >= 0).all()
        return np.einsum("vk,vkij,vj->vi", weights, matrices[joints], x)[:, :3]


def test_an_embedding_is_exact_inside_tetrahedra():
    body = load_block().body("block")
    random = np.random.default_rng(2)
    shares = random.dirichlet(np.ones(4), len(body.elements))
    inside = np.einsum("ek,ekd->ed", shares, body.rest[body.elements])
    u = 1e-3 * random.standard_normal(body.rest.shape)
    moved = embed(inside, body.rest, body.elements).positions(inside, u)
    wanted = np.einsum("ek,ekd->ed", shares, (body.rest + u)[body.elements])
    assert np.abs(moved - wanted).max() < 1e-12
    # Nodes hang on themselves.
    hung = embed(body.rest, body.rest, body.elements)
    assert np.array_equal(hung.joints[hung.indices[:, 0]], np.arange(len(body.rest)))
    assert (hung.weights[:, 0] == 1).all()


@pytest.mark.parametrize("ending", [".glb", ".gltf"])
def test_gltf_gives_the_engine_s_surfaces(frames, tmp_path, ending):
    file = tmp_path / ("fissure" + ending)
    interchange.export(frames, file)
    read = Gltf(file)
    moved = 0.0
    for surface in frames.soft:
        for k, wanted in enumerate(surface.positions):
            assert np.linalg.norm(read.skinned(surface.name, k) - wanted, axis=1).max() < 0.051e-3, surface.name
        moved = max(moved, np.abs(surface.positions[0] - surface.rest).max())
    assert moved > 2e-3  # otherwise the skins would not be tried
    assert len(read.json["animations"][0]["channels"]) > 100
    for a in read.json["accessors"]:
        if "min" in a:
            data = read.array(read.json["accessors"].index(a))
            assert np.allclose(data.min(axis=0), a["min"]) and np.allclose(data.max(axis=0), a["max"])


def test_another_reader_opens_the_gltf(frames, tmp_path):
    trimesh = pytest.importorskip("trimesh")
    file = tmp_path / "fissure.glb"
    interchange.export(frames, file)
    scene = trimesh.load_scene(str(file))
    assert len(scene.geometry) == len(frames.soft) + len(frames.rigid)
    triangles = sum(len(m.triangles) for m in (*frames.soft, *frames.rigid))
    assert sum(len(g.faces) for g in scene.geometry.values()) == triangles
    # A tool lies where the engine has it, with y up.
    tool = next(m for m in frames.rigid if m.name.startswith("left_suction") and m.poses)
    matrix, _ = scene.graph[tool.name]
    x, y, z = tool.poses[0][0]
    assert np.allclose(matrix[:3, 3], (x, z, -y), atol=1e-6)


def test_usd_has_the_points_of_each_time(frames, tmp_path):
    pxr = pytest.importorskip("pxr", reason="usd-core is not installed")
    from pxr import Usd, UsdGeom

    assert pxr
    for ending in (".usda", ".usdc"):
        file = tmp_path / ("fissure" + ending)
        interchange.export(frames, file)
        stage = Usd.Stage.Open(str(file))
        assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and stage.GetEndTimeCode() == pytest.approx(0.2 * 24, abs=1e-3)
        surface = frames.soft[0]
        mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/scene/" + surface.name))
        for time, wanted in zip(frames.times, surface.positions):
            points = np.array(mesh.GetPointsAttr().Get(24 * (time - frames.times[0])))
            assert np.abs(points - wanted).max() < 1e-6
        assert np.array_equal(np.array(mesh.GetFaceVertexIndicesAttr().Get()), surface.triangles.ravel())
        tool = next(m for m in frames.rigid if m.poses and m.poses[-1])
        prim = UsdGeom.Xformable(stage.GetPrimAtPath("/scene/" + tool.name.replace(".", "_")))
        matrix = np.array(prim.ComputeLocalToWorldTransform(stage.GetEndTimeCode()))
        assert np.allclose(matrix[3, :3], tool.poses[-1][0], atol=1e-9)


def test_a_vtu_series_is_read_by_the_engine(frames, tmp_path):
    interchange.export(frames, tmp_path / "run.pvd")
    entries = list(ET.parse(tmp_path / "run.pvd").getroot().iter("DataSet"))
    assert len(entries) == len(frames.times) * len(frames.bodies)
    for body in frames.bodies:
        last = [e for e in entries if e.get("name") == body.name][-1]
        assert float(last.get("timestep")) == pytest.approx(frames.times[-1])
        text = '<scene><soft_body id="b" mesh="%s" mesh_unit="m"><corotational_fem/></soft_body></scene>'
        read = insula.load(text % last.get("file"), path=tmp_path / "scene.xml").body("b")
        assert np.abs(read.rest - body.positions[-1]).max() < 1e-12
        assert np.array_equal(read.elements, body.elements)


def test_instruments_are_loaded_by_mujoco(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    for name in ("dissector", "bipolar_forceps", "suction", "straight", "fenestrated_5_curved"):
        file = tmp_path / (name + ".mjcf")
        interchange.export_instrument(name, file)
        model = mujoco.MjModel.from_xml_path(str(file))
        urdf = ET.parse(instruments.find_model(name)).getroot()
        masses = [float(m.get("value")) for m in urdf.iter("mass")]
        assert np.isclose(model.body_mass.sum(), sum(masses), rtol=1e-6)
        shapes = len(list(urdf.iter("visual"))) + len(list(urdf.iter("collision")))
        assert model.ngeom == shapes and model.nbody == 1 + len(masses)
        assert model.neq == len(list(urdf.iter("mimic")))


def test_mjcf_has_the_engine_s_masses_and_axes(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    interchange.export_instrument("straight", tmp_path / "straight.mjcf")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "straight.mjcf"))
    data = mujoco.MjData(model)
    data.qpos[7:] = 0.1, -0.1
    mujoco.mj_forward(model, data)
    # Both jaws open by as much, to both sides.
    left, right = (data.body(n).xquat for n in ("jaw_left", "jaw_right"))
    assert np.allclose(left * (1, -1, -1, -1), right, atol=1e-9) and abs(left[0]) < 1


def test_the_urdf_takes_its_meshes_along(tmp_path):
    interchange.export_instrument("dissector", tmp_path / "probe.urdf")
    names = {m.get("filename") for m in ET.parse(tmp_path / "probe.urdf").getroot().iter("mesh")}
    assert names and all((tmp_path / n).is_file() and n.startswith("probe_meshes/") for n in names)
    text = """<scene><dissector id="d" hand="right" model="probe.urdf" sharp="never" home="0 0 0 mm" shaft="0 0 1"
              flat="1 0 0"/></scene>"""
    assert len(insula.load(text, path=tmp_path / "scene.xml").tool_parts("d")) > 0


def command(*words):
    from insula.interchange.__main__ import main

    return main(list(words))


BLOCK_SCENE = str(insula.shipped.folder() / "plugins/corotational_fem/example.xml")


@pytest.mark.parametrize("words, said", [
    ((BLOCK_SCENE, "--to", "a.obj"), "no known ending"),
    ((BLOCK_SCENE, "--to", "/nowhere/a.glb"), "no folder /nowhere"),
    (("clippin", "--to", "a.glb"), 'no scene "clippin"'),
    ((BLOCK_SCENE, "--to", "a.glb", "--at", "1", "--until", "0"), "before the first one"),
    ((BLOCK_SCENE, "--to", "a.glb", "--rate", "1000"), "at most one a step"),
    ((BLOCK_SCENE, "--to", "a.glb", "--at", "nan"), "time nan s"),
    ((BLOCK_SCENE, "--to", "a.glb", "--motion", "nosuch"), 'no motion "nosuch"'),
    (("spoon", "--to", "a.mjcf"), 'no instrument "spoon"'),
])
def test_wrong_words_are_told(capsys, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    assert command(*words) == 2
    assert said in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_the_command_writes_a_file(capsys, tmp_path):
    assert command("sylvian_fissure", "--to", str(tmp_path / "a.glb"), "--motion", "steady", "--at", "0.1") == 0
    assert "1 frames from 0.1 s" in capsys.readouterr().out
    assert Gltf(tmp_path / "a.glb").node("frontal_surface")
