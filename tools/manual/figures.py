#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""figures.py BUILD [--check]: the pictures of docs/validation.md, each from a run of the test that holds the law: the
law is a line, what the simulation gave are the points. Laws that hold at a single place have no line to draw: a picture
a section shows the errors that their tests met, beside what is allowed. With --check nothing is written: pictures that
the tests no longer give are told, and so are laws without any.

A test keeps what it finds when INSULA_FIGURES names a folder (tests/figures/figure.h), and errors as its properties
(core/testing/held.h).
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
    "bowl": ("plugin_tests", "Bleeding.FillsTheFieldAtTheTearsRateAndRunsOffAtTheRim"),
    "elastica": ("plugin_tests", "Bending.ElasticaAtLargeRotation"),
    "poiseuille": ("plugin_tests", "BloodFlow.StraightTubeIsPoiseuilles"),
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
    "squeeze": ("plugin_tests", "CompressionBarrier.EnergyOfAUniformSqueeze"),
    "strand": ("plugin_tests", "StrandSprings.PullsAsTheDiscretisedLawSays"),
    "strip": ("plugin_tests", "Bending.CantileverConvergesToEulerBernoulli"),
    "suction": ("plugin_tests", "Suction.HoldsUpToPressureTimesAreaAndLetsGo"),
    "torn_sac": ("plugin_tests", "BloodFlow.TornSacThatIsCutOffComesToThePressureOutside"),
    "weakening": ("plugin_tests", "ClipApplier.AHeldOpenSpringWeakensAsPublished"),
}
ERRORS = {  # section of the page: (picture, {program: tests that keep errors})
    "Elasticity": (
        "errors_elasticity",
        {
            "physics_tests": "PatchTest.*:Cantilever.IsFrameIndifferent:Bar.Poisson*",
            "plugin_tests": "ElementBatch.FindsTheRotation*:ElementBatch.Inverted*:CorotationalFem.BothTangents*:"
            "CorotationalFem.MassIs*",
        },
    ),
    "Membrane": (
        "errors_membrane",
        {
            "plugin_tests": "Membrane.PatchTest:Membrane.Uniaxial*:Membrane.StressOf*:Membrane.RigidMotion*:"
            "Membrane.EachRegion*:Membrane.EnergyIsBounded*:Bending.Quadratic*:Bending.StepOf*:Laplace.Prism*:"
            "Laplace.Icosahedron*:PinchedCylinder.*:AnchorSprings.DrawBack*"
        },
    ),
    "Time integration": (
        "errors_integration",
        {
            "physics_tests": "ImplicitEuler.RigidTranslation*:ImplicitEuler.FreeBody*:ImplicitEuler.Compliance*:"
            "Asynchronous.ForcesAre*",
            "core_tests": "Processor/BodySolverContract/*.SolvesAs*:Processor/BodySolverContract/*.ComplianceAnd*:"
            "AsynchronousSolver.CorrectionKnows*",
        },
    ),
    "Constraint solver": (
        "errors_solver",
        {
            "physics_tests": "LocalContact.IsTheSolution*:Solver.RandomProblems*:Solver.ConvergesToThe*:"
            "Solver.ResultDoesNot*:Solver.KnownAnswer:Solver.ConjugateDirectionsSolve*",
            "core_tests": "Disc.IsTheSolution*",
        },
    ),
    "Contact, strands, suction, tools": (
        "errors_contact",
        {
            "plugin_tests": "Contact.SignoriniHolds*:Contact.ForcesOnBoth*:StrandSprings.TwoBodies*:"
            "Retractor.TheHandCarries*:FixedRegion.FixedNodesStay:ContactLimits.ForceOfALayerIs*"
        },
    ),
    "Contracts": ("errors_contracts", {"physics_tests": "Elements/EveryElement.*"}),
    "Pressure and flow": (
        "errors_flow",
        {
            "plugin_tests": "Chambers.AddUp*:Pressure.Balances*:Pressure.SphereOf*:Pressure.FillsAt*:Pressure.Sealed*:"
            "Pressure.RowsAre*:Prestress.Imaged*:Prestress.Without*:Section.Cuts*:BloodFlow.Network*:"
            "BloodFlow.SplitsThe*:BloodFlow.ClipOn*:BloodFlow.TearBleeds*:BloodFlow.TornSac*:"
            "BloodFlow.PulsatesWithout*:Bleeding.TearsWhen*:Bleeding.AWallThat*:DopplerBeam.FollowsTheCosine*:"
            "MicroDoppler.AgreesWith*"
        },
    ),
    "Clips and thin walls": (
        "errors_clips",
        {
            "plugin_tests": "Clip.MomentumIs*:Clip.FallsBy*:Clip.HoldsAnd*:ClipApplier.TheHandFeels*:"
            "ClipApplier.Released*:ContactLimits.ForceOfALayerIs*:SelfContact.AWallThat*",
            "core_tests": "Clip.EveryShipped*:VertexCollider.EveryVertex*:StretchedEdges.*:"
            "SelfCollider.WallsPressed*:OneSided.AVertexThat*",
        },
    ),
    "Haptics": (
        "errors_haptics",
        {
            "servo_tests": "Servo.ForceEquals*:SafetyGate.RampsOut*:SafetyGate.RampsIn*:SafetyGate.Garbage*:"
            "ArmModel.RestsForce*:ArmModel.EnergyNever*",
            "device_tests": "StreamedDevice.PowerIs*",
        },
    ),
}
CLOSED_FORMS = [s for s in ERRORS if s != "Contracts"]
# Tests of those sections that hold no closed form (the same bits, a bound never passed, whole cases), or that need a
# device which not every machine has.
NO_PICTURE = {
    "OpenclSolver.MovesAChainBetweenWallsAsTheClosedFormSays",
    "AsynchronousSolver.SolvesToItsToleranceWithAnOldFactor",
    "Asynchronous.TheSameInputGivesTheSameBits",
    "Solver.BoundsHoldAfterAnyNumberOfSweeps",
    "Allocation.SolveAllocatesNothing",
    "Contact.AFastToolNeverEndsInsideAPlate",
    "StrandSprings.TearsBeyondItsStrength",
    "Clip.EnergyNeverExceedsThatOfTheOpenSpring",
    "ClipApplier.LetsGoAndTakesBackWithoutAStepOfForce",
    "SelfContact.FastBladesPressNoWallThroughTheOtherAndStayOutside",
    "SelfContact.JawsPressAVesselFlatAndItsWallsStayApart",
    "Patch.AllTogetherStickBelowMuNAndSlipAbove",
    "ColliderCache.OfAWallAgainstItselfNeverShows",
    "SelfContactNeck.RowsOfAClippedNeckKeepTheirNamesAtRest",
    "RealVessel.Pulses",
    "RealCase.BecomesACaseWhoseExercisesTheMotionsMadeForItFinish",
    "OwnBrain.SurfacesBecomeLabels",
    "OwnBrain.ThatStandsElsewhereIsTold",
    "MadeCase.VesselTooThinForAWayIsNamed",
    "RuptureRules.SpurtsTakeNothingBackButBloodThatRunsDoes",
    "MadeCase.GivesTheSameFilesTwiceAndStagesCanBeDoneAgainAlone",
    "RealSurface.BecomesAVesselThatTheProductReads",
    "Servo.HandsFeelEachOtherThroughTheSharedProblem",
    "Servo.SweepsAreBounded",
    "Exchange.TheHandFeelsTheNewToolGently",
    "DeviceTool.WaysThatCannotBeAreRefused",
    "HaplyMessages.AMillionDamagedOnesGiveNothingThatCannotBe",
    "InProcess.AMovingHandGetsAFreshForceAtEachTick",
    "Allocation.TheServoDoesNone",
    "TripleBuffer.TwoThreadsNeverShareASlot",
}
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 460, 270, 62, 14, 44, 44
COLOURS = ("#1f6fb2", "#c2410c", "#15803d", "#7e22ce")
SLACK = 0.3  # pixels by which another processor's last digits may move a point
ROUNDING = 25  # the same of an error of rounding: two decades, which its test still holds below what is allowed


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
    out = [
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" width="%d" height="%d" role="img" '
        'font-family="sans-serif" font-size="11" fill="#222">'
        % (WIDTH, HEIGHT, WIDTH, HEIGHT),
        '<rect width="%d" height="%d" fill="#fff"/>' % (WIDTH, HEIGHT),
        text(WIDTH / 2, 16, figure["title"], more=' font-size="12"'),
    ]
    for v, shown in ticks(low[0], high[0]):
        out += [
            '<path d="M%.1f %.1fV%.1f" stroke="#e5e7eb"/>' % (x(v), TOP, HEIGHT - BOTTOM),
            text(x(v), HEIGHT - BOTTOM + 14, shown),
        ]
    for v, shown in ticks(low[1], high[1]):
        out += [
            '<path d="M%.1f %.1fH%.1f" stroke="#e5e7eb"/>' % (LEFT, y(v), WIDTH - RIGHT),
            text(LEFT - 5, y(v) + 4, shown, "end"),
        ]
    out += [
        text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, figure["x"]),
        text(
            13,
            (TOP + HEIGHT - BOTTOM) / 2,
            figure["y"],
            more=' transform="rotate(-90 13 %.1f)"' % ((TOP + HEIGHT - BOTTOM) / 2),
        ),
    ]
    names = list(figure["law"]) + [n for n in figure["run"] if n not in figure["law"]]
    same = set(figure["law"]) == set(figure["run"])
    for i, name in enumerate(names):
        colour = COLOURS[i % len(COLOURS)]
        law = sorted(figure["law"].get(name, []), key=lambda p: p[0])
        if law:
            out.append(
                '<path d="M%s" fill="none" stroke="%s" stroke-width="1.4"/>'
                % ("L".join("%.1f %.1f" % (x(a), y(b)) for a, b in law), colour)
            )
        out += [
            '<circle cx="%.1f" cy="%.1f" r="2.6" fill="none" stroke="%s"/>' % (x(a), y(b), colour)
            for a, b in figure["run"].get(name, [])
        ]
        shown = name if same or name in ("law", "run") else name + (" (law)" if law else " (run)")
        out.append(
            text(LEFT + (WIDTH - LEFT - RIGHT) * (2 * i + 1) / (2 * len(names)), 34, shown, more=' fill="%s"' % colour)
        )
    return "\n".join(out) + "\n</svg>\n"


