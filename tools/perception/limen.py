# SPDX-License-Identifier: GPL-3.0-or-later
"""Difference limen of a force, and errors of a displayed force in just-noticeable differences (JND).

    DL(F) = sqrt((k F)^2 + F0^2)        N

k is the Weber fraction. F0 is the smallest noticeable change of a very small force. Its parts are the absolute
threshold of the person and the friction of the device that is not compensated. They are independent, so their squares
add. DL is F0 for small forces and k F for large ones. It exceeds max(k F, F0) by at most a factor of sqrt(2), where
both are equal.
"""
import math


def smallest_change(*parts_N):
    """F0 of independent parts."""
    return math.sqrt(sum(p * p for p in parts_N))


def difference_limen(force_N, weber_fraction, smallest_N):
    return math.hypot(weber_fraction * force_N, smallest_N)


def touch_error_jnd(peak_N, error, weber_fraction, smallest_N, level=0.5):
    """Error of a touch in JND. `error` is a share of the displayed peak `peak_N`, and `level` the share of the peak at
    which the person compares. A touch that rises and falls evenly is at half of its peak on average."""
    if peak_N <= 0:
        return 0.0
    return error * peak_N / difference_limen(level * peak_N, weber_fraction, smallest_N)


def allowed_error(peak_N, weber_fraction, smallest_N, level=0.5):
    """The error of a touch, as a share of its displayed peak, that is one JND."""
    return difference_limen(level * peak_N, weber_fraction, smallest_N) / peak_N


def largest_peak_below_one_jnd(error, weber_fraction, smallest_N, level=0.5):
    """Displayed peak up to which an error stays below one JND; infinity where it does at any force."""
    rest = error * error - (level * weber_fraction) ** 2
    return smallest_N / math.sqrt(rest) if rest > 0 else math.inf
