# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals of vertices."""

from __future__ import annotations

import numpy as np


def vertex_normals(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Of unit length, weighted by areas; along z where a vertex has no triangle."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    out = np.zeros_like(vertices, dtype=float)
    np.add.at(out, triangles, np.cross(b - a, c - a)[:, None])
    size = np.linalg.norm(out, axis=1)
    out[size == 0] = (0, 0, 1)
    return out / np.where(size == 0, 1, size)[:, None]
