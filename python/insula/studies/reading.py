# SPDX-License-Identifier: GPL-3.0-or-later
"""From a study file to a Study. Scenes are not opened here."""

from __future__ import annotations

import os
import pathlib
import re

from insula import shipped
from insula.studies.study import Axis, Change, Measure, Motion, Plot, Point, RandomHands, Study
from insula.studies.tree import Node, Problems, read_tree

NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")
MOST_RUNS = 1_000_000


def number_and_unit(text: str) -> tuple[float, str] | None:
    """Of "1.5 MPa"; None for anything else, such as three numbers or a name."""
    found = NUMBER.fullmatch(text)
    if not found or re.match(r"[\d.+,]|-", found[2]):
        return None
    return float(found[1]), found[2]


def written(value: float, unit: str) -> str:
    return ("%.9g %s" % (value, unit)).strip()


def _target(node: Node, problems: Problems) -> tuple[str, str]:
    """Component (empty: a variable) and name that an element sets."""
    of, variable = node.text("of"), node.text("variable")
    if bool(of) == bool(variable):
        problems.add(node.place, '<%s> needs either "of" or "variable"' % node.name)
        return "", ""
    if variable:
        return "", variable.removeprefix("$")
    component, _, name = of.rpartition(".")
    if not component or not name:
        problems.add(node.at("of"), 'of: "%s" names no parameter: write ID.PARAMETER, as in heart.systolic' % of)
    return component, name


def _change(node: Node, problems: Problems) -> Change:
    return Change(*_target(node, problems), node.text("to"), node.at("to"))


def _texts(node: Node, problems: Problems) -> list[str]:
    """The values of an axis, each with its unit."""
    spaced = [n for n in ("from", "to", "count") if n in node.places]
    if node.values.get("values") is not None:
        if spaced:
            problems.add(node.at(spaced[0]), '"%s" may not stand beside "values"' % spaced[0])
        texts = [t.strip() for t in node.text("values").split(",")]
        last = number_and_unit(texts[-1])
        if last and last[1]:  # its unit counts for all
            bare = [number_and_unit(t) for t in texts]
            texts = [t if b is None or b[1] else "%s %s" % (t, last[1]) for t, b in zip(texts, bare)]
        if "" in texts:
            problems.add(node.at("values"), "values: there is nothing between two commas")
        return texts
    if len(spaced) < 3:
        problems.add(node.place, '<vary> needs "values", or "from", "to" and "count", or points')
        return []
    ends = [number_and_unit(node.text(n)) for n in ("from", "to")]
    for name, end in zip(("from", "to"), ends):
        if end is None:
            problems.add(node.at(name), '%s: "%s" is not a number with a unit' % (name, node.text(name)))
    a, b = ends
    if a is None or b is None:
        return []
    if a[1] != b[1]:
        problems.add(node.at("to"), 'to: "%s" has another unit than from, "%s"' % (b[1], a[1]))
    count, logarithmic = node.whole("count"), node.text("scale") == "log"
    if logarithmic and not (a[0] > 0 and b[0] > 0):
        problems.add(node.at("scale"), "scale: only positive numbers can be spaced so")
        return []
    if count < 2:
        return []
    parts = [k / (count - 1) for k in range(count)]
    numbers = [a[0] * (b[0] / a[0]) ** p if logarithmic else a[0] + (b[0] - a[0]) * p for p in parts]
    return [written(n, a[1]) for n in numbers]


def _axis(node: Node, problems: Problems) -> Axis | None:
    nodes = list(node.all("point"))
    if nodes:
        for name in ("of", "variable", "values", "from", "to", "count"):
            if name in node.places:
                problems.add(node.at(name), '"%s" may not stand beside points' % name)
        if not node.text("name"):
            problems.add(node.place, '<vary> with points needs a "name"')
        for n in nodes:
            if not n.children:
                problems.add(n.place, "<point> sets nothing: it needs a <set>")
        texts = [n.text("value") for n in nodes]
        changes = [tuple(_change(s, problems) for s in n.all("set")) for n in nodes]
        places = [n.at("value") for n in nodes]
        name = node.text("name")
    else:
        component, parameter = _target(node, problems)
        texts = _texts(node, problems)
        at = node.at("values") if "values" in node.places else node.at("from")
        changes = [(Change(component, parameter, t, at),) for t in texts]
        places = [at] * len(texts)
        name = node.text("name") or (node.text("of") or node.text("variable").removeprefix("$"))
    for k, t in enumerate(texts):
        if t in texts[:k]:
            problems.add(places[k], '"%s" is there twice' % t)
    if not texts:
        return None
    read = [number_and_unit(t) for t in texts]
    numbers = [r for r in read if r is not None]
    if len(numbers) == len(texts) and len({unit for _, unit in numbers}) == 1:
        points = tuple(Point(n, c) for (n, _), c in zip(numbers, changes))
        return Axis(name, numbers[0][1], points, node.place)
    return Axis(name, "", tuple(Point(t, c) for t, c in zip(texts, changes)), node.place)


