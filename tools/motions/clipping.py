#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the scripted motions of exercises 3 and 4 from the artery's own neck and centrelines.

    python3 tools/motions/clipping.py [OUTPUT_FOLDER]

3_clipping_steady       an angled clip across the neck, released, the field left
3_clipping_careless     a straight clip across the inferior branch: the branch closes
3_clipping_too_high     an angled clip across the middle of the dome: half of the sac remains
3_clipping_too_short    a clip whose tips end within the neck: blood still enters
3_clipping_replaced     the same clip, taken back, opened, moved along the neck and closed again: the neck is shut
3_clipping_second       the same clip, and a curved one beside it on the dome's side: less of the neck is left
3_clipping_branch_in_window  a fenestrated clip from the side: the inferior branch passes through its window
3_clipping_slipping     the applier pulls at the shut clip, which slips off the neck
3_clipping_perforator   blades turned across the superior branch: they close on the perforator behind it too
3_clipping_listening     the probe on parent, branches and dome; the clip of steady; and the probe on each again
4_rupture_steady        the dome ruptures; suction; temporary clip on the parent artery; neck clipped; temporary clip
                        removed
4_rupture_late          the same rupture, but nobody clips
two_clips_steady        the clips of SHARED, in OUTPUT_FOLDER/../cases; two_clips_one_clip: the first one alone
clipping_*_steady       the same as 3_clipping_steady for the other arteries, in OUTPUT_FOLDER/../cases
The same input gives the same bytes.
"""
import json
import math
import pathlib
import sys

import rupture
from clip_hand import OUT_OF_FIELD, ROOT, Clip, Script, close_clip, last_q, open_where_it_lies, place_clip
from clip_hand import steady_outside
from vectors import across, add, cross, dot, quaternion, turned, unit

CASE = "anterior_superior"
# Where the blades of an angled clip lie across the neck of each artery. The wall moves with the blades, so these are
# poses of the hand and not of the closed clip. They lie amid the placements that leave no remnant. The tips point away
# from the floor of the fissure: as the blades close, the tips move inward and would press on it.
#   lift, slide, side: of the blades' middle along the dome's axis, from the surgeon inward, and along the closing, mm
#   turn, pitch, roll: about the dome's axis, of the tips towards it, and about the blades, degrees
#   press, push: how much deeper and farther inward the hand is while the blades close, mm
NECK = {
    "anterior_superior": dict(lift=-0.4, slide=0.3, turn=6, pitch=9, side=0.3, press=0.2, push=0),
    "narrow_neck": dict(lift=-0.6, slide=0, turn=-25, pitch=3, side=0, press=0.2, push=0),
}
# Tips within the neck. When this clip is moved, it goes where a good first one lies.
TOO_SHORT = dict(lift=0, slide=-2.2, turn=6, pitch=6, side=0.3)
# A curved clip beside the short one. Lower its blades press the wall against the first one with more than 0.3 N;
# farther in its tips press on the floor; farther aside one blade meets the dome before the other.
SECOND = dict(lift=1.6, slide=0.3, turn=-6, pitch=5, side=0.1, press=0, push=0)
# Two clips that share a neck: the first one lies as low as a good one and nearer to the surgeon, and the tips of the
# second one, which lies above it, come down to the neck where the first one ends.
SHARED = [
    ("angled", dict(lift=-0.4, slide=-1.2, turn=6, pitch=8, side=0.3, press=0.2, push=0)),
    ("curved", dict(lift=1.7, slide=0, turn=-6, pitch=1, side=0.1, press=0, push=0)),
]
# A fenestrated clip from the side of the inferior branch. Its stem stands along the dome's axis. Its window takes the
# branch, so that the blades' root reaches the edge of the flattened neck. Rolled less, its shaft meets the bone and a
# blade the floor. Rolled more, or farther aside, a blade meets the bleb.
FENESTRATED_CLIP = "fenestrated_3_5_stem_90"  # what the tray calls fenestrated
FENESTRATED = dict(lift=-0.2, slide=-0.6, turn=-91, side=0.3, roll=-12, press=0.3, push=0)
# The torn dome of exercise 4 is slack, and the temporary clip lies beside it: the tips point farther from the floor.
# This place is amid those that leave no remnant. A hand that is off by half a millimetre in any direction leaves 4 % at
# most.
TORN = dict(NECK[CASE], lift=-0.8, slide=0.1, side=0.17, pitch=12)
# A temporary clip across the parent artery. The flattened wall is half as wide again as the artery, and the blades must
# reach beyond it on both sides. A curved clip does so as square as this without its tips on the floor; a straight one
# meets the bone. Nearer to the neck the coil of the neck's clip is in the way.
PROXIMAL = dict(name="parent", share=0.45, past=-2.4, square=0.5)
# Where its grip lies when the applier has left: the temporal lobe comes back and turns the clip. The hand that takes it
# must be nearer to this grip than to that of the clip on the neck.
PROXIMAL_GRIP = (53.7, 21.4, -14.0)
# Where the Doppler probe listens: share of a centreline, and how far from its axis the tip is held, mm. It comes along
# the view, since retractors and bone are in other ways.
LISTENED = {"parent": (0.8, 3.4), "superior": (0.5, 2.4), "inferior": (0.62, 2.6), "sac": (0.65, 4.4)}
VIEW = (0.93, 0.25, 0.27)  # towards the surgeon


class Field:
    """An artery, and the direction to the surgeon. `vessel`: its vessel.json, if it is not a shipped one."""

    def __init__(self, case, vessel=None, view=VIEW):
        self.case = case
        path = vessel or ROOT / "meshes/arteries" / case / "vessel.json"
        self.vessel = json.loads(path.read_text())
        self.view = unit(view)

    def line(self, name):
        return next(c for c in self.vessel["centrelines"] if c["name"] == name)["points"]

    def on_line(self, name, share):
        """Point and direction of a centreline at a share of its length."""
        points = self.line(name)
        k = min(len(points) - 2, max(1, int(share * (len(points) - 1))))
        return points[k], unit(add(points[k + 1], points[k - 1], -1))

    def neck(self, clip, lift, slide, turn=0.0, pitch=0.0, side=0.0, roll=0.0):
        """Blades across the neck: they come from the surgeon's side. NECK says what the arguments mean."""
        up = unit(self.vessel["neck"]["normal"])
        outward = turned(across(self.view, up), up, turn)
        closing = cross(up, outward)
        middle = add(add(add(self.vessel["neck"]["centre"], up, lift), outward, -slide), closing, side)
        closing = turned(closing, outward, roll)
        return clip.applier_pose(middle, turned([-v for v in outward], closing, pitch), closing)

    def placement(self, place, clip="angled"):
        """Pose of the applier with the clip across the neck, and the hand's motion while the blades close."""
        place = dict(place)
        depth, push = place.pop("press"), place.pop("push")
        up = unit(self.vessel["neck"]["normal"])
        outward = turned(across(self.view, up), up, place["turn"])
        motion = add([-depth * v for v in up], outward, -push)
        return self.neck(Clip(clip), **place), motion

    def clip_neck(self, hand, place=None):
        """The angled clip of the tray across the neck, well placed."""
        place_clip(hand, *self.placement(place or NECK[self.case]))

    def move_along_neck(self, hand):
        """The angled clip with its tips within the neck; then taken back, moved inward and closed again."""
        short = self.neck(Clip("angled"), **TOO_SHORT)
        place_clip(hand, short)
        open_where_it_lies(hand, short)
        close_clip(hand, *self.placement(NECK[self.case]))

    def pull_shut_clip(self, hand):
        """The angled clip well placed, and pulled away before the applier lets it go or opens it."""
        place = {k: v for k, v in NECK[self.case].items() if k not in ("press", "push")}
        position, q, shaft = self.neck(Clip("angled"), **place)
        outside = add(position, shaft, OUT_OF_FIELD)
        hand.key(0.3, outside, q)
        hand.key(0.05, outside, q, 1)
        hand.key(0.5, outside, q, 1)
        hand.key(2.5, add(position, shaft, 3), q, 1)
        hand.key(0.8, position, q, 1)
        hand.key(0.3, position, q, 1)
        hand.key(0.02, position, q)
        hand.key(1.6, position, q)
        hand.key(1.5, add(position, shaft, 8), q)
        hand.key(1.0, outside, q)

    def branch(self, clip, name, share, past, square=1.0, grip=None):
        """Blades across a branch, tips `past` beyond its axis; square 1: at right angles, 0: along the view. `grip`: a
        point in whose direction the clip's grip has turned about the blades' middle."""
        point, along = self.on_line(name, share)
        outward = unit(add([square * v for v in across(self.view, along)], self.view, 1 - square))
        middle, inward, closing = add(point, outward, -past), [-v for v in outward], unit(cross(along, outward))
        pose = clip.applier_pose(middle, inward, closing)
        if grip is None:
            return pose
        a, b = unit(add(pose[0], middle, -1)), unit(add(grip, middle, -1))
        axis, angle = unit(cross(a, b)), math.degrees(math.acos(dot(a, b)))
        return clip.applier_pose(middle, turned(inward, axis, angle), turned(closing, axis, angle))


