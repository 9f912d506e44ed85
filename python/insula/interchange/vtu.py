# SPDX-License-Identifier: GPL-3.0-or-later
"""A series for ParaView: a .vtu of each body at each time, and a .pvd that lists them with their times.

Points carry displacement (m) and velocity (m/s), cells Cauchy stress (Pa). Arrays are raw and appended, as VTK's XML
format 1.0 has them.
"""

from __future__ import annotations

import pathlib
from xml.sax.saxutils import quoteattr

import numpy as np
from insula.interchange.frames import ExportError, Frames

TYPES = {np.dtype(np.float64): "Float64", np.dtype(np.int64): "Int64", np.dtype(np.uint8): "UInt8"}
CELL = {3: 5, 4: 10}  # corners: VTK's type of a triangle, of a tetrahedron


class _Appended:
    """The data section of a file."""

    def __init__(self) -> None:
        self.data = bytearray()

    def element(self, name: str, values: np.ndarray, components: int = 1) -> str:
        data = np.ascontiguousarray(values)
        offset = len(self.data)
        self.data += len(data.tobytes()).to_bytes(8, "little") + data.tobytes()
        return '<DataArray type="%s" Name=%s NumberOfComponents="%d" format="appended" offset="%d"/>' % (
            TYPES[data.dtype], quoteattr(name), components, offset)


def vtu(points: np.ndarray, cells: np.ndarray, point_data: dict[str, np.ndarray],
        cell_data: dict[str, np.ndarray]) -> bytes:
    """A mesh of triangles or tetrahedra as the bytes of a .vtu."""
    for name, values in {"points": points, **point_data, **cell_data}.items():
        if not np.isfinite(values).all():
            raise ExportError("%s: the state holds what is no number: nothing is written" % name)
    if len(points) == 0 or len(cells) == 0:
        raise ExportError("a body without nodes or elements has no VTU")
    out, corners = _Appended(), cells.shape[1]

    def arrays(kind: str, data: dict[str, np.ndarray]) -> list[str]:
        items = [out.element(k, np.asarray(v, float), int(np.prod(v.shape[1:]))) for k, v in data.items()]
        return ["<%s>" % kind, *items, "</%s>" % kind]

    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        "<UnstructuredGrid>",
        '<Piece NumberOfPoints="%d" NumberOfCells="%d">' % (len(points), len(cells)),
        "<Points>", out.element("Points", np.asarray(points, float), 3), "</Points>",
        "<Cells>", out.element("connectivity", np.asarray(cells, np.int64)),
        out.element("offsets", corners * np.arange(1, len(cells) + 1, dtype=np.int64)),
        out.element("types", np.full(len(cells), CELL[corners], np.uint8)), "</Cells>",
        *arrays("PointData", point_data), *arrays("CellData", cell_data),
        "</Piece>", "</UnstructuredGrid>", '<AppendedData encoding="raw">',
    ]
    return "\n".join(lines).encode() + b"\n_" + bytes(out.data) + b"\n</AppendedData>\n</VTKFile>\n"


def write_series(frames: Frames, file: pathlib.Path) -> list[pathlib.Path]:
    """Writes NAME.pvd and the files NAME_BODY_0000.vtu beside it. Returns these."""
    if not frames.bodies:
        raise ExportError("the scene has no deformable body, so there is nothing for a VTU series")
    made, lines = [], ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="1.0">', "<Collection>"]
    for k, time in enumerate(frames.times):
        for part, body in enumerate(frames.bodies):
            x = body.positions[k]
            data = vtu(x, body.elements, {"displacement": x - body.rest, "velocity": body.velocities[k]},
                       {"stress": body.stress[k]})
            path = file.with_name("%s_%s_%04d.vtu" % (file.stem, body.name, k))
            path.write_bytes(data)
            made.append(path)
            lines.append('<DataSet timestep="%.9g" part="%d" name=%s file=%s/>' % (
                time, part, quoteattr(body.name), quoteattr(path.name)))
    file.write_text("\n".join([*lines, "</Collection>", "</VTKFile>", ""]), encoding="utf-8")
    return made
