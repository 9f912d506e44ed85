# SPDX-License-Identifier: GPL-3.0-or-later
"""Vectors as lists of three numbers, and rotations as quaternions w x y z."""
import math


def add(a, b, f=1.0):
    return [x + f * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    n = math.sqrt(dot(a, a))
    return [x / n for x in a]


def across(a, n):
    """The part of a perpendicular to n, unit."""
    return unit(add(a, n, -dot(a, n)))


def turned(v, axis, degrees):
    """v turned about a unit axis."""
    a = math.radians(degrees)
    k = dot(axis, v) * (1 - math.cos(a))
    return add([math.cos(a) * x + k * y for x, y in zip(v, axis)], cross(axis, v), math.sin(a))


def quaternion(x, y, z):
    """w x y z of the rotation whose columns are x, y, z; w >= 0."""
    m = [[x[i], y[i], z[i]] for i in range(3)]
    q = [0.0] * 4
    trace = m[0][0] + m[1][1] + m[2][2]
    if trace > 0:
        s = 2 * math.sqrt(1 + trace)
        q = [s / 4, (m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s]
    else:
        i = max(range(3), key=lambda k: m[k][k])
        j, k = (i + 1) % 3, (i + 2) % 3
        s = 2 * math.sqrt(1 + m[i][i] - m[j][j] - m[k][k])
        q[0] = (m[k][j] - m[j][k]) / s
        q[1 + i] = s / 4
        q[1 + j] = (m[j][i] + m[i][j]) / s
        q[1 + k] = (m[k][i] + m[i][k]) / s
    return q if q[0] >= 0 else [-c for c in q]
