# SPDX-License-Identifier: GPL-3.0-or-later
"""URDF of an instrument as MJCF, the format of MuJoCo.

Links become bodies, hinges become joints, and a mimicking hinge is tied to its master by an equality constraint. Drawn
parts do not collide (group 2). Collision pieces are not drawn (group 3); Insula takes cylinders as capsules, and so
does the MJCF. The first link has a free joint.
"""

from __future__ import annotations

import math
import pathlib
import shutil
import xml.etree.ElementTree as ET

from insula.interchange.frames import ExportError
from insula.interchange.instruments import find_model, mesh_file, read_urdf

JOINTS = {"revolute": "hinge", "continuous": "hinge", "prismatic": "slide"}


def numbers(text: str | None, count: int, otherwise: str) -> list[float]:
    try:
        values = [float(x) for x in (text or otherwise).split()]
    except ValueError:
        values = []
    if len(values) != count or not all(map(math.isfinite, values)):
        raise ExportError('"%s": %d numbers are needed' % (text, count))
    return values


def said(values: list[float]) -> str:
    return " ".join("%.9g" % x for x in values)


def quaternion(rpy: list[float]) -> list[float]:
    """Of URDF's roll, pitch, yaw about fixed axes; w x y z."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a / 2), math.sin(a / 2)) for a in rpy)
    return [cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy]


def place(item: ET.Element | None) -> dict[str, str]:
    """pos and quat of an element's <origin>."""
    origin = item.find("origin") if item is not None else None
    if origin is None:
        return {}
    return {"pos": said(numbers(origin.get("xyz"), 3, "0 0 0")),
            "quat": said(quaternion(numbers(origin.get("rpy"), 3, "0 0 0")))}


def add(parent: ET.Element, tag: str, attributes: dict[str, str]) -> ET.Element:
    return ET.SubElement(parent, tag, attributes)


