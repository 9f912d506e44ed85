# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `insula export`."""

from __future__ import annotations

import argparse
import pathlib
import sys

import insula
from insula.interchange.exporting import FORMATS, INSTRUMENTS, checked, export, export_instrument
from insula.interchange.frames import ExportError


def arguments(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="insula export", description="writes a scene or an instrument in another "
                                     "program's format (docs/interchange.md)")
    parser.add_argument("scene", metavar="SCENE", help="scene file or name; for .mjcf and .urdf a URDF file, or the "
                        "name of an instrument or a clip")
    parser.add_argument("--to", required=True, metavar="FILE", help="its ending is the format: " + ", ".join(FORMATS))
    parser.add_argument("--motion", default="none", metavar="NAME", help="motion of the exercise, a CSV file, or none "
                        "(default: none)")
    parser.add_argument("--at", type=float, default=0.0, metavar="S", help="time of the first frame (default: 0)")
    parser.add_argument("--until", type=float, metavar="S", help="time of the last frame (default: one frame)")
    parser.add_argument("--rate", type=float, default=10.0, metavar="N", help="frames a second (default: 10)")
    return parser.parse_args(words)


def run(options: argparse.Namespace) -> str:
    """Does it, and returns what to say."""
    file = checked(options.to)
    if file.suffix in INSTRUMENTS:
        export_instrument(options.scene, file)
        return str(file)
    simulation = insula.load(options.scene)
    if options.motion != "none":
        simulation.follow(simulation.motion(options.motion))
    frames = export(simulation, file, start=options.at, until=options.until, rate=options.rate)
    return "%s: %d frames from %g s to %g s, %d soft surfaces, %d rigid ones" % (
        file, len(frames.times), frames.times[0], frames.times[-1], len(frames.soft), len(frames.rigid))


def main(words: list[str] | None = None) -> int:
    options = arguments(sys.argv[1:] if words is None else words)
    try:
        print(run(options))
    except (ExportError, insula.SceneError, insula.InputError, FileNotFoundError) as error:
        print("error: %s" % error, file=sys.stderr)
        return 2
    except RuntimeError as error:  # the state left the range of numbers
        print("error: %s" % error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
