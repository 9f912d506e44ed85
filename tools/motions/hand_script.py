# SPDX-License-Identifier: GPL-3.0-or-later
"""A motion of two hands that is written as a course of moves. Each move starts and ends at rest (minimum jerk)."""
from vectors import across, cross, quaternion, unit

KEY_INTERVAL = 0.05  # s


def orientation(shaft, flat):
    """Of a tool: z along the shaft to the handle, x the normal of the flat side."""
    z = unit(shaft)
    x = across(flat, z)
    return quaternion(x, cross(z, x), z)


class Hand:
    """Keys of one hand. Places are of the tip, in millimetres."""

    def __init__(self, name, home, shaft, flat):
        self.name, self.at, self.t = name, list(home), 0.0
        self.turned = orientation(shaft, flat)
        self.home = list(home)
        self.keys = []
        self.key((0, 0))

    def key(self, buttons):
        self.keys.append((self.t, list(self.at), buttons))

    def go(self, seconds, place, button=0, release=0):
        """To a place; the buttons change at the start of the move."""
        begin, start = list(self.at), self.t
        n = max(1, round(seconds / KEY_INTERVAL))
        for k in range(1, n + 1):
            s = k / n
            s = s * s * s * (10 - 15 * s + 6 * s * s)
            self.t = start + seconds * k / n
            self.at = [a + (b - a) * s for a, b in zip(begin, place)]
            self.key((button, release))

    def stay(self, seconds, button=0, release=0):
        """One key at the start, where the buttons change, and one at the end."""
        self.t += 0.01
        self.key((button, release))
        self.t += seconds - 0.01
        self.key((button, release))

    def until(self, t, button=0):
        """Stays until that time, or until the other hand has come so far."""
        t = t.t if isinstance(t, Hand) else t
        if t > self.t + 0.02:
            self.stay(t - self.t, button)

    def rows(self):
        for t, at, (b1, b2) in self.keys:
            numbers = ["%.6f" % (x / 1000) for x in at] + ["%.6f" % x for x in self.turned]
            text = ",".join(numbers).replace("-0.000000", "0.000000")
            yield t, self.name, "%.3f,%s,%s,%d,%d" % (t, self.name, text, b1, b2)


def write(path, hands, commands=()):
    """Commands: time, and the rest of the row."""
    rows = [row for hand in hands for row in hand.rows()]
    rows += [(t, "", "%.3f,command,%s" % (t, text)) for t, text in commands]
    rows.sort(key=lambda r: (round(r[0], 4), r[1]))
    lines = ["time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2"] + [text for _, _, text in rows]
    path.write_text("\n".join(lines) + "\n", encoding="ascii", newline="\n")
