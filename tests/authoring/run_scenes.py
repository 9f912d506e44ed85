#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""run_scenes.py SOURCE INSULA: every shipped scene, example and case runs a hundred steps and stays finite, in its
exercise's own hands where it has some.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

STEPS = 100


def step_of(text):
    found = re.search(r'<scene[^>]*\btime_step="([0-9.]+) ms"', text)
    return float(found.group(1)) / 1000 if found else 1 / 60


def main():
    source, insula = pathlib.Path(sys.argv[1]), sys.argv[2]
    texts = {
        s: s.read_text(encoding="utf-8")
        for s in sorted(source.glob("scenes/**/*.xml")) + sorted(source.glob("plugins/*/*.xml"))
    }
    scenes = [s for s, text in texts.items() if re.search(r"<scene[\s>/]", text)]
    failures = 0
    for scene in scenes:
        with tempfile.TemporaryDirectory() as folder:
            duration = STEPS * step_of(texts[scene]) + 1e-6
            done = subprocess.run(
                [insula, "run", scene, "--duration", str(duration), "--report", folder, "--quiet"],
                capture_output=True,
                text=True,
                timeout=600,
            )
            report = pathlib.Path(folder) / "report.json"
            steps = json.loads(report.read_text(encoding="utf-8"))["steps"] if report.exists() else 0
        if done.returncode != 0 or steps < STEPS:
            failures += 1
            print("FAILED: %s: status %d, %d steps\n%s%s" % (scene, done.returncode, steps, done.stdout, done.stderr))
    print("%d scenes, %d failed" % (len(scenes), failures))
    return 1 if failures or len(scenes) < 20 else 0


if __name__ == "__main__":
    sys.exit(main())
