#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the two scripted motions of each skill task from the places in tools/practice/layout.py.

    python3 tools/motions/skills.py [OUTPUT_FOLDER]

steady completes the task without a fault; rough makes the faults that beginners make. The same input gives the same
bytes.
"""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools" / "practice"))
from hand_script import Hand, write  # noqa: E402
from layout import (  # noqa: E402
    BOWL_BOTTOM,
    FLAP_GRIPS,
    FLAP_HIGH,
    MARKED,
    PAD_HIGH,
    POSTS,
    PRESSES,
    RAIL_HIGH,
    TARGET_OVER_POST,
    THREAD_Y,
    THREAD_Z,
    TUBE_AXIS,
    TUBE_MARK,
    TUBE_MIDDLE,
    UNDER_FLAP,
)
from vectors import add, unit  # noqa: E402

OUTPUT = ROOT / "scenes" / "skills"
# Shafts and homes of the hands, as in the scenes.
LEFT = dict(home=(-26, -12, 32), shaft=(-0.50, -0.38, 0.78), flat=(0.30, 0.75, 0.56))
RIGHT = dict(home=(26, -12, 32), shaft=(0.50, -0.38, 0.78), flat=(-0.30, 0.75, 0.56))

PRESS_DEPTH = 2.7  # mm of the hand below the pad's surface: a force in the middle of the band


def hands():
    return Hand("left", **LEFT), Hand("right", **RIGHT)


def targets():
    """Hand and place of each target, in turn."""
    for k, (x, y, height) in enumerate(POSTS):
        yield k % 2, (x, y, height + TARGET_OVER_POST)


def touch_targets(folder, name):
    both = hands()
    for side, place in targets():
        hand = both[side]
        hand.until(both[1 - side])
        outward = unit((LEFT, RIGHT)[side]["shaft"])
        hand.go(1.1, add(place, outward, 9))
        hand.go(0.8, place)
        hand.stay(0.5)
        hand.go(0.7, add(place, outward, 14))
    for hand in both:
        hand.go(1.0, hand.home)
    write(folder / f"{name}_steady.csv", both)

    # Straight down onto the balls and through them, one post after the other.
    both = hands()
    for side, place in targets():
        hand = both[side]
        hand.until(both[1 - side])
        hand.go(0.6, add(place, (0, 0, 1), 6))
        hand.go(0.4, add(place, (0, 0, -1), 3.6))
        hand.stay(0.2)
        hand.go(0.5, place)
        hand.stay(0.4)
        hand.go(0.5, add(place, (0, 0, 1), 14))
    for hand in both:
        hand.go(1.0, hand.home)
    write(folder / f"{name}_rough.csv", both)


def hold_a_force(folder, name):
    both = hands()
    for k, place in enumerate(PRESSES):
        hand = both[k % 2]
        hand.until(both[1 - k % 2])
        top = (*place, PAD_HIGH[2])
        hand.go(1.2, add(top, (0, 0, 1), 5))
        hand.go(1.2, add(top, (0, 0, 1), -PRESS_DEPTH))
        hand.stay(3.3)
        hand.go(0.8, add(top, (0, 0, 1), 8))
    for hand in both:
        hand.go(1.0, hand.home)
    write(folder / f"{name}_steady.csv", both)

    # Pushed in far too deep, then drawn back into the band, which is left again before the time is over.
    both = hands()
    for k, place in enumerate(PRESSES):
        hand = both[k % 2]
        hand.until(both[1 - k % 2])
        top = (*place, PAD_HIGH[2])
        hand.go(0.6, add(top, (0, 0, 1), 5))
        hand.go(0.4, add(top, (0, 0, 1), -2.6 * PRESS_DEPTH))
        hand.stay(0.3)
        hand.go(0.4, add(top, (0, 0, 1), -PRESS_DEPTH))
        hand.stay(1.5)
        hand.go(0.5, add(top, (0, 0, 1), 8))
    for hand in both:
        hand.go(1.0, hand.home)
    write(folder / f"{name}_rough.csv", both)


LIFT = (0, 1.8, 8)  # mm of a grip on the flap, from where it lies


def lift_flap(hand, grip, seconds=1.2, lift=LIFT):
    """Sets the tube on the flap, takes hold of it and lifts it."""
    on = (*grip, FLAP_HIGH[2] + 0.3)
    hand.go(1.4, add(on, (0, 0, 1), 6))
    hand.go(0.8, on)
    hand.stay(0.3, 1)
    hand.go(seconds, add(on, lift), 1)


def lay_down_flap(hand, grip):
    hand.go(1.0, (*grip, FLAP_HIGH[2] + 0.6), 1)
    hand.stay(0.2, 0)
    hand.go(1.0, hand.home)


def touch_below(hand, places):
    """In front of the flap, then in below it along the shaft."""
    for place in places:
        hand.go(1.0, add(place, (0, -5, 10)))
        hand.go(0.8, place)
        hand.stay(0.5)
        hand.go(0.6, add(place, (0, -5, 10)))


def exchange(folder, name):
    both = hands()
    commands = []
    for holds, balls in ((0, UNDER_FLAP[:2]), (1, UNDER_FLAP[2:])):
        holder, worker = both[holds], both[1 - holds]
        if holds == 1:
            t = max(holder.t, worker.t) + 0.5
            commands = [(t, "exchange,left left_pointer"), (t + 0.2, "exchange,right right_suction")]
            for hand in both:
                hand.until(t + 1)
        lift_flap(holder, FLAP_GRIPS[holds])
        worker.until(holder)
        touch_below(worker, balls)
        worker.go(1.0, worker.home)
        holder.until(worker, 1)
        lay_down_flap(holder, FLAP_GRIPS[holds])
    write(folder / f"{name}_steady.csv", both, commands)

    # The flap is torn up until it slips off the tube. Then the other hand goes straight down and meets the tray.
    both = hands()
    left, right = both
    lift_flap(left, FLAP_GRIPS[0], 0.8, (0, 4, 15))
    left.stay(0.6, 1)
    left.stay(0.2)
    left.go(0.8, left.home)
    right.until(left)
    for place in UNDER_FLAP[:2]:
        right.go(0.8, add(place, (0, 0, 1), 10))
        right.go(0.6, add(place, (0, 0, 1), -5.5))
        right.stay(0.5)
        right.go(0.6, add(place, (0, 0, 1), 12))
    right.go(1.0, right.home)
    both[0].until(right)
    write(folder / f"{name}_rough.csv", both)


KNIFE = dict(home=(26, -12, 32), shaft=(0.30, -0.45, 0.84), flat=(1, 0, -0.36))


def cut_threads(folder, name):
    left, right = Hand("left", **LEFT), Hand("right", **KNIFE)
    grip = (-8.33, 0, RAIL_HIGH[2] + 0.3)
    left.go(1.4, add(grip, (0, 0, 1), 5))
    left.go(0.8, grip)
    left.stay(0.3, 1)
    left.go(1.0, add(grip, (-0.8, 0, 0.2)), 1)
    right.until(left)
    for k in MARKED:
        over = (0, THREAD_Y[k - 1], THREAD_Z + 4)
        right.go(1.2, over)
        right.go(1.4, add(over, (0, 0, 1), -6))
        right.go(0.8, over)
    right.go(1.2, right.home)
    left.until(right, 1)
    left.go(0.6, grip, 1)
    left.stay(0.2)
    left.go(1.0, left.home)
    write(folder / f"{name}_steady.csv", (left, right))

    # The rail is torn away, and the knife is swept through whatever stands in its way.
    left, right = Hand("left", **LEFT), Hand("right", **KNIFE)
    left.go(0.8, add(grip, (0, 0, 1), 5))
    left.go(0.5, grip)
    left.stay(0.2, 1)
    left.go(0.8, add(grip, (-7, 0, 2)), 1)
    left.stay(0.4, 1)
    left.go(0.8, grip, 1)
    left.stay(0.2)
    left.go(0.8, left.home)
    right.until(left)
    right.go(1.0, (0, THREAD_Y[0] - 5, THREAD_Z - 1))
    right.go(2.5, (0, THREAD_Y[-1] + 2, THREAD_Z - 1))
    right.go(0.8, (0, THREAD_Y[-1] + 2, THREAD_Z + 12))
    right.go(1.0, right.home)
    left.until(right)
    write(folder / f"{name}_rough.csv", (left, right))


# The blades close across the tube.
APPLIER = dict(home=(24, -14, 44), shaft=(0.50, -0.38, 0.78), flat=(0.621, -0.472, -0.628))
GRIP_OVER_BLADES = 9.9  # mm from the middle of the clip's blades to the applier's tip


def clip_at(hand, along, pace=1.0):
    """Opens the clip, brings its blades astride the tube there, and lets them close."""
    out = unit(APPLIER["shaft"])
    grip = add(add(TUBE_MIDDLE, TUBE_AXIS, along), out, GRIP_OVER_BLADES)
    hand.go(1.6 * pace, add(grip, out, 12))
    hand.stay(0.8 * pace, 1)
    hand.go(2.0 * pace, grip, 1)
    hand.stay(0.5 * pace, 1)
    hand.stay(2.0 * pace)
    return grip, out


def clip_a_tube(folder, name):
    left, right = Hand("left", **LEFT), Hand("right", **APPLIER)
    grip, out = clip_at(right, TUBE_MARK)
    right.stay(0.3, 0, 1)
    right.stay(0.7)
    right.go(1.5, add(grip, out, 14))
    right.go(1.2, right.home)
    right.stay(2.0)
    left.until(right)
    write(folder / f"{name}_steady.csv", (left, right))

    # Beside the ring, and drawn back before the clip is let go.
    left, right = Hand("left", **LEFT), Hand("right", **APPLIER)
    grip, out = clip_at(right, TUBE_MARK + 5, 0.6)
    right.go(0.6, add(grip, (0, 0, 1), 5))
    right.stay(0.5)
    right.go(0.5, grip)
    right.stay(0.3, 0, 1)
    right.stay(0.5)
    right.go(1.0, add(grip, out, 14))
    right.go(1.0, right.home)
    right.stay(2.0)
    left.until(right)
    write(folder / f"{name}_rough.csv", (left, right))


def suction_a_pool(folder, name):
    left, right = hands()
    over = (0, 0, BOWL_BOTTOM + 12)
    left.go(1.4, over)
    left.go(1.0, (0, 0, BOWL_BOTTOM + 4.5))
    left.go(5.0, (0, 0, BOWL_BOTTOM + 2.2), 1)
    left.go(3.0, (0, 0, BOWL_BOTTOM + 1.1), 1)
    left.stay(3.0, 1)
    left.stay(0.2)
    left.go(1.0, over)
    left.go(1.0, left.home)
    right.until(left)
    write(folder / f"{name}_steady.csv", (left, right))

    # Sucking all the way, down onto the bottom and up the wall.
    left, right = hands()
    left.go(0.8, over, 1)
    left.go(0.7, (0, 0, BOWL_BOTTOM - 0.6), 1)
    left.stay(1.0, 1)
    left.go(0.5, (0, 0, BOWL_BOTTOM + 4), 1)
    left.go(0.8, (5, 0, BOWL_BOTTOM + 1.2), 1)
    left.stay(1.0, 1)
    left.go(0.6, (0, 0, BOWL_BOTTOM + 4), 0)
    left.go(1.0, left.home)
    right.until(left)
    write(folder / f"{name}_rough.csv", (left, right))


TASKS = {
    "1_touch_targets": touch_targets,
    "2_hold_a_force": hold_a_force,
    "3_exchange": exchange,
    "4_cut_threads": cut_threads,
    "5_clip_a_tube": clip_a_tube,
    "6_suction_a_pool": suction_a_pool,
}


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else OUTPUT
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in TASKS.items():
        make(folder, name)


if __name__ == "__main__":
    main()