def errors_svg(title, laws):
    """laws: {law: (greatest error, allowed)}. A row a law: a circle where the error lies, a bar where it may not be."""
    row, left = 17, 270
    height = TOP + row * len(laws) + 44
    low, high = -17, 0
    x = lambda v: left + (max(low, min(high, math.log10(v) if v > 0 else low)) - low) / (high - low) * (
        WIDTH - left - RIGHT
    )  # noqa: E731
    out = [
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" width="%d" height="%d" role="img" '
        'font-family="sans-serif" font-size="11" fill="#222">'
        % (WIDTH, height, WIDTH, height),
        '<rect width="%d" height="%d" fill="#fff"/>' % (WIDTH, height),
        text(WIDTH / 2, 16, title, more=' font-size="12"'),
    ]
    for power in range(low + 1, high + 1, 4):
        at = x(10.0**power)
        out += [
            '<path d="M%.1f %dV%d" stroke="#e5e7eb"/>' % (at, TOP - 10, height - 40),
            text(at, height - 26, "1e%d" % power),
        ]
    for i, (law, (found, allowed)) in enumerate(laws.items()):
        y = TOP + row * i + 4
        out += [
            text(left - 8, y + 4, law, "end"),
            '<path d="M%.1f %.1fH%.1f" stroke="#fee2e2" stroke-width="9"/>' % (x(allowed), y, WIDTH - RIGHT),
            '<path d="M%.1f %.1fV%.1f" stroke="%s" stroke-width="1.6"/>' % (x(allowed), y - 6, y + 6, COLOURS[1]),
            '<circle cx="%.1f" cy="%.1f" r="3" fill="none" stroke="%s"/>' % (x(found), y, COLOURS[0]),
        ]
    out.append(text(WIDTH / 2, height - 8, "error over the size at hand: met (circle), allowed (bar)"))
    return "\n".join(out) + "\n</svg>\n"


