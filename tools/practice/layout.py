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
