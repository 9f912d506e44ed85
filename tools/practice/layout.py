# SPDX-License-Identifier: GPL-3.0-or-later
"""Where things stand in the skill tasks, in millimetres. Meshes and scripted motions share these places."""

# Posts of the first task: x, y, height. A target floats 3 mm over the top of each.
POSTS = [
    (-17, 7, 4),
    (17, 7, 9),
    (-6, 9, 12),
    (6, 9, 3),
    (-17, -7, 10),
    (17, -7, 5),
    (-6, -6, 3.5),
    (6, -6, 13),
]
TARGET_OVER_POST = 3.0

# Soft pad of the second task: its box, and the places where it is pressed, in turn, the left hand first.
PAD_LOW, PAD_HIGH = (-24, -16, 0.05), (24, 16, 10.05)
PRESSES = [(-12, 8), (12, 8), (-12, -8), (12, -8)]

# Flap of the third task: a soft sheet that is held at its far edge, above the floor. Balls lie below it.
FLAP_LOW, FLAP_HIGH = (-9, -8, 8), (9, 8, 9.6)
FLAP_GRIPS = [(-4.5, -7.7), (4.5, -7.7)]  # where each hand's suction tube takes it
UNDER_FLAP = [(5, -3, 3.5), (1.5, -3, 3.5), (-5, -3, 3.5), (-1.5, -3, 3.5)]  # two for the right hand, two for the left

# Threads of the fourth task: two soft rails, and the middles of the threads between them.
RAIL_LOW, RAIL_HIGH = (4.5, -16, 0.05), (16, 16, 10.05)
THREAD_Y = [-12, -8, -4, 0, 4, 8, 12]
THREAD_Z = 10.05
MARKED = [2, 5, 6]  # counted from 1

# Tube of the fifth task: it runs across the right hand's shaft. The clip's place is `mark` from its middle.
TUBE_MIDDLE, TUBE_AXIS = (0, 0, 10), (0.605, 0.796, 0)
TUBE_RADIUS, TUBE_LENGTH, TUBE_MARK = 1.3, 17, -1

# Bowl of the sixth task: a paraboloid in a soft pad.
BOWL_RADIUS, BOWL_DEPTH, BOWL_BOTTOM = 11, 7.5, 2.5