def run(build, folder):
    """Runs the tests; {picture: {law: (greatest error met, allowed)}} of what they keep of errors. Files in the folder
    have the rest."""
    errors = {}
    jobs = [
        (p, ":".join(sorted(t for q, t in FIGURES.values() if q == p)), None)
        for p in sorted({p for p, _ in FIGURES.values()})
    ]
    jobs += [(program, tests, name) for name, programs in ERRORS.values() for program, tests in programs.items()]
    for program, tests, name in jobs:
        report = folder / "report.json"
        done = subprocess.run(
            [
                build / "tests" / program,
                "--gtest_filter=" + tests,
                "--gtest_brief=1",
                "--gtest_output=json:%s" % report,
            ],
            cwd=ROOT,
            capture_output=True,
            text=True,
            env=dict(os.environ, INSULA_FIGURES=str(folder)),
        )
        if done.returncode != 0:
            sys.exit("error: the tests of the pictures fail:\n" + done.stdout + done.stderr)
        if name:
            laws = errors.setdefault(name, {})
            for test in (
                t for suite in json.loads(report.read_text(encoding="utf-8"))["testsuites"] for t in suite["testsuite"]
            ):
                for law, kept in test.items():
                    if isinstance(kept, str) and re.fullmatch(r"\S+ of \S+", kept) and law not in ("name", "file"):
                        found, allowed = map(float, kept.split(" of "))
                        laws[law] = (max(found, laws.get(law, (0, 0))[0]), allowed)
    missing = [name for name in FIGURES if not (folder / (name + ".json")).exists()] + [
        name for name, laws in errors.items() if not laws
    ]
    if missing:
        sys.exit("error: no test gave %s" % ", ".join(missing))
    return errors


