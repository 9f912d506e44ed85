# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripted motions of a case, from the place at its own vessel that library.json declares."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "motions"))
import clipping  # noqa: E402
from clip_hand import Clip, Script, last_q, place_clip, steady_outside  # noqa: E402

WAIT = 4  # s after the hand has left the field


def field_of(folder, view):
    """The artery of a case, seen from the surgeon of its approach."""
    return clipping.Field(folder.name, folder / "artery/vessel.json", view)


def motion(spec, folder, view):
    """The text of a motion that brings one clip to its place, lets it go and leaves the field."""
    field = field_of(folder, view)
    if "across" in spec:
        pose, press = field.branch(Clip(spec["clip"]), **spec["across"]), (0, 0, 0)
    else:
        pose, press = field.placement({"press": 0, "push": 0, **spec["place"]}, spec["clip"])
    script = Script()
    script.command(0.1, "ask", "applier load " + spec["clip"])
    place_clip(script.right, pose, press, spec.get("approach_s", 2.5), last=spec.get("last_s", 0.8))
    script.right.key(spec.get("wait_s", WAIT), steady_outside(script), last_q(script))
    return script.text()
