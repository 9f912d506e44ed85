# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the forces on the hands from a report (report.json) or from an exported session (servo.csv)."""
import csv
import json
import math
import os
import xml.etree.ElementTree as ElementTree

HANDS = ("left", "right")
TOUCH_N = 0.005  # as PerceptibleForces::touch_N of engine/reports
STIFFEST_COUPLING_N_M = 500.0  # that an exercise may have, see docs/feel-and-stability.md


class Recording:
    """Rendered forces in contact, N, sorted, of each hand."""

    def __init__(self, title, forces, coupling_N_m=STIFFEST_COUPLING_N_M):
        self.title = " ".join(title.split())
        self.coupling_N_m = coupling_N_m
        self.contact = {hand: sorted(f for f in forces[hand] if f > TOUCH_N) for hand in HANDS}


def stiffest_coupling(scene):
    """Largest coupling of the tools that hands hold in a scene and in what it includes, in N/m; 0: none is stated as a
    number. A file whose name is a variable is left out."""
    largest = 0.0
    for element in ElementTree.parse(scene).iter():
        words = element.get("coupling", "").split()
        if element.get("hand") != "none" and len(words) == 2 and words[1] == "N/m" and words[0][0] != "$":
            largest = max(largest, float(words[0]))
        if element.tag == "include":
            included = os.path.join(os.path.dirname(scene), element.get("file", ""))
            if os.path.isfile(included):
                largest = max(largest, stiffest_coupling(included))
    return largest


def read_report(path):
    """Forces of `insula run --report`. Each value is the largest of the steps between two moments of the report."""
    with open(path, encoding="utf-8") as f:
        report = json.load(f)
    scene = report.get("scene", "")
    coupling = stiffest_coupling(scene) if os.path.exists(scene) else 0
    return Recording(report["title"], report["series"]["hand_force_N"], coupling or STIFFEST_COUPLING_N_M)


def read_servo(path, recorded_scale):
    """Forces of each tick, from `insula session export`. They were sent to a device, so the scale is divided out."""
    forces = {hand: [] for hand in HANDS}
    with open(path, encoding="utf-8", newline="") as f:
        for row in csv.DictReader(f):
            for hand in HANDS:
                parts = [row[f"{hand}_f{axis}_N"] for axis in "xyz"]
                if all(parts):
                    forces[hand].append(math.sqrt(sum(float(p) ** 2 for p in parts)) / recorded_scale)
    return Recording(os.path.basename(os.path.dirname(os.path.abspath(path))), forces)


def read(path, recorded_scale=1.0):
    return read_servo(path, recorded_scale) if path.endswith(".csv") else read_report(path)


def percentile(ordered, share):
    """Linear between the neighbours; `ordered` is not empty."""
    at = share * (len(ordered) - 1)
    low = int(at)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (at - low) * (ordered[high] - ordered[low])


def share_above(ordered, threshold_N):
    """Share of the time in contact with more force than a threshold."""
    return sum(1 for f in ordered if f > threshold_N) / len(ordered)


def range_above(ordered, threshold_N):
    """Share of the range from 0 to the largest force that lies above a threshold."""
    return max(0.0, 1.0 - threshold_N / ordered[-1])
