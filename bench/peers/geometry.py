# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of tetrahedra, and distances to them."""

from __future__ import annotations

import numpy as np


def outer_triangles(elements: np.ndarray) -> np.ndarray:
    """Faces that belong to one tetrahedron alone, counter-clockwise from outside."""
    faces = elements[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[np.sort(first[count == 1])]


def distance_to_triangles(p: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> float:
    """The least distance of a point to triangles, m. Each edge and each face is tried."""
    best = np.full(len(a), np.inf)
    for s, t in ((a, b), (b, c), (c, a)):
        along = t - s
        share = np.clip(((p - s) * along).sum(axis=1) / (along * along).sum(axis=1), 0, 1)
        best = np.minimum(best, np.linalg.norm(s + share[:, None] * along - p, axis=1))
    normal = np.cross(b - a, c - a)
    height = ((p - a) * normal).sum(axis=1) / np.linalg.norm(normal, axis=1)
    over = np.ones(len(a), bool)
    for s, t in ((a, b), (b, c), (c, a)):
        over &= (np.cross(t - s, p - s) * normal).sum(axis=1) >= 0
    return float(np.minimum(best, np.where(over, np.abs(height), np.inf)).min())
