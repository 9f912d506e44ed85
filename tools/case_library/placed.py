# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripted motions of a case, from the place at its own neck that library.json declares."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "motions"))
import clipping  # noqa: E402

WAIT = 4  # s after the hand has left the field


def motion(spec, folder, view):
    """The text of a motion that brings one clip to its place, lets it go and leaves the field."""
    field = clipping.Field(folder.name, folder / "artery/vessel.json", view)
    pose, press = field.placement({"press": 0, "push": 0, **spec["place"]}, spec["clip"])
    script = clipping.Script()
    script.command(0.1, "ask", "applier load " + spec["clip"])
    clipping.place_clip(script.right, pose, press, spec.get("approach_s", 2.5), last=spec.get("last_s", 0.8))
    script.right.key(spec.get("wait_s", WAIT), clipping.steady_outside(script), clipping.last_q(script))
    return script.text()
