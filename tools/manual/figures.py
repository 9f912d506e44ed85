#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""figures.py BUILD [--check]: the pictures of docs/validation.md, each from a run of the test that holds the law: the law is a line, what
the simulation gave are the points. With --check nothing is written: pictures that the tests no longer give are told.

A test keeps what it finds when INSULA_FIGURES names a folder (tests/figures/figure.h).
"""
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
OUT = ROOT / "docs/images/validation"
FIGURES = {  # name: (program, test)
    "anchors": ("plugin_tests", "AnchorSprings.WholeFollowsTheDiscretisedOscillator"),
    "arm": ("servo_tests", "ArmModel.StepIsImplicitEulerExactly"),
    "bar": ("physics_tests", "Bar.EndLoadIsExact"),
    "cantilever": ("physics_tests", "Cantilever.ConvergesToBeamTheory"),
    "curved_strip": ("plugin_tests", "Bending.StripCurvedAtRest"),
    "cut": ("plugin_tests", "StrandSprings.ResistsWithCutForceAndPartsAfterCutLength"),
    "equation7": ("servo_tests", "Servo.EquationSevenAgainstAFreshSolve"),
    "fall": ("physics_tests", "ImplicitEuler.FreeFall"),
    "friction": ("plugin_tests", "Contact.ABlockOnASlopeSticksAndSlipsAtTheFrictionAngle"),
    "gate": ("servo_tests", "SafetyGate.RampsInOverAQuarterSecond"),
    "jaws": ("plugin_tests", "Clip.JawsBalanceTheSpringAtEveryOpeningAndPlaceOfTheBlade"),
    "mass_damping": ("physics_tests", "RayleighDamping.MassPartSlowsRigidMotion"),
    "oscillator": ("physics_tests", "RayleighDamping.OscillatorFollowsTheDiscretisedLaw"),
    "own_weight": ("physics_tests", "Bar.OwnWeightConverges"),
    "plate": ("plugin_tests", "Bending.PlateConvergesOnAnyMesh"),
    "sealed_sac": ("plugin_tests", "BloodFlow.SacBehindAClosedNeckGoesSoft"),
    "sphere": ("plugin_tests", "Laplace.SphereConverges"),
    "squeeze": ("plugin_tests", "Crushed.EnergyOfAUniformSqueeze"),
    "strand": ("plugin_tests", "StrandSprings.PullsAsTheDiscretisedLawSays"),
    "strip": ("plugin_tests", "Bending.CantileverConvergesToEulerBernoulli"),
    "suction": ("plugin_tests", "Suction.HoldsUpToPressureTimesAreaAndLetsGo"),
    "weakening": ("plugin_tests", "ClipApplier.AHeldOpenSpringWeakensAsPublished"),
}
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 460, 270, 62, 14, 44, 44
COLOURS = ("#1f6fb2", "#c2410c", "#15803d", "#7e22ce")
SLACK = 0.3  # pixels by which another processor's last digits may move a point


def ticks(low, high):
    """Some five round numbers within a range, each with its text."""
    raw = (high - low) / 5
    size = 10.0 ** math.floor(math.log10(raw))
    step = next(size * m for m in (1, 2, 5, 10) if size * m >= raw * 0.999)
    first, digits = math.ceil(low / step - 1e-9), max(0, -math.floor(math.log10(step) + 1e-9))
    return [(k * step, "%.*f" % (digits, k * step)) for k in range(first, int(math.floor(high / step + 1e-9)) + 1)]


def text(x, y, what, anchor="middle", more=""):
    escaped = what.replace("&", "&amp;").replace("<", "&lt;")
    return '<text x="%.1f" y="%.1f" text-anchor="%s"%s>%s</text>' % (x, y, anchor, more, escaped)


def svg(figure):
    points = [p for kind in ("law", "run") for curve in figure[kind].values() for p in curve]
    low, high = [min(p[k] for p in points) for k in (0, 1)], [max(p[k] for p in points) for k in (0, 1)]
    pad = 0.06 * (high[1] - low[1])
    low[1], high[1] = low[1] - pad, high[1] + pad
    x = lambda v: LEFT + (v - low[0]) / (high[0] - low[0]) * (WIDTH - LEFT - RIGHT)  # noqa: E731
    y = lambda v: HEIGHT - BOTTOM - (v - low[1]) / (high[1] - low[1]) * (HEIGHT - TOP - BOTTOM)  # noqa: E731
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" width="%d" height="%d" role="img" font-family="sans-serif" font-size="11" fill="#222">' % (WIDTH, HEIGHT, WIDTH, HEIGHT),
           '<rect width="%d" height="%d" fill="#fff"/>' % (WIDTH, HEIGHT), text(WIDTH / 2, 16, figure["title"], more=' font-size="12"')]
    for v, shown in ticks(low[0], high[0]):
        out += ['<path d="M%.1f %.1fV%.1f" stroke="#e5e7eb"/>' % (x(v), TOP, HEIGHT - BOTTOM), text(x(v), HEIGHT - BOTTOM + 14, shown)]
    for v, shown in ticks(low[1], high[1]):
        out += ['<path d="M%.1f %.1fH%.1f" stroke="#e5e7eb"/>' % (LEFT, y(v), WIDTH - RIGHT), text(LEFT - 5, y(v) + 4, shown, "end")]
    out += [text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, figure["x"]), text(13, (TOP + HEIGHT - BOTTOM) / 2, figure["y"], more=' transform="rotate(-90 13 %.1f)"' % ((TOP + HEIGHT - BOTTOM) / 2))]
    names = list(figure["law"]) + [n for n in figure["run"] if n not in figure["law"]]
    same = set(figure["law"]) == set(figure["run"])
    for i, name in enumerate(names):
        colour = COLOURS[i % len(COLOURS)]
        law = sorted(figure["law"].get(name, []), key=lambda p: p[0])
        if law:
            out.append('<path d="M%s" fill="none" stroke="%s" stroke-width="1.4"/>' % ("L".join("%.1f %.1f" % (x(a), y(b)) for a, b in law), colour))
        out += ['<circle cx="%.1f" cy="%.1f" r="2.6" fill="none" stroke="%s"/>' % (x(a), y(b), colour) for a, b in figure["run"].get(name, [])]
        shown = name if same or name in ("law", "run") else name + (" (law)" if law else " (run)")
        out.append(text(LEFT + (WIDTH - LEFT - RIGHT) * (2 * i + 1) / (2 * len(names)), 34, shown, more=' fill="%s"' % colour))
    return "\n".join(out) + "\n</svg>\n"


def run(build, folder):
    for program in sorted({p for p, _ in FIGURES.values()}):
        tests = ":".join(sorted(t for p, t in FIGURES.values() if p == program))
        done = subprocess.run([build / "tests" / program, "--gtest_filter=" + tests, "--gtest_brief=1"], cwd=ROOT, capture_output=True, text=True, env=dict(os.environ, INSULA_FIGURES=str(folder)))
        if done.returncode != 0:
            sys.exit("error: the tests of the pictures fail:\n" + done.stdout + done.stderr)
    missing = [name for name in FIGURES if not (folder / (name + ".json")).exists()]
    if missing:
        sys.exit("error: no test gave %s" % ", ".join(missing))


def differs(a, b):
    """Whether two pictures are more than the last digits of their numbers apart."""
    number = re.compile(r"-?\d+\.?\d*")
    return number.sub("#", a) != number.sub("#", b) or any(abs(float(p) - float(q)) > SLACK for p, q in zip(number.findall(a), number.findall(b)))


def main():
    build, check = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:] == ["--check"]
    failures = 0
    with tempfile.TemporaryDirectory() as name:
        run(build, pathlib.Path(name))
        made = {n: svg(json.loads((pathlib.Path(name) / (n + ".json")).read_text(encoding="utf-8"))) for n in FIGURES}
    page = (ROOT / "docs/validation.md").read_text(encoding="utf-8")
    for name, picture in made.items():
        file = OUT / (name + ".svg")
        if "images/validation/%s.svg" % name not in page:
            failures += 1
            print("FAILED: docs/validation.md does not show %s" % file.relative_to(ROOT))
        if not check:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(picture, encoding="utf-8")
        elif not file.exists() or differs(file.read_text(encoding="utf-8"), picture):
            failures += 1
            print("FAILED: %s is not what the test gives: python3 tools/manual/figures.py BUILD, and look at it" % file.relative_to(ROOT))
    for file in OUT.glob("*.svg"):
        if file.stem not in FIGURES:
            failures += 1
            print("FAILED: nothing gives %s" % file.relative_to(ROOT))
    print("%d pictures; %d failures" % (len(made), failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
