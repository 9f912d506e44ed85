# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions of exercises in which the dome tears, from where the clips and the suction tube are to lie."""
from dataclasses import dataclass

from clip_hand import OUT_OF_FIELD, Script, last_q, place_clip, steady_outside, take_clip
from vectors import across, add, cross, quaternion, unit

TORN_AT = 1  # s
ASKED_AT = 2  # s
DIPPED = 10.5  # s before the end of the motion the tube leaves the blood


@dataclass
class Temporary:
    """A temporary clip: poses of the applier that puts it there, and that takes it where the field has turned it to."""

    clip: str
    put: tuple
    taken: tuple


@dataclass
class Tube:
    """The suction tube: where its tip begins, waits beside the field, and lies in the blood; its orientation."""

    begin: list
    outside: list
    low: list
    turned: list


def tube_over(point, shaft, flat, above, back, home=None):
    """A tube that dips to `above` mm over a point of the field. It comes along its shaft, or straight from `home`."""
    shaft = unit(shaft)
    x = across(flat, shaft)
    low = add(point, shaft, above)
    outside = add(low, unit(add(home, low, -1)) if home else shaft, back)
    return Tube(home or outside, outside, low, quaternion(x, cross(shaft, x), shaft))


def suck(script, tube, seconds):
    """The tube comes, stays in the blood for `seconds`, and leaves."""
    script.left.key(0, tube.begin, tube.turned)
    script.left.key(1.5, tube.outside, tube.turned)
    script.left.key(2.0, tube.low, tube.turned, 1)
    script.left.key(seconds, tube.low, tube.turned, 1)
    script.left.key(2.0, tube.outside, tube.turned, 0)


def begun(clip):
    """The dome tears, and a clip is in the applier."""
    script = Script()
    script.command(TORN_AT, "ask", "bleeding rupture")
    script.command(0.1, "ask", "applier load " + clip)
    return script


def torn(temporary, neck_clip, place, view):
    """The dome tears. The temporary clip, then `place` moves the hand that puts the other clip across the neck."""
    script = begun(temporary.clip)
    place_clip(script.right, temporary.put, approach=2.0, open_at=9)
    away = add(steady_outside(script), view, 30)
    script.right.key(0.8, away, last_q(script))
    script.command(round(script.right.t + 0.2, 3), "ask", "applier load " + neck_clip)
    script.right.key(0.5, away, last_q(script))
    place(script.right)
    return script


def steady(temporary, neck_clip, place, view, tube, wait=8):
    """Suction, temporary clip, the clip across the neck, temporary clip off, and `wait` seconds outside the field."""
    script = torn(temporary, neck_clip, place, view)
    take_clip(script.right, temporary.taken)
    script.right.key(wait, steady_outside(script), last_q(script))
    suck(script, tube, script.right.t - DIPPED - 3.5)
    return script


def left_on(temporary, neck_clip, place, view, tube, wait=4):
    """The same, but the temporary clip stays on the parent artery."""
    script = torn(temporary, neck_clip, place, view)
    script.right.key(wait, steady_outside(script), last_q(script))
    suck(script, tube, script.right.t - DIPPED)
    return script


def paused(dose_mg, neck_clip, pose, place, tube, waits, afterwards):
    """The dome tears, adenosine is asked for, and `place` puts the clip across the neck after `waits` seconds."""
    script = begun(neck_clip)
    script.command(ASKED_AT, "ask", "adenosine give_adenosine %g" % dose_mg)
    outside = add(pose[0], pose[2], OUT_OF_FIELD)
    script.right.key(0, outside, pose[1])
    if waits > 0:
        script.right.key(waits, outside, pose[1])
    place(script.right)
    script.right.key(afterwards, steady_outside(script), last_q(script))
    suck(script, tube, script.right.t - DIPPED)
    return script


def in_a_pause(dose_mg, neck_clip, pose, place, tube):
    """The clip is closed while the heart stands still. The motion ends when it has beaten again for a while."""
    return paused(dose_mg, neck_clip, pose, place, tube, waits=11, afterwards=40)


def before_the_pause(dose_mg, neck_clip, pose, place, tube):
    """The clip is closed before the adenosine acts."""
    return paused(dose_mg, neck_clip, pose, place, tube, waits=0, afterwards=6)


def late(pose, tube):
    """Somebody sucks for a while, and nobody clips."""
    script = Script()
    script.command(TORN_AT, "ask", "bleeding rupture")
    suck(script, tube, 12)
    outside = add(pose[0], pose[2], OUT_OF_FIELD)
    script.right.key(0, outside, pose[1])
    script.right.key(301, outside, pose[1])
    return script
