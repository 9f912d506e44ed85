# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the mesh files that the project ships (gmsh 2.2 and 4.1, PLY, binary STL) with the standard library only."""
import struct


class MeshError(Exception):
    pass


def _sections(data):
    """The sections of a .msh file: name -> bytes between $Name and $EndName."""
    out, at = {}, 0
    while True:
        start = data.find(b"$", at)
        if start < 0:
            return out
        line_end = data.index(b"\n", start)
        name = data[start + 1 : line_end].strip().decode()
        end = data.find(b"$End" + name.encode(), line_end)
        if end < 0:
            raise MeshError("section $%s has no end" % name)
        out[name] = data[line_end + 1 : end]
        at = end + 4 + len(name)


def read_msh(path):
    """Returns (points, tets); tets hold 0-based indices into points."""
    with open(path, "rb") as stream:
        sections = _sections(stream.read())
    head = sections["MeshFormat"].split(b"\n", 1)[0].split()
    version, binary = head[0].decode(), head[1] == b"1"
    if version == "2.2" and not binary:
        return _read_v2(sections)
    if version == "4.1":
        return _read_v4_binary(sections) if binary else _read_v4_ascii(sections)
    raise MeshError("unsupported .msh version %s" % version)


def _read_v2(sections):
    lines = sections["Nodes"].decode().split("\n")
    number, points = {}, []
    for line in lines[1 : int(lines[0]) + 1]:
        tag, x, y, z = line.split()
        number[int(tag)] = len(points)
        points.append((float(x), float(y), float(z)))
    lines = sections["Elements"].decode().split("\n")
    tets = []
    for line in lines[1 : int(lines[0]) + 1]:
        values = [int(v) for v in line.split()]
        if values[1] == 4:
            tets.append(tuple(number[v] for v in values[3 + values[2] :]))
    return points, tets


def _read_v4_ascii(sections):
    words = iter(sections["Nodes"].split())
    blocks = int(next(words))
    for _ in range(3):
        next(words)
    number, points = {}, []
    for _ in range(blocks):
        next(words), next(words)
        if int(next(words)):
            raise MeshError("parametric nodes are not supported")
        count = int(next(words))
        tags = [int(next(words)) for _ in range(count)]
        for tag in tags:
            number[tag] = len(points)
            points.append((float(next(words)), float(next(words)), float(next(words))))
    lines = iter(sections["Elements"].decode().split("\n"))
    tets = []
    for _ in range(int(next(lines).split()[0])):
        _, _, kind, count = (int(v) for v in next(lines).split())
        for _ in range(count):
            values = [int(v) for v in next(lines).split()]
            if kind == 4:
                tets.append(tuple(number[v] for v in values[1:]))
    return points, tets


def _read_v4_binary(sections):
    if struct.unpack_from("<i", sections["MeshFormat"].split(b"\n", 1)[1])[0] != 1:
        raise MeshError("not little endian")
    data = sections["Nodes"]
    at = 32
    number, points = {}, []
    for _ in range(struct.unpack_from("<Q", data)[0]):
        _, _, _, count = struct.unpack_from("<iiiQ", data, at)
        at += 20
        tags = struct.unpack_from("<%dQ" % count, data, at)
        at += 8 * count
        for i, tag in enumerate(tags):
            number[tag] = len(points)
            points.append(struct.unpack_from("<3d", data, at + 24 * i))
        at += 24 * count
    data = sections["Elements"]
    at = 32
    tets = []
    for _ in range(struct.unpack_from("<Q", data)[0]):
        _, _, kind, count = struct.unpack_from("<iiiQ", data, at)
        at += 20
        if kind != 4:
            raise MeshError("binary elements other than tetrahedra are not supported")
        for i in range(count):
            values = struct.unpack_from("<5Q", data, at + 40 * i)
            tets.append(tuple(number[v] for v in values[1:]))
        at += 40 * count
    return points, tets


def read_ply(path):
    """Returns (points, triangles) of a binary little-endian PLY with float or double properties and triangle faces."""
    with open(path, "rb") as stream:
        data = stream.read()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode().split("\n")
    if header[0] != "ply" or not header[1].startswith("format binary_little_endian"):
        raise MeshError("not a binary little-endian PLY")
    codes = {
        "float": "f",
        "float32": "f",
        "double": "d",
        "uchar": "B",
        "uint8": "B",
        "int": "i",
        "int32": "i",
        "uint": "I",
    }
    element, counts, row, face = None, {}, "<", None
    names = []
    for line in header:
        words = line.split()
        if words[:1] == ["element"]:
            element = words[1]
            counts[element] = int(words[2])
        elif words[:1] == ["property"] and element == "vertex":
            row += codes[words[1]]
            names.append(words[2])
        elif words[:1] == ["property"] and element == "face":
            if words[1] != "list" or face:
                raise MeshError("only one list property on faces is supported")
            face = "<" + codes[words[2]] + "3" + codes[words[3]]
    xyz = [names.index(n) for n in "xyz"]
    size, points = struct.calcsize(row), []
    for i in range(counts["vertex"]):
        values = struct.unpack_from(row, data, end + i * size)
        points.append(tuple(values[k] for k in xyz))
    at, triangles = end + size * counts["vertex"], []
    step = struct.calcsize(face)
    for i in range(counts["face"]):
        values = struct.unpack_from(face, data, at + i * step)
        if values[0] != 3:
            raise MeshError("a face is no triangle")
        triangles.append(values[1:])
    if at + step * counts["face"] != len(data):
        raise MeshError("wrong length")
    return points, triangles
