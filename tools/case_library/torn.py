# SPDX-License-Identifier: GPL-3.0-or-later
"""Exercises of a case in which the dome tears: their motions from where the case's own clip lies."""
import re

import placed
import rupture
from clip_hand import Clip, place_clip
from vectors import add, across, turned, unit

ABOVE, BACK = 6, 26  # mm: the tip of the tube over its point, and its way out
CHANCE = "../../parts/rupture_by_chance.xml"
RULES = {"rupture": "../../parts/rupture_rules.xml", "pause": "../../parts/pause_rules.xml"}  # by the exercise's id


def neck_clip(folder):
    """Name of the clip of case_steady.csv, and the pose of the applier where it lets it go."""
    rows = [row.split(",") for row in (folder / "case_steady.csv").read_text(encoding="utf-8").splitlines()]
    name = next(row[3].split()[-1] for row in rows if row[1] == "command")
    row = next(row for row in rows if row[1] == "right" and row[10] == "1")
    (w, i, j, k), position = map(float, row[5:9]), [1000 * float(v) for v in row[2:5]]
    shaft = [2 * (i * k + w * j), 2 * (j * k - w * i), 1 - 2 * (i * i + j * j)]
    return name, (position, [w, i, j, k], shaft)


def moved(pose, by, field):
    """A pose that is moved: raise_mm along the dome's axis, back_mm to the surgeon in the neck's plane."""
    up = unit(field.vessel["neck"]["normal"])
    shift = add([by.get("raise_mm", 0) * v for v in up], across(field.view, up), by.get("back_mm", 0))
    return add(pose[0], shift), pose[1], pose[2]


def temporary_of(spec, field):
    """The temporary clip across the parent. `grip`: where its grip lies when it is taken, if turned."""
    at = {key: spec[key] for key in ("share", "past", "square")}
    clip = Clip(spec["clip"])
    put = field.branch(clip, "parent", **at)
    return rupture.Temporary(spec["clip"], put, field.branch(clip, "parent", **at, grip=spec.get("grip")))


def tube_of(exercise, field, suction, folder):
    """The suction tube beside the neck, where the approach or the exercise has it. It comes straight from its home."""
    scene = (folder / "field.xml").read_text(encoding="utf-8")
    home = [float(v) for v in re.search(r'<suction [^>]*home="([^"]*) mm"', scene)[1].split()]
    beside = exercise.get("tube", suction)["beside_neck_mm"]
    point = add(field.vessel["neck"]["centre"], beside)
    return rupture.tube_over(point, suction["shaft"], suction["flat"], ABOVE, BACK, home)


def text(motion, exercise, folder, approach):
    """The text of a motion: `steady`, or another of tools/motions/rupture.py."""
    field = placed.field_of(folder, approach["to_surgeon"])
    clip, pose = neck_clip(folder)
    pose = moved(pose, exercise.get("neck", {}), field)
    tube = tube_of(exercise, field, approach["suction"], folder)
    if motion == "late":
        return rupture.late(pose, tube).text()
    place = lambda hand: place_clip(hand, pose)
    if exercise["id"] == "pause":
        play = {"steady": rupture.in_a_pause, "too_soon": rupture.before_the_pause}[motion]
        return play(exercise["dose_mg"], clip, pose, place, tube).text()
    play = {"steady": rupture.steady, "left_on": rupture.left_on}[motion]
    return play(temporary_of(exercise["temporary"], field), clip, place, field.view, tube).text()
