#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the reference bands of the exercises and skill tasks from scripted hands with seeded variation.

    python3 tools/motions/scripted_bands.py [--insula PROGRAM] [--seeds 12] [--jobs 2] [SCENE ...]

Each seed plays the exercise's `steady` motion at its own pace, with a slow wander and a tremor of each hand. The bands
go beside the scene as NAME_bands.json. They say how these hands work and nothing about persons. The same seeds give the
same motions; metrics have the bits of the instruction set.
"""
import argparse
import concurrent.futures
import csv
import math
import pathlib
import random
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
GROUP = "scripted hands"
PACE = 0.12  # largest change of the pace, as a share
WANDER_M, WANDER_HZ = 0.00025, (0.1, 0.5)  # largest amplitude of a sine, and its frequencies
TREMOR_M, TREMOR_HZ = 0.00003, (8.0, 11.0)
SINES = 3
INTERVAL_S = 0.03  # between the keys of the varied motion: tremor is sampled three times in a period


def sines(source, amplitude, frequencies):
    """A smooth displacement over time: a sum of sines for each axis, m."""
    parts = [
        [
            (amplitude * source.random() / SINES, source.uniform(*frequencies), source.uniform(0, 2 * math.pi))
            for _ in range(SINES)
        ]
        for _ in range(3)
    ]
    return lambda t: [sum(a * math.sin(2 * math.pi * f * t + p) for a, f, p in axis) for axis in parts]


def between(a, b, t):
    """Values of a hand at a time between two keys. The quaternion's length does not matter to a reader."""
    span = b[0] - a[0]
    share = 0 if span <= 0 else (t - a[0]) / span
    sign = 1 if sum(x * y for x, y in zip(a[1][3:], b[1][3:])) >= 0 else -1
    pose = [x + share * ((y if k < 3 else sign * y) - x) for k, (x, y) in enumerate(zip(a[1], b[1]))]
    length = math.sqrt(sum(v * v for v in pose[3:]))
    return pose[:3] + [v / length for v in pose[3:]]


def varied(rows, seed):
    """The rows of a motion, varied. Commands keep their places among the keys."""
    source = random.Random(seed)
    pace = 1 + PACE * source.uniform(-1, 1)
    out = []
    for row in rows:
        if row[1] == "command":
            out.append((float(row[0]) * pace, [*row[1:]]))
    for hand in ("left", "right"):
        keys = [(float(r[0]), [float(v) for v in r[2:9]], r[9:11]) for r in rows if r[1] == hand]
        wander, tremor = sines(source, WANDER_M, WANDER_HZ), sines(source, TREMOR_M, TREMOR_HZ)
        for k, key in enumerate(keys):
            following = keys[k + 1] if k + 1 < len(keys) else key
            steps = max(1, math.ceil((following[0] - key[0]) * pace / INTERVAL_S))
            for n in range(steps if following is not key else 1):
                t = key[0] + (following[0] - key[0]) * n / steps
                pose = between(key, following, t)
                moved = [p + w + s for p, w, s in zip(pose, wander(t * pace), tremor(t * pace))]
                values = [f"{v:.7f}" for v in moved + pose[3:]]
                out.append((t * pace, [hand, *values, *key[2]]))
    out.sort(key=lambda entry: entry[0])
    return [[f"{t:.4f}", *rest] for t, rest in out]


def play(insula, scene, rows, header, seed, folder):
    motion, recording = folder / f"{seed}.csv", folder / f"{seed}.insula"
    with motion.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *varied(rows, seed)])
    fields = ["--field", f"hands={GROUP}", "--field", f"person=seed{seed}"]
    command = [insula, "run", scene, "--motion", motion, "--record", recording, "--threads", "1", "--quiet", *fields]
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=True).stdout.strip()


def make_bands(insula, scene, seeds, jobs):
    steady = scene.with_name(scene.stem + "_steady.csv")
    header, *rows = [r for r in csv.reader(steady.open()) if r and not r[0].startswith("#")]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            done = [pool.submit(play, insula, scene, rows, header, s, folder) for s in range(1, seeds + 1)]
            for seed, future in enumerate(done, 1):
                print(f"{scene.stem} seed {seed}: {future.result()}", flush=True)
        bands = [insula, "bands", folder, "--group", "hands", "--json"]
        text = subprocess.run([str(b) for b in bands], capture_output=True, text=True, check=True).stdout
    scene.with_name(scene.stem + "_bands.json").write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--insula", type=pathlib.Path, default=ROOT / "build/release/bin/insula")
    parser.add_argument("--seeds", type=int, default=12)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    shipped = [s for folder in ("training", "skills") for s in sorted((ROOT / "scenes" / folder).glob("[0-9]*.xml"))]
    scenes = options.scenes or shipped
    for scene in scenes:
        make_bands(options.insula, scene.resolve(), options.seeds, options.jobs)


if __name__ == "__main__":
    main()
