# SPDX-License-Identifier: GPL-3.0-or-later
"""Quaternions w x y z."""

from __future__ import annotations

import numpy as np


def multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The product of two quaternions."""
    w, v, u, s = a[0], a[1:], b[1:], b[0]
    return np.concatenate(([w * s - v @ u], w * u + s * v + np.cross(v, u)))


def rotation(turn: np.ndarray) -> np.ndarray:
    """The quaternion of a rotation vector, rad."""
    angle = float(np.linalg.norm(turn))
    if angle < 1e-12:
        return np.array([1.0, 0, 0, 0])
    return np.concatenate(([np.cos(angle / 2)], np.sin(angle / 2) / angle * turn))


def rotation_vector(q: np.ndarray) -> np.ndarray:
    """The shortest rotation vector of a unit quaternion, rad."""
    q = q if q[0] >= 0 else -q
    size = float(np.linalg.norm(q[1:]))
    if size < 1e-12:
        return np.zeros(3)
    return 2 * np.arctan2(size, q[0]) / size * q[1:]


def conjugate(q: np.ndarray) -> np.ndarray:
    return np.concatenate((q[:1], -q[1:]))


def axes(orientation: np.ndarray) -> np.ndarray:
    """The three columns of a quaternion's rotation matrix, as rows."""
    w, x, y, z = orientation
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
            [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
