# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of several programs beside each other, and whether they may be compared."""

from __future__ import annotations

import math
import statistics
from dataclasses import asdict, dataclass, field
from typing import Any

from case import Case
from measure import Judge, Worth

WARM = 5  # first steps of a run, which are not timed


@dataclass
class Entry:
    """A program with one of its settings."""

    program: str
    setting: str
    law: str
    worth: Worth
    warnings: str
    ms: list[float] = field(default_factory=list)  # median of the steps of each repeat

    def median(self) -> float:
        return statistics.median(self.ms)

    def as_data(self) -> dict[str, Any]:
        return {**asdict(self), "ms_median": self.median()}


@dataclass
class Comparison:
    """One entry against Insula's. `refused`: why they may not be compared, empty if they may."""

    program: str
    setting: str
    refused: str
    ratio: float | None = None  # its time over Insula's: median over the repeats
    ratio_least: float | None = None
    ratio_most: float | None = None


def run(side_class, case: Case, setting: str, judged: bool) -> tuple[float, Worth | None, str, str]:
    """One run: median ms a step, its worth if it is judged, warnings of the program, name of its law."""
    side = side_class(case, setting)
    judge = Judge(case, side.law) if judged else None
    times = []
    for _ in range(case.steps):
        taken, state = side.step()
        times.append(taken)
        if judge:
            judge.see(state)
    return 1e3 * statistics.median(times[WARM:]), judge.worth() if judge else None, side.warnings(), side.law.name


def run_all(sides, case: Case, repeats: int, say) -> list[Entry]:
    """Every program with each of its settings, in turns: all of them once, then all of them again. Only the first turn
    is judged, since every program here gives the same bits again."""
    entries: list[Entry] = []
    for turn in range(repeats):
        at = 0
        for side in sides:
            for setting in side.settings:
                say("%s, turn %d of %d: %s %s" % (case.name, turn + 1, repeats, side.program, setting))
                ms, worth, warnings, law = run(side, case, setting, turn == 0)
                if worth is not None:
                    entries.append(Entry(side.program, setting, law, worth, warnings))
                entries[at].ms.append(ms)
                at += 1
    return entries


def unequal(a: Worth, b: Worth, factor: float, floor: float) -> str:
    """Why two runs may not be compared. Residuals below the floor count as equal to it."""
    for name, what in (("residual_moving", "while the tissue moves"), ("residual_rest", "at rest")):
        if not (math.isfinite(getattr(a, name)) and math.isfinite(getattr(b, name))):
            return "a residual %s is no number" % what
        x, y = max(getattr(a, name), floor), max(getattr(b, name), floor)
        if max(x, y) > factor * min(x, y):
            return "residuals %s differ by a factor of %.1f (%.1e and %.1e); at most %g is allowed" % (
                what, max(x, y) / min(x, y), getattr(a, name), getattr(b, name), factor)
    return ""


def compare(entries: list[Entry], factor: float, floor: float) -> list[Comparison]:
    """Every other entry against the first one, which is Insula's."""
    ours, out = entries[0], []
    for other in entries[1:]:
        refused = unequal(ours.worth, other.worth, factor, floor)
        if refused:
            out.append(Comparison(other.program, other.setting, refused))
            continue
        ratios = [b / a for a, b in zip(ours.ms, other.ms)]
        out.append(Comparison(other.program, other.setting, "", statistics.median(ratios), min(ratios), max(ratios)))
    return out
