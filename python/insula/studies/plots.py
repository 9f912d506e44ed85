# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of results, by matplotlib."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np

from insula.studies.planning import Plan
from insula.studies.running import Row
from insula.studies.study import Plot

NEEDED = "pictures need matplotlib: pip install \"insula[studies]\""


def _pyplot() -> Any:
    try:
        import matplotlib
    except ImportError:
        raise RuntimeError(NEEDED) from None
    matplotlib.use("svg")
    matplotlib.rcParams.update({"svg.hashsalt": "insula", "font.size": 9, "axes.spines.top": False,
                                "axes.spines.right": False})
    from matplotlib import pyplot

    return pyplot


def _named(plan: Plan, column: str) -> str:
    unit = plan.units.get(column, "")
    return column + (", " + unit if unit else "")


def _number(value: object) -> float:
    return float(value) if isinstance(value, (int, float)) else float("nan")


def _order(values: list[object]) -> list[object]:
    """Numbers by size, texts as they come."""
    distinct = list(dict.fromkeys(values))
    return sorted(distinct) if all(isinstance(v, (int, float)) for v in distinct) else distinct  # type: ignore


def _text(value: object) -> str:
    return "%g" % value if isinstance(value, (int, float)) else str(value)


def means(rows: list[Row], x: str, y: str) -> tuple[list[object], list[float], list[int]]:
    """Places of x, mean of y at each, and number of runs with a value."""
    places = _order([r[x] for r in rows if r.get(x) is not None])
    found, counts = [], []
    for place in places:
        values = [_number(r.get(y)) for r in rows if r.get(x) == place]
        values = [v for v in values if not np.isnan(v)]
        found.append(float(np.mean(values)) if values else float("nan"))
        counts.append(len(values))
    return places, found, counts


def _line(axes: Any, plan: Plan, plot: Plot, rows: list[Row]) -> None:
    groups = _order([r.get(plot.group) for r in rows]) if plot.group else [None]
    places = _order([r[plot.x] for r in rows if r.get(plot.x) is not None])
    numeric = all(isinstance(p, (int, float)) for p in places)
    share = all(isinstance(r.get(plot.y), bool) for r in rows if r.get(plot.y) is not None)
    for k, group in enumerate(groups):
        mine = [r for r in rows if not plot.group or r.get(plot.group) == group]
        at, mean, _ = means(mine, plot.x, plot.y)
        label = "%s %s" % (_text(group), plan.units.get(plot.group, "")) if plot.group else None
        xs = [float(p) if numeric else places.index(p) for p in at]  # type: ignore[arg-type]
        (drawn,) = axes.plot(xs, mean, marker="o", markersize=4, color="C%d" % (k % 10), label=label)
        if not share:
            points = [(xs[at.index(r[plot.x])], _number(r.get(plot.y))) for r in mine if r.get(plot.x) in at]
            axes.plot(*np.array(points).T, ".", markersize=3, alpha=0.4, color=drawn.get_color())
    if not numeric:
        axes.set_xticks(range(len(places)), [_text(p) for p in places])
    if share:
        axes.set_ylim(-0.05, 1.05)
    if plot.group:
        axes.legend(title=plot.group, frameon=False)
    axes.set_ylabel(plot.label or ("share with " if share else "") + _named(plan, plot.y))


def _map(figure: Any, axes: Any, plan: Plan, plot: Plot, rows: list[Row]) -> None:
    xs, ys = (_order([r[c] for r in rows if r.get(c) is not None]) for c in (plot.x, plot.group))
    grid = np.full((len(ys), len(xs)), np.nan)
    for j, y in enumerate(ys):
        at, mean, _ = means([r for r in rows if r.get(plot.group) == y], plot.x, plot.y)
        for place, value in zip(at, mean):
            grid[j, xs.index(place)] = value
    share = all(isinstance(r.get(plot.y), bool) for r in rows if r.get(plot.y) is not None)
    ends = {"vmin": 0, "vmax": 1} if share else {}
    picture = axes.imshow(grid, origin="lower", aspect="auto", cmap="viridis", **ends)
    for j, i in np.argwhere(np.isfinite(grid)):
        axes.text(i, j, "%.3g" % grid[j, i], ha="center", va="center", fontsize=7,
                  color="white" if picture.norm(grid[j, i]) < 0.6 else "black")
    axes.set_xticks(range(len(xs)), [_text(x) for x in xs])
    axes.set_yticks(range(len(ys)), [_text(y) for y in ys])
    axes.set_ylabel(_named(plan, plot.group))
    figure.colorbar(picture, label=plot.label or _named(plan, plot.y))


def _histogram(axes: Any, plan: Plan, plot: Plot, rows: list[Row]) -> None:
    values = [_number(r.get(plot.x)) for r in rows]
    axes.hist([v for v in values if not np.isnan(v)], bins=40)
    axes.set_ylabel("runs")


def draw(plan: Plan, rows: list[Row], folder: pathlib.Path) -> list[pathlib.Path]:
    """The pictures that the study asks for, of the runs that are done."""
    done, out = [r for r in rows if r["status"] == "done"], list[pathlib.Path]()
    if not plan.study.plots or not done:
        return out
    pyplot = _pyplot()
    for plot in plan.study.plots:
        figure, axes = pyplot.subplots(figsize=(6, 3.6))
        if plot.kind == "map":
            _map(figure, axes, plan, plot, done)
        elif plot.kind == "histogram":
            _histogram(axes, plan, plot, done)
        else:
            _line(axes, plan, plot, done)
        if plot.scale == "log" and plot.kind != "map":
            axes.set_xscale("log")
            axes.set_yscale("log")
        axes.set_xlabel(_named(plan, plot.x))
        axes.set_title("%s (%d runs)" % (plan.study.title, len(done)), fontsize=9)
        figure.tight_layout()
        file = folder / plot.file
        # No date, so that the same results give the same bytes.
        figure.savefig(file, metadata={"Date": None} if file.suffix == ".svg" else None, dpi=150)
        pyplot.close(figure)
        out.append(file)
    return out
