# SPDX-License-Identifier: GPL-3.0-or-later
"""A motion of both hands in which an applier brings clips to their places, lets them go and takes them back.

A clip's place is given by where its blades' middle is, where they point to and in which direction they close; the
applier's pose follows from the clip's own grip.
"""
import json
import pathlib

from vectors import across, add, cross, quaternion, unit

ROOT = pathlib.Path(__file__).resolve().parents[2]
OUT_OF_FIELD = 32.0  # mm along the applier's shaft


class Clip:
    """A clip of the library: its grip, the middle of its blades and the blades' direction, in its own frame (mm)."""

    def __init__(self, name):
        data = json.loads((ROOT / "meshes/clips" / name / "tool.json").read_text())["clip"]
        self.name = name
        self.grip = data["grip"]["position"]
        line = data["blade_line"]
        self.middle = [0.5 * (a + b) for a, b in zip(line[0], line[-1])]
        self.inward = unit(add(line[-1], line[0], -1))  # from the root to the tip

    def applier_pose(self, middle, inward, closing):
        """Pose of the applier (mm, quaternion, shaft direction) that brings the blades' middle there."""
        inward = across(inward, closing)
        # The clip's frame: x closes, the blades' direction is `self.inward` in its y-z plane.
        side = cross(closing, inward)
        c, s = -self.inward[2], self.inward[1]  # inward = (0, s, -c)
        y = add([s * v for v in inward], side, c)
        z = add([-c * v for v in inward], side, s)
        rotate = lambda v: add(add([v[0] * k for k in closing], y, v[1]), z, v[2])
        tip = add(middle, rotate(self.middle), -1)
        return add(tip, rotate(self.grip)), quaternion(closing, y, z), z


class Hand:
    def __init__(self, side):
        self.side, self.rows, self.t = side, [], 0.0

    def key(self, seconds, position, q, button1=0, button2=0):
        self.t = round(self.t + seconds, 4)
        self.rows.append(
            (
                self.t,
                f"{self.t:g},{self.side},"
                + ",".join(f"{v / 1000:.6f}" for v in position)
                + ","
                + ",".join(f"{v:.6f}" for v in q)
                + f",{button1},{button2}",
            )
        )


class Script:
    def __init__(self):
        self.left, self.right, self.commands = Hand("left"), Hand("right"), []

    def command(self, time, verb, argument):
        self.commands.append((time, f"{time:g},command,{verb},{argument}"))

    def text(self):
        rows = sorted(self.left.rows + self.right.rows + self.commands, key=lambda r: r[0])
        return "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n" + "\n".join(r[1] for r in rows) + "\n"

    def write(self, path):
        path.write_text(self.text())


def place_clip(hand, pose, press=(0, 0, 0), approach=2.5, close=1.6, wait=0.6, open_at=OUT_OF_FIELD, last=0.8):
    """From outside the field: go in, open the blades `open_at` mm before the place, take `last` seconds for the last
    3 mm, let the spring close while the hand moves by `press`, move back, let go, leave."""
    position, q, shaft = pose
    outside = add(position, shaft, OUT_OF_FIELD)
    opened = add(position, shaft, open_at)
    near = add(position, shaft, 3)
    hand.key(0.3, outside, q)
    if open_at < OUT_OF_FIELD:
        hand.key(approach, opened, q)
    hand.key(0.05, opened, q, 1)
    hand.key(0.5, opened, q, 1)
    hand.key(approach if open_at == OUT_OF_FIELD else 0.6, near, q, 1)
    close_clip(hand, pose, press, close, wait, last)


def close_clip(hand, pose, press=(0, 0, 0), close=1.6, wait=0.6, last=0.8):
    """With an open clip near its place: go there, let the spring close while the hand moves by `press`, move back, let
    go, leave."""
    position, q, shaft = pose
    pressed = add(position, press)
    hand.key(last, position, q, 1)
    hand.key(0.3, position, q, 1)
    hand.key(0.02, position, q)
    hand.key(0.25, pressed, q)
    hand.key(0.75, pressed, q)
    hand.key(0.3, position, q)
    hand.key(close - 1.3, position, q)
    hand.key(0.02, position, q, 0, 1)
    hand.key(0.2, position, q, 0, 1)
    hand.key(0.02, position, q)
    hand.key(wait, position, q)
    hand.key(0.8, add(position, shaft, 4), q)
    hand.key(1.5, add(position, shaft, OUT_OF_FIELD), q)


def open_where_it_lies(hand, pose, approach=2.5):
    """Back onto a clip in the field: grip it and open it."""
    position, q, shaft = pose
    hand.key(0.3, add(position, shaft, OUT_OF_FIELD), q)
    hand.key(approach, add(position, shaft, 2), q)
    hand.key(0.6, position, q)
    hand.key(0.3, position, q)
    hand.key(0.02, position, q, 0, 1)
    hand.key(0.2, position, q, 0, 1)
    hand.key(0.02, position, q)
    hand.key(0.4, position, q)
    hand.key(0.02, position, q, 1)
    hand.key(0.5, position, q, 1)


def take_clip(hand, pose):
    """Back onto a clip in the field: grip it, open, draw out."""
    position, q, shaft = pose
    outside = add(position, shaft, OUT_OF_FIELD)
    open_where_it_lies(hand, pose)
    hand.key(0.8, add(position, shaft, 6), q, 1)
    hand.key(1.2, outside, q, 1)
    hand.key(0.02, outside, q)


def steady_outside(script):
    return [1000 * float(v) for v in script.right.rows[-1][1].split(",")[2:5]]


def last_q(script):
    return [float(v) for v in script.right.rows[-1][1].split(",")[5:9]]
