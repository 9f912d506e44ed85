# SPDX-License-Identifier: GPL-3.0-or-later
"""The elements of a study file: declared once, for reading, messages, and the page of `insula study --elements`."""

from __future__ import annotations

import dataclasses

STATISTICS = ("last", "mean", "smallest", "largest")
BODY_VALUES = ("displacement", "speed", "energy", "stress")


@dataclasses.dataclass(frozen=True)
class Attribute:
    """kind: text, time, frequency, whole, flag, or choice. least: of a whole number, or of a time in s (above it)."""

    name: str
    doc: str
    kind: str = "text"
    fallback: str | None = None  # None: no value; with `required` it must be given
    required: bool = False
    choices: tuple[str, ...] = ()
    least: float = 0


@dataclasses.dataclass(frozen=True)
class Element:
    name: str
    doc: str
    attributes: tuple[Attribute, ...]
    parents: tuple[str, ...] = ("study",)
    once: bool = False


def _id(doc: str) -> Attribute:
    return Attribute("id", doc, required=True)


_STATISTIC = Attribute("statistic", "over the run, from its first step on", "choice", "last", choices=STATISTICS)
_OF = Attribute("of", "ID.PARAMETER of a component, as in heart.systolic")
_VARIABLE = Attribute("variable", "a variable of the scene, in place of `of`")

ELEMENTS = (
    Element("study", "a study: what is swept, and what is measured", (
        Attribute("title", "what plots and reports call it", required=True),), parents=()),
    Element("scene", "a scene; several are swept", (
        Attribute("file", "scene file, relative to the study; or the name of a shipped scene", required=True),)),
    Element("set", "a value in place of what the scene says", (
        _OF, _VARIABLE, Attribute("to", "the value, with its unit", required=True)), parents=("study", "point")),
    Element("vary", "values of a parameter or a variable, or points of several; each is an axis of the study", (
        _OF, _VARIABLE,
        Attribute("name", "of the column, default: the parameter or variable; needed with points"),
        Attribute("values", "the values with commas between them; a unit after the last one counts for all"),
        Attribute("from", "the first of evenly spaced values"),
        Attribute("to", "the last of them, in the same unit"),
        Attribute("count", "how many there are", "whole", least=2),
        Attribute("scale", "spacing of from, to and count", "choice", "linear", choices=("linear", "log")))),
    Element("point", "one place on an axis, at which several values change together", (
        Attribute("value", "its number with unit, or its name, in the column", required=True),), parents=("vary",)),
    Element("motion", "what both hands do; several are swept, and without any both hands rest", (
        Attribute("name", "of a motion of the exercise"),
        Attribute("file", "CSV file of a motion, relative to the study"))),
    Element("random_hands", "both hands move at random, differently for each seed", (
        Attribute("busy", "time of random motion", "time", "3 s", least=0),
        Attribute("rest", "at home at the end", "time", "1.5 s", least=0),
        Attribute("fastest", "highest speed of a stroke, mm/s", "whole", "500", least=20)), once=True),
    Element("seeds", "whole numbers from which complications and random hands are drawn", (
        Attribute("from", "the first", "whole", "1", least=1),
        Attribute("count", "how many", "whole", required=True, least=1)), once=True),
    Element("rate", "steps a second; several are swept, and without any it is the scene's", (
        Attribute("value", "such as 60 Hz", "frequency", required=True),)),
    Element("run", "how long a run is", (
        Attribute("duration", "simulated time, default: the motion and one second more, or 10 s", "time", least=0),
        Attribute("until_end", "end with the exercise", "flag", "false"),
        Attribute("time_limit", "wall time after which a run has failed", "time", "10 min", least=0)), once=True),
    Element("channel", "a channel of the scene", (
        _id("of the channel"), _STATISTIC,
        Attribute("place", "index in a channel of several numbers", "whole", "0", least=0))),
    Element("goal", "whether a goal is reached, and when", (_id("of the goal"),)),
    Element("fault", "how often a fault was made", (_id("of the fault"),)),
    Element("metric", "a metric of the exercise at the end", (
        _id("of the metric"),
        Attribute("hand", "whose it is", "choice", "both", choices=("left", "right", "both")))),
    Element("body", "largest value over the nodes or elements of a body, or its energy", (
        _id("of the body"),
        Attribute("value", "what is measured", "choice", "displacement", choices=BODY_VALUES), _STATISTIC)),
    Element("soundness", "inverted or collapsed elements, depth of contacts, tools away from their hands", (),
            once=True),
    Element("plot", "a picture of the results", (
        Attribute("file", "its name in the folder of results, NAME.svg", required=True),
        Attribute("x", "column of the horizontal axis", required=True),
        Attribute("y", "column of the vertical axis; a histogram has none"),
        Attribute("group", "column that tells the lines apart"),
        Attribute("kind", "points and the line of their means, a histogram of x, or a map over x and group", "choice",
                  "line", choices=("line", "histogram", "map")),
        Attribute("scale", "of both axes", "choice", "linear", choices=("linear", "log")),
        Attribute("label", "of the vertical axis"))),
)
BY_NAME = {e.name: e for e in ELEMENTS}


def page() -> str:
    """All elements as text."""
    lines = []
    for e in ELEMENTS:
        lines += ["<%s>%s  %s" % (e.name, " in <%s>" % "> or <".join(e.parents) if e.parents else "", e.doc)]
        for a in e.attributes:
            said = [", ".join(a.choices)] if a.choices else []
            said += ["required"] if a.required else ["default: %s" % a.fallback] if a.fallback is not None else []
            lines += ["    %-10s  %s%s" % (a.name, a.doc, " (%s)" % "; ".join(said) if said else "")]
    return "\n".join(lines) + "\n"