def listen(script, field):
    """Takes the Doppler probe and holds it for two heartbeats on each vessel in turn."""
    shaft = field.view
    x = across((-0.34, 0.93, 0.12), shaft)
    q = quaternion(x, cross(shaft, x), shaft)
    hand = script.right
    script.command(round(hand.t + 0.2, 3), "exchange", "right doppler")
    for name, (share, away) in LISTENED.items():
        tip = add(field.on_line(name, share)[0], shaft, away)
        outside = add(tip, shaft, OUT_OF_FIELD)
        hand.key(0.6, outside, q)
        hand.key(1.0, add(tip, shaft, 3), q)
        hand.key(0.6, tip, q)
        hand.key(1.9, tip, q)
        hand.key(0.8, outside, q)


def clips(path, placed, wait):
    """A script of one clip after the other: each is loaded and placed, then `wait` seconds outside the field.

    placed: pairs of a clip's name and what moves the hand to place it."""
    script = Script()
    for name, place in placed:
        script.command(round(script.right.t + 0.1, 3), "ask", "applier load " + name)
        if script.right.rows:
            script.right.key(0.3, steady_outside(script), last_q(script))
        place(script.right)
    script.right.key(wait, steady_outside(script), last_q(script))
    script.write(path)


def listened(path, field):
    """The probe before the clip and after it."""
    script = Script()
    listen(script, field)
    script.command(round(script.right.t + 0.2, 3), "exchange", "right applier")
    script.command(round(script.right.t + 0.4, 3), "ask", "applier load angled")
    script.right.key(0.8, steady_outside(script), last_q(script))
    field.clip_neck(script.right)
    script.right.key(1, steady_outside(script), last_q(script))
    listen(script, field)
    script.right.key(1, steady_outside(script), last_q(script))
    script.write(path)


