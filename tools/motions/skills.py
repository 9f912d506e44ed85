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
from layout import POSTS, TARGET_OVER_POST  # noqa: E402
from vectors import add, unit  # noqa: E402

OUTPUT = ROOT / "scenes" / "skills"
# Shafts and homes of the hands, as in the scenes.
LEFT = dict(home=(-26, -12, 32), shaft=(-0.50, -0.38, 0.78), flat=(0.30, 0.75, 0.56))
RIGHT = dict(home=(26, -12, 32), shaft=(0.50, -0.38, 0.78), flat=(-0.30, 0.75, 0.56))


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


TASKS = {"1_touch_targets": touch_targets}


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else OUTPUT
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in TASKS.items():
        make(folder, name)


if __name__ == "__main__":
    main()