def _scene(node: Node, folder: pathlib.Path, problems: Problems) -> pathlib.Path:
    name = node.text("file")
    try:
        found = shipped.find(name)
    except FileNotFoundError as error:
        problems.add(node.at("file"), "file: %s" % error)
        return pathlib.Path(name)
    if found.is_absolute() and not pathlib.Path(name).suffix:
        return found
    # As it is written, so that messages name it as its author does.
    return pathlib.Path(os.path.normpath(folder / name))


def _motion(node: Node, folder: pathlib.Path, problems: Problems) -> Motion:
    name, file = node.text("name"), node.text("file")
    if bool(name) == bool(file):
        problems.add(node.place, '<motion> needs either "name" or "file"')
    if file and not (folder / file).is_file():
        problems.add(node.at("file"), 'file: "%s" does not exist' % file)
    return Motion("file", str(folder / file), node.at("file")) if file else Motion("name", name, node.at("name"))


def _measure(node: Node) -> Measure:
    return Measure(node.name, node.text("id"), node.text("statistic") or "last", node.text("hand") or "both",
                   node.text("value"), node.whole("place"), node.at("id"))


def _plot(node: Node, problems: Problems) -> Plot:
    file = node.text("file")
    if file and (os.path.basename(file) != file or not file.endswith((".svg", ".png", ".pdf"))):
        problems.add(node.at("file"), 'file: "%s" must be a plain name that ends in .svg, .png or .pdf' % file)
    texts = {n: node.text(n) for n in ("x", "y", "group", "kind", "scale", "label")}
    if (texts["kind"] == "histogram") == bool(texts["y"]):
        problems.add(node.place, '<plot> needs "y", except for a histogram, which counts x alone')
    if texts["kind"] == "map" and not texts["group"]:
        problems.add(node.place, 'a map needs "group", the column of its vertical axis')
    return Plot(file=file, **texts, places=tuple((n, node.at(n)) for n in ("file", "x", "y", "group")))


def _twice(names: list[tuple[str, tuple[int, int]]], what: str, problems: Problems) -> None:
    seen = set()
    for name, place in names:
        if name in seen:
            problems.add(place, '%s "%s" is there twice' % (what, name))
        seen.add(name)


def read(file: str | os.PathLike[str]) -> tuple[Study | None, Problems]:
    """The study of a file, None if it is too broken to go on, and all that is wrong so far."""
    path = pathlib.Path(file)
    problems = Problems(str(path))
    root = read_tree(path, problems)
    if root is None:
        return None, problems
    folder = path.parent
    run, seeds, hands = root.one("run"), root.one("seeds"), root.one("random_hands")
    motions = tuple(_motion(n, folder, problems) for n in root.all("motion"))
    kinds = ("channel", "goal", "fault", "metric", "body", "soundness")
    study = Study(
        file=path,
        title=root.text("title"),
        scenes=tuple(_scene(n, folder, problems) for n in root.all("scene")),
        scene_places=tuple(n.at("file") for n in root.all("scene")),
        changes=tuple(_change(n, problems) for n in root.all("set")),
        axes=tuple(a for a in (_axis(n, problems) for n in root.all("vary")) if a),
        motions=motions or (Motion("none", "none"),),
        hands=RandomHands(hands.number("busy") or 3.0, hands.number("rest") or 1.5, hands.whole("fastest") / 1000)
        if hands else None,
        seeds=tuple(range(seeds.whole("from"), seeds.whole("from") + seeds.whole("count"))) if seeds else (0,),
        rates=tuple(n.number("value") or 0.0 for n in root.all("rate")) or (0.0,),
        duration=run.number("duration") if run else None,
        until_end=bool(run.values["until_end"]) if run else False,
        time_limit=(run.number("time_limit") if run else None) or 600.0,
        measures=tuple(_measure(n) for n in root.children if n.name in kinds),
        plots=tuple(_plot(n, problems) for n in root.all("plot")),
    )
    if not study.scenes:
        problems.add(root.place, "<study> needs a <scene>")
    if hands and motions:
        problems.add(hands.place, "<random_hands> may not stand beside <motion>")
    if hands and not seeds:
        problems.add(hands.place, "<random_hands> needs <seeds>: each seed is another motion")
    _twice([(a.name, a.place) for a in study.axes], "the axis", problems)
    _twice([(m.column, m.place) for m in study.measures], "the measure", problems)
    _twice([(p.file, p.places[0][1]) for p in study.plots], "the plot", problems)
    runs = len(study.scenes) * len(study.motions) * len(study.rates) * len(study.seeds)
    for a in study.axes:
        runs *= len(a.points)
    if runs > MOST_RUNS:
        problems.add(root.place, "the study has %d runs; at most %d are possible" % (runs, MOST_RUNS))
    return study, problems