def unseen(page):
    """Rows of the page's tables of laws, above the real cases, of which no picture shows anything."""
    shown = [t for _, t in FIGURES.values()] + [
        t for _, programs in ERRORS.values() for tests in programs.values() for t in tests.split(":")
    ]
    # The page names a test without the instances of its suite: "Processor/BodySolverContract/*.SolvesAs*".
    patterns = [
        re.compile(re.escape(re.sub(r"^\w+/", "", t).replace("/*.", ".")).replace(r"\*", ".*") + "$") for t in shown
    ]
    section, out = "", []
    for line in page.splitlines():
        if line.startswith("## "):
            section = re.sub(r" \(.*", "", line[3:])
        cells = [c.strip() for c in line.strip().strip("|").split("|")] if line.startswith("|") else []
        if (
            section not in CLOSED_FORMS
            or len(cells) != 3
            or not cells[2]
            or set(cells[0]) <= {"-"}
            or cells[0] == "law"
        ):
            continue
        tests = re.findall(r"`(\w+\.\w+)`", cells[1])
        if not any(p.match(t) for p in patterns for t in tests) and not any(t in NO_PICTURE for t in tests):
            out.append(cells[0] + ": " + ", ".join(tests))
    return out


def differs(a, b, slack):
    """Whether two pictures are more than the last digits of their numbers apart."""
    number = re.compile(r"-?\d+\.?\d*")
    return number.sub("#", a) != number.sub("#", b) or any(
        abs(float(p) - float(q)) > slack for p, q in zip(number.findall(a), number.findall(b))
    )


def main():
    build, check = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:] == ["--check"]
    failures = 0
    with tempfile.TemporaryDirectory() as name:
        errors = run(build, pathlib.Path(name))
        made = {n: svg(json.loads((pathlib.Path(name) / (n + ".json")).read_text(encoding="utf-8"))) for n in FIGURES}
    for section, (name, _) in ERRORS.items():
        made[name] = errors_svg(section + ": errors met by the tests", errors[name])
    page = (ROOT / "docs/validation.md").read_text(encoding="utf-8")
    for row in unseen(page):
        failures += 1
        print("FAILED: no picture shows the law: %s" % row)
    for name, picture in made.items():
        file = OUT / (name + ".svg")
        if "images/validation/%s.svg" % name not in page:
            failures += 1
            print("FAILED: docs/validation.md does not show %s" % file.relative_to(ROOT))
        if not check:
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(picture, encoding="utf-8")
        elif not file.exists() or differs(
            file.read_text(encoding="utf-8"), picture, ROUNDING if name.startswith("errors_") else SLACK
        ):
            failures += 1
            print(
                "FAILED: %s is not what the test gives: python3 tools/manual/figures.py BUILD, and look at it"
                % file.relative_to(ROOT)
            )
    for file in OUT.glob("*.svg"):
        if file.stem not in made:
            failures += 1
            print("FAILED: nothing gives %s" % file.relative_to(ROOT))
    print("%d pictures; %d failures" % (len(made), failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
