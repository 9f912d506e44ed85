# SPDX-License-Identifier: GPL-3.0-or-later
"""A study file as a tree of checked elements. All that is wrong is kept with its place."""

from __future__ import annotations

import dataclasses
import pathlib
import re
from collections.abc import Callable, Iterator

from insula import _core
from insula.studies.elements import BY_NAME, Attribute


class StudyError(ValueError):
    """A study with errors. All of them are in `problems`."""

    def __init__(self, problems: list[_core.Problem]):
        super().__init__("\n".join(dict.fromkeys(str(p) for p in problems)))
        self.problems = problems


class Problems:
    """Errors of a file so far."""

    def __init__(self, file: str):
        self.file = file
        self.found: list[_core.Problem] = []

    def add(self, place: tuple[int, int], message: str) -> None:
        self.found.append(_core.Problem(message, self.file, *place))

    def end(self) -> None:
        """Raises StudyError if there are any."""
        errors = [p for p in self.found if p.severity == "error"]
        if errors:
            raise StudyError(sorted(errors, key=lambda p: (p.file != self.file, p.line, p.column)))


def did_you_mean(word: str, names: list[str]) -> str:
    near = _core.nearest_name(word, names)
    if near:
        return '; did you mean "%s"?' % near
    return " (there are: %s)" % ", ".join(names[:12]) if names else ""


@dataclasses.dataclass
class Node:
    """An element with the values of its attributes: text, float (s, Hz), int, bool, or None where nothing is given."""

    name: str
    place: tuple[int, int]
    values: dict[str, object]
    places: dict[str, tuple[int, int]]
    children: list[Node]

    def all(self, name: str) -> Iterator[Node]:
        return (c for c in self.children if c.name == name)

    def one(self, name: str) -> Node | None:
        return next(self.all(name), None)

    def text(self, name: str) -> str:
        value = self.values.get(name)
        return "" if value is None else str(value)

    def number(self, name: str) -> float | None:
        value = self.values.get(name)
        return float(value) if isinstance(value, (int, float)) else None

    def whole(self, name: str) -> int:
        value = self.values.get(name)
        return value if isinstance(value, int) else 0

    def at(self, name: str) -> tuple[int, int]:
        return self.places.get(name, self.place)


def _whole(text: str, least: float) -> tuple[object, str]:
    if not re.fullmatch(r"[+-]?\d{1,12}", text):
        return None, '"%s" is not a whole number' % text
    if int(text) < least:
        return None, "%s is too small: at least %d" % (text, least)
    return int(text), ""


def _quantity(read: Callable[[str], tuple[float | None, str]], text: str, least: float) -> tuple[object, str]:
    value, error = read(text)
    if value is not None and value <= least:
        return None, "%s is not above %g" % (text, least)
    return value, error


def _value(a: Attribute, text: str) -> tuple[object, str]:
    """The value, or None and what is wrong."""
    if a.kind == "time":
        return _quantity(_core.read_time, text, a.least)
    if a.kind == "frequency":
        return _quantity(_core.read_frequency, text, a.least)
    if a.kind == "whole":
        return _whole(text, a.least)
    if a.kind == "flag":
        return (text == "true", "") if text in ("true", "false") else (None, '"%s" is neither true nor false' % text)
    if a.kind == "choice" and text not in a.choices:
        return None, '"%s" is none of %s%s' % (text, ", ".join(a.choices), _meant(text, list(a.choices)))
    return (text, "") if text.strip() else (None, "the value is empty")


def _meant(word: str, names: list[str]) -> str:
    near = _core.nearest_name(word, names)
    return '; did you mean "%s"?' % near if near else ""


def _misplaced(name: str, parent: str, here: list[str]) -> str:
    if name in BY_NAME:
        return "<%s> may not stand %s" % (name, "in <%s>" % parent if parent else "at the root, which is <study>")
    near = _core.nearest_name(name, here)
    there = "; did you mean <%s>?" % near if near else " here (there may be: %s)" % ", ".join(here)
    return "unknown element <%s>" % name + there


def _node(raw: tuple, parent: str, problems: Problems) -> Node | None:
    name, line, column, attributes, children = raw
    element = BY_NAME.get(name)
    here = [e.name for e in BY_NAME.values() if (parent in e.parents if parent else not e.parents)]
    if element is None or name not in here:
        problems.add((line, column), _misplaced(name, parent, here))
        return None
    known = {a.name: a for a in element.attributes}
    node = Node(name, (line, column), {}, {}, [])
    for key, text, name_line, name_column, value_line, value_column in attributes:
        if key not in known:
            problems.add((name_line, name_column),
                         '<%s> has no attribute "%s"%s' % (name, key, did_you_mean(key, list(known))))
            continue
        node.places[key] = (value_line, value_column)
        node.values[key], wrong = _value(known[key], text)
        if wrong:
            problems.add(node.places[key], "%s: %s" % (key, wrong))
    for a in element.attributes:
        if a.name in node.places:
            continue
        if a.required:
            problems.add(node.place, '<%s> needs the attribute "%s": %s' % (name, a.name, a.doc))
        node.values[a.name] = _value(a, a.fallback)[0] if a.fallback is not None else None
    node.children = [n for n in (_node(c, name, problems) for c in children) if n]
    for child in node.children:
        if BY_NAME[child.name].once and child is not node.one(child.name):
            problems.add(child.place, "<%s> may stand only once" % child.name)
    return node


def read_tree(file: pathlib.Path, problems: Problems) -> Node | None:
    """The root of the file, or None if it cannot be read."""
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        problems.add((0, 0), "cannot be read: %s" % (getattr(error, "strerror", None) or error))
        return None
    raw, found = _core.read_xml(text, str(file))
    problems.found += found
    return _node(raw, "", problems) if isinstance(raw, tuple) else None
