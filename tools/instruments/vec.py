# SPDX-License-Identifier: GPL-3.0-or-later
"""Small 3-vector arithmetic on tuples; no third-party packages, so a rebuild needs only Python."""
import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, k):
    return (a[0] * k, a[1] * k, a[2] * k)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a):
    return math.sqrt(dot(a, a))


def unit(a):
    length = norm(a)
    if length == 0.0:
        raise ValueError("a zero vector has no direction")
    return mul(a, 1.0 / length)


def lerp(a, b, k):
    return add(a, mul(sub(b, a), k))


def combine(origin, *terms):
    """origin + sum of coefficient * vector over the (coefficient, vector) pairs."""
    p = origin
    for k, v in terms:
        p = add(p, mul(v, k))
    return p
