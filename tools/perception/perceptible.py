#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What a hand can feel of an exercise: recorded forces against friction, resolution and limits of each device, and the
error of the servo in just-noticeable differences (JND). Prints tables in Markdown.

    perceptible.py [FILE...] [--rate HZ] [--scale S] [--recorded-scale S] [--friction NAME=N]... [--table FILE]

FILE is the report.json of `insula run --report`, or the servo.csv of `insula session export`. Without files it prints
the tables that need no forces. Devices and people are in perception.json. The errors of the servo are those of
docs/haptic-truth.md. --friction gives a friction that was measured, in N: --friction Inverse3=0.1.
"""
import argparse
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import devices as profiles  # noqa: E402
import forces  # noqa: E402
import tables  # noqa: E402

TRUTH = os.path.join(os.path.dirname(os.path.dirname(HERE)), "docs", "haptic-truth.md")
AIM = (0.02, 0.05)  # median and 90th percentile, of docs/haptic-truth.md


def servo_errors(rate_hz, path=TRUTH):
    """(median, 90th percentile) of the rms error over the random probes of exercise 1, as shares of the peak."""
    with open(path, encoding="utf-8") as f:
        for line in f:
            cells = [c.strip() for c in line.strip().strip("|").split("|")]
            if cells[:2] == ["1, all", str(rate_hz)]:
                median, high = (float(x) / 100 for x in cells[2].split(","))
                return median, high
    raise SystemExit(f"{path} has no errors for {rate_hz} Hz")


def named_errors():
    out = []
    for name, errors in [("aim", AIM)] + [(f"{rate} Hz", servo_errors(rate)) for rate in (30, 60, 100)]:
        out += [(f"{name}, median", errors[0]), (f"{name}, 90 %", errors[1])]
    return out


def measured_friction(text):
    name, _, value = text.rpartition("=")
    try:
        friction_N = float(value)
    except ValueError:
        friction_N = -1.0
    if not name or not 0 <= friction_N < math.inf:
        raise argparse.ArgumentTypeError(f'"{text}" is not NAME=N')
    return name, friction_N


def positive(text):
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f'"{text}" is not a positive number')
    return value


def options(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", metavar="FILE")
    parser.add_argument("--rate", type=int, default=60, help="rate of the engine, Hz (default 60)")
    parser.add_argument("--scale", type=positive, help="force_scale (default: 1 for shares, the chosen one for errors)")
    parser.add_argument("--recorded-scale", type=positive, default=1.0, help="force_scale in a servo.csv")
    parser.add_argument("--friction", type=measured_friction, action="append", default=[], metavar="NAME=N")
    parser.add_argument("--table", default=os.path.join(HERE, "perception.json"))
    return parser.parse_args(arguments)


def main(arguments):
    chosen = options(arguments)
    devices = profiles.read_devices(chosen.table, chosen.friction)
    errors, scale = servo_errors(chosen.rate), chosen.scale or 1.0
    recordings = [forces.read(path, chosen.recorded_scale) for path in chosen.files]
    parts = [
        ("Error that is one JND, % of the displayed peak", tables.allowed_table(devices)),
        ("Displayed peak up to which an error is below one JND", tables.aim_table(devices[0].person, named_errors())),
    ]
    if tables.hands_of(recordings):
        title = f"Error of the servo at {chosen.rate} Hz in JND (median, 90 %), "
        jnd = [tables.jnd_table(recordings, devices, errors, chosen.scale, share) for share in (0.5, 1.0)]
        parts += [
            ("Rendered forces in contact, and time above a friction", tables.force_table(recordings)),
            (f"Time, range above friction, %, scale {scale:g}", tables.friction_table(recordings, devices, scale)),
            ("Time, range above resolution, %", tables.resolution_table(recordings, devices, scale)),
            (f"Time below the largest force, %, scale {scale:g}", tables.maximum_table(recordings, devices, scale)),
            ("Choice of force_scale, and time above the threshold", tables.scale_table(recordings, devices)),
            (title + "touches that peak at the median force", jnd[0]),
            (title + "touches that reach the peak of the exercise", jnd[1]),
        ]
    print("\n\n".join(f"{title}:\n\n{text}" for title, text in parts))
    for recording in recordings:
        if not any(recording.contact.values()):
            print(f"\n{recording.title}: no contact")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