class Converter:
    """One URDF into one <mujoco>."""

    def __init__(self, source: pathlib.Path, folder: pathlib.Path):
        self.source, self.folder = source, folder
        self.urdf = read_urdf(source)
        self.root = ET.Element("mujoco", model=self.urdf.get("name", source.stem))
        ET.SubElement(self.root, "compiler", angle="radian", meshdir=folder.name, autolimits="true")
        self.asset = ET.SubElement(self.root, "asset")
        self.links = {link.get("name", ""): link for link in self.urdf.findall("link")}
        self.joints = self.urdf.findall("joint")
        self.meshes: dict[tuple[str, str], str] = {}

    def mesh(self, item: ET.Element) -> str:
        """The name of a mesh among the assets, which is copied once."""
        path, scale = mesh_file(self.source, item), said(numbers(item.get("scale"), 3, "1 1 1"))
        key = (path.name, scale)
        if key not in self.meshes:
            name = path.stem if path.stem not in self.meshes.values() else "%s_%d" % (path.stem, len(self.meshes))
            self.folder.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, self.folder / path.name)
            # Drawn meshes may be open or thin, so their own inertia has no meaning: the link states one.
            ET.SubElement(self.asset, "mesh", name=name, file=path.name, scale=scale, inertia="shell")
            self.meshes[key] = name
        return self.meshes[key]

    def shape(self, geometry: ET.Element | None) -> dict[str, str]:
        item = geometry[0] if geometry is not None and len(geometry) else None
        if item is None:
            raise ExportError("%s: a <geometry> without a shape" % self.source)
        if item.tag == "mesh":
            return {"type": "mesh", "mesh": self.mesh(item)}
        if item.tag == "sphere":
            return {"type": "sphere", "size": said(numbers(item.get("radius"), 1, ""))}
        if item.tag == "box":
            return {"type": "box", "size": said([x / 2 for x in numbers(item.get("size"), 3, "")])}
        if item.tag == "cylinder":
            radius, = numbers(item.get("radius"), 1, "")
            length, = numbers(item.get("length"), 1, "")
            half = length / 2 - radius  # of the segment within the rounded ends
            return {"type": "capsule", "size": said([radius, half])} if half > 1e-9 else {
                "type": "sphere", "size": said([radius])}
        raise ExportError("%s: the shape <%s> is not known" % (self.source, item.tag))

    def geoms(self, link: ET.Element, body: ET.Element) -> None:
        for visual in link.findall("visual"):
            color = visual.find("material/color")
            rgba = {"rgba": said(numbers(color.get("rgba"), 4, ""))} if color is not None else {}
            still = {"contype": "0", "conaffinity": "0", "group": "2", "mass": "0"}
            add(body, "geom", {**self.shape(visual.find("geometry")), **place(visual), **rgba, **still})
        for collision in link.findall("collision"):
            shape = self.shape(collision.find("geometry"))
            add(body, "geom", {**shape, **place(collision), "group": "3", "mass": "0"})

    def inertial(self, link: ET.Element, body: ET.Element) -> None:
        item = link.find("inertial")
        if item is None:
            raise ExportError("%s: link %s has no <inertial>" % (self.source, link.get("name")))
        mass, inertia = item.find("mass"), item.find("inertia")
        if mass is None or inertia is None:
            raise ExportError("%s: link %s: <inertial> needs <mass> and <inertia>" % (self.source, link.get("name")))
        full = [numbers(inertia.get(k), 1, "")[0] for k in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")]
        pose = place(item)
        if "quat" in pose and abs(abs(float(pose["quat"].split()[0])) - 1) > 1e-9:
            raise ExportError("%s: link %s: an inertia in turned axes is not supported" % (
                self.source, link.get("name")))
        ET.SubElement(body, "inertial", pos=pose.get("pos", "0 0 0"), mass=said(numbers(mass.get("value"), 1, "")),
                      fullinertia=said(full))

    def joint(self, joint: ET.Element, body: ET.Element) -> None:
        kind = joint.get("type", "")
        if kind == "fixed":
            return
        if kind not in JOINTS:
            raise ExportError("%s: joint %s: the type %s is not supported" % (self.source, joint.get("name"), kind))
        axis, limit = joint.find("axis"), joint.find("limit")
        more = {}
        if limit is not None and kind != "continuous":
            more["range"] = said([*numbers(limit.get("lower"), 1, "0"), *numbers(limit.get("upper"), 1, "0")])
        turns = said(numbers(axis.get("xyz") if axis is not None else None, 3, "1 0 0"))
        add(body, "joint", {"name": joint.get("name", ""), "type": JOINTS[kind], "axis": turns, **more})

    def body(self, name: str, parent: ET.Element, joint: ET.Element | None) -> None:
        if name not in self.links:
            raise ExportError('%s: no link "%s"' % (self.source, name))
        body = add(parent, "body", {"name": name, **place(joint)})
        if joint is None:
            ET.SubElement(body, "freejoint", name=name + "_free")
        else:
            self.joint(joint, body)
        self.inertial(self.links[name], body)
        self.geoms(self.links[name], body)
        for other in self.joints:
            if other.find("parent").get("link") == name:  # type: ignore[union-attr]
                self.body(other.find("child").get("link", ""), body, other)  # type: ignore[union-attr]

    def convert(self) -> ET.Element:
        children = {j.find("child").get("link") for j in self.joints}  # type: ignore[union-attr]
        first = [name for name in self.links if name not in children]
        if len(first) != 1:
            raise ExportError("%s: exactly one link has no parent, not %d" % (self.source, len(first)))
        self.body(first[0], ET.SubElement(self.root, "worldbody"), None)
        mimics = [(j, m) for j in self.joints if (m := j.find("mimic")) is not None]
        equality = ET.SubElement(self.root, "equality") if mimics else None
        for joint, mimic in mimics:
            line = [*numbers(mimic.get("offset"), 1, "0"), *numbers(mimic.get("multiplier"), 1, "1"), 0, 0, 0]
            ET.SubElement(equality, "joint", joint1=joint.get("name", ""),  # type: ignore[arg-type]
                          joint2=mimic.get("joint", ""), polycoef=said(line))
        return self.root


def write_mjcf(model: str, file: pathlib.Path) -> None:
    """The MJCF of an instrument, with its meshes in the folder NAME_meshes beside it."""
    root = Converter(find_model(model), file.parent / (file.stem + "_meshes")).convert()
    ET.indent(root)
    ET.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)