def one_clip(path, clip, place, wait=8):
    clips(path, [(clip, place)], wait)


def exercise_3(folder):
    field = Field(CASE)
    one_clip(folder / "3_clipping_steady.csv", "angled", field.clip_neck)

    def at(pose):
        return lambda hand: place_clip(hand, pose)

    short = field.neck(Clip("angled"), **TOO_SHORT)
    across_branch = field.branch(Clip("straight"), "inferior", 0.45, 1.8)
    one_clip(folder / "3_clipping_careless.csv", "straight", at(across_branch), 12)
    one_clip(folder / "3_clipping_too_high.csv", "angled", at(field.neck(Clip("angled"), 1.6, 1.8, 6)), 4)
    one_clip(folder / "3_clipping_too_short.csv", "angled", at(short), 4)
    one_clip(folder / "3_clipping_replaced.csv", "angled", field.move_along_neck, 4)
    second = field.placement(SECOND, "curved")
    both = [("angled", at(short)), ("curved", lambda hand: place_clip(hand, *second))]
    clips(folder / "3_clipping_second.csv", both, 4)
    fenestrated = field.placement(FENESTRATED, FENESTRATED_CLIP)
    one_clip(folder / "3_clipping_branch_in_window.csv", "fenestrated", lambda hand: place_clip(hand, *fenestrated), 4)
    one_clip(folder / "3_clipping_slipping.csv", "angled", field.pull_shut_clip, 2)
    beside = field.neck(Clip("angled"), -0.9, 2.2, -45, 2, 1.5)
    one_clip(folder / "3_clipping_perforator.csv", "angled", at(beside), 4)
    listened(folder / "3_clipping_listening.csv", field)
    shared = [(clip, lambda hand, at=field.placement(place, clip): place_clip(hand, *at)) for clip, place in SHARED]
    cases = folder.parent / "cases"
    if cases.is_dir():
        clips(cases / "two_clips_steady.csv", shared, 4)
        clips(cases / "two_clips_one_clip.csv", shared[:1], 4)
    for case in NECK:
        if case != CASE and cases.is_dir():
            one_clip(cases / f"clipping_{case}_steady.csv", "angled", Field(case).clip_neck)


def exercise_4(folder):
    field = Field(CASE)
    bottom, _ = field.on_line("inferior", 0.25)
    tube = rupture.tube_over(bottom, [0.85, -0.35, 0.39], [0, -0.5, 0.87], 5, 28)
    put, taken = (field.branch(Clip("temporary_curved"), **PROXIMAL, grip=g) for g in (None, PROXIMAL_GRIP))
    temporary = rupture.Temporary("temporary_curved", put, taken)
    neck = field.placement(TORN)
    steady = rupture.steady(temporary, "angled", lambda hand: place_clip(hand, *neck), field.view, tube)
    steady.write(folder / "4_rupture_steady.csv")
    late = rupture.late(field.neck(Clip("angled"), -0.9, 1.5), tube)
    late.write(folder / "4_rupture_late.csv")


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "scenes" / "training"
    folder.mkdir(parents=True, exist_ok=True)
    exercise_3(folder)
    exercise_4(folder)


if __name__ == "__main__":
    main()
