# SPDX-License-Identifier: GPL-3.0-or-later
"""Insula beside MuJoCo and SOFA: the same mesh, material, load, contact and step, in one sitting on one thread.

Prints ms a step, residual, penetration and drift of the energy, and how many times slower each program is. Programs
whose residuals differ are not compared. docs/peers.md explains what is measured.

Exit status: 0 when each program that is here could be compared in one setting at least, 3 when one could not, 2 for
wrong arguments or when no other program is here.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import os
import sys

os.environ.setdefault("OMP_NUM_THREADS", "1")

import compare  # noqa: E402
import numpy as np  # noqa: E402
from case import lobe  # noqa: E402
from insula_side import InsulaSide  # noqa: E402
from sofa_runs import SofaSide  # noqa: E402

FACTOR, FLOOR = 3.0, 1e-4
AIMS = {"MuJoCo": 5, "SOFA": 10}


def programs(sofa: str | None) -> tuple[list, dict[str, str]]:
    """The programs that are here, Insula first, and why others are not."""
    sides: list = [InsulaSide]
    absent = {}
    try:
        from mujoco_side import MujocoSide

        sides.append(MujocoSide)
    except ImportError as error:
        absent["MuJoCo"] = "MuJoCo is not installed here: pip install mujoco-core (%s)" % error
    why = SofaSide.found(sofa)
    if why:
        absent["SOFA"] = why
    else:
        sides.append(SofaSide)
    return sides, absent


def table(name: str, entries: list, comparisons: list) -> str:
    lines = ["", "%s: %d steps" % (name, entries[0].worth.steps)]
    head = ("program", "setting", "ms a step", "residual moving", "at rest", "penetration", "energy drift",
            "times Insula's")
    rows = [head]
    against = {(c.program, c.setting): c for c in comparisons}
    for e in entries:
        w, c = e.worth, against.get((e.program, e.setting))
        ratio = "" if c is None else "refused" if c.refused else "%.1f (%.1f to %.1f)" % (
            c.ratio, c.ratio_least, c.ratio_most)
        rows.append((e.program, e.setting, "%.2f" % e.median(), "%.1e" % w.residual_moving, "%.1e" % w.residual_rest,
                     "%.3f mm" % w.penetration_mm, "%.1e" % w.energy_drift, ratio))
    widths = [max(len(r[k]) for r in rows) for k in range(len(head))]
    lines += ["  ".join(word.ljust(width) for word, width in zip(row, widths)).rstrip() for row in rows]
    lines += ["  %s %s: not compared, %s" % (c.program, c.setting, c.refused) for c in comparisons if c.refused]
    lines += ["  %s %s: %s" % (e.program, e.setting, e.warnings) for e in entries if e.warnings]
    return "\n".join(lines)


def fastest(comparisons: list, program: str):
    """The comparison with a program's fastest setting that may be compared; None if there is none."""
    fair = [c for c in comparisons if c.program == program and not c.refused]
    return min(fair, key=lambda c: c.ratio, default=None)


def arguments(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="bench/peers/run.sh", description=__doc__.split("\n\n")[0])
    parser.add_argument("--lobe", nargs="+", default=["frontal", "temporal"], metavar="NAME",
                        help="meshes of meshes/lobes (default: frontal temporal)")
    parser.add_argument("--steps", type=int, default=180, help="of a run, at least 30 (default: 180, three seconds)")
    parser.add_argument("--repeats", type=int, default=3, help="turns of all programs (default: 3)")
    parser.add_argument("--factor", type=float, default=FACTOR, help="by which residuals may differ (default: 3)")
    parser.add_argument("--floor", type=float, default=FLOOR, help="residuals below count as equal (default: 1e-4)")
    parser.add_argument("--sofa", metavar="FOLDER", help="where SOFA is installed (default: SOFA_ROOT)")
    parser.add_argument("--json", action="store_true", help="print everything as JSON")
    options = parser.parse_args(words)
    if options.steps < 30 or options.repeats < 1:
        parser.error("at least 30 steps and one repeat")
    if not options.factor >= 1 or not options.floor > 0:
        parser.error("--factor is at least 1, and --floor is above 0")
    return options


def main(words: list[str]) -> int:
    options = arguments(words)
    try:
        cases = [lobe(name, options.steps) for name in options.lobe]
    except ValueError as error:
        print("error: %s" % error, file=sys.stderr)
        return 2
    sides, absent = programs(options.sofa)
    for why in absent.values():
        print(why, file=sys.stderr)
    if len(sides) == 1:
        print("error: no other program is here, so nothing is compared", file=sys.stderr)
        return 2
    data, status = {"versions": {s.program: s.version() for s in sides}, "absent": absent, "aims": AIMS,
                    "factor": options.factor, "floor": options.floor, "lobes": {}}, 0
    for case in cases:
        entries = compare.run_all(sides, case, options.repeats, lambda text: print(text, file=sys.stderr))
        comparisons = compare.compare(entries, options.factor, options.floor)
        best = {s.program: fastest(comparisons, s.program) for s in sides[1:]}
        data["lobes"][case.name] = {
            "nodes": len(case.rest), "held": len(case.held), "elements": len(case.elements), "steps": case.steps,
            "runs": [e.as_data() for e in entries], "comparisons": [dataclasses.asdict(c) for c in comparisons],
            "times_slower": {p: c.ratio if c else None for p, c in best.items()}}
        if not options.json:
            print(table("%s, %d nodes, %d held, %d tetrahedra" % (case.name, len(case.rest), len(case.held),
                                                                  len(case.elements)), entries, comparisons))
        for program, c in best.items():
            if c is None:
                print("error: %s on %s: no setting has Insula's residual, so it is not compared" % (
                    program, case.name), file=sys.stderr)
                status = 3
            elif not options.json:
                print("  %s takes %.1f times as long at equal residual (aim: %d): %s" % (
                    program, c.ratio, AIMS[program], "reached" if c.ratio >= AIMS[program] else "not reached"))
    if options.json:
        print(json.dumps(data, indent=2, default=lambda x: x.item() if isinstance(x, np.generic) else str(x)))
    else:
        print("\nversions: " + ", ".join("%s %s" % item for item in data["versions"].items()))
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
