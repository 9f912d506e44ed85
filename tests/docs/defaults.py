# SPDX-License-Identifier: GPL-3.0-or-later
"""Defaults that the manual states, against what declares them: parameters of elements, options of programs, members of
C++ headers.

A page states a default where a sentence or a row of a table has a number beside the word "default", such as
    `alarm` (default 1 mm)      the default of `alarm` is 1 mm      `alarm` is 1 mm by default
or a choice: `contact_geometry="triangles"` (default). The name is the last one in a code span before the number, else
the first one behind it. Where the same text names an element (`<contact>`), its parameter is meant. Otherwise any
declaration of that name may agree.
"""
import math
import pathlib
import re
import subprocess
import tempfile

ROW = re.compile(r"^\| `(\w+)` \| [^|]* \| ([^|]*) \|", re.M)
OPTION = re.compile(r"^\s+(?:-\w,)?--([\w-]+) [A-Z]+\S*(?: in \[[^\]]*\])?(?:=| \[)([^\s\]]+)", re.M)
MEMBER = re.compile(r"\b(?:double|float|int|std::u?int\d+_t) (\w+) = (-?[\d.']+(?:e-?\d+)?);")
# What the end of a C++ name says of its unit.
SUFFIXES = {
    "_N_s": "N/s",
    "_m_s": "m/s",
    "_rad_s": "rad/s",
    "_ms": "ms",
    "_us": "us",
    "_mm": "mm",
    "_rad": "rad",
    "_Hz": "Hz",
    "_m": "m",
    "_s": "s",
    "_N": "N",
}
NUMBER = r"-?\d[\d,]*(?:\.\d+)?(?:e-?\d+)?"
WORDS = {"million": 1e6}
BEHIND = r",? (?:which is |is )?the default\b|,? by default\b|\s*\(default\)"  # what makes what is before it a default
SPAN = re.compile(r"`([^`]+)`")


def units_of(source):
    """{symbol: factor to SI}, as core/params/quantity.cpp declares them."""
    text = (source / "core/params/quantity.cpp").read_text(encoding="utf-8")
    out = {"rad/s": 1.0}
    for symbol, factor in re.findall(r'\{"([^"]+)", ([^},]+)', text):
        value = 1.0
        for sign, term in re.findall(r"(^|[*/])\s*([^*/]+)", factor):
            number = math.pi if term.strip() == "std::numbers::pi" else float(term)
            value = value / number if sign == "/" else value * number
        out[symbol] = value
    return out


def either(defaults):
    return " or ".join(sorted(set(defaults)))


class Declared:
    """Every declared default: name -> [(element or "", text)]."""

    def __init__(self, source, insula, haptic_server=None):
        self.units = units_of(source)
        symbols = sorted(self.units, key=len, reverse=True)
        units = "|".join(re.escape(s) for s in symbols)
        self.value = r"`?(%s)(?:\s*(million))?(?:\s*(%s)(?![\w/]))?`?" % (NUMBER, units)
        self.forms = [
            re.compile(f, re.I)
            for f in (
                r"\bdefaults?(?: value)?(?: of (?:it )?(?:is|are)| is| are| of|:|,)?\s+" + self.value,
                r"\bdefault of [^.;|]{1,60}? is " + self.value,
                self.value + r"(?:%s|,? unless said otherwise)" % BEHIND,
            )
        ]
        self.choice = re.compile(
            r"`(\w+)=\"([^\"]+)\"`(?:" + BEHIND + r")" r"|\bdefault,? `(\w+)=\"([^\"]+)\"`|`([a-z]\w*)` \(default\)"
        )
        self.parameters, self.others = {}, {}
        self.read_elements(insula)
        for program in filter(None, (insula, haptic_server)):
            self.read_options(program)
        for folder in ("core", "haptic_server", "engine"):
            for file in sorted((source / folder).rglob("*.h")):
                for name, value in MEMBER.findall(file.read_text(encoding="utf-8")):
                    unit = next((u for s, u in SUFFIXES.items() if name.endswith(s)), "")
                    self.others.setdefault(name, []).append((value.replace("'", "") + " " + unit).strip())

    def read_elements(self, insula):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([insula, "docs", folder], check=True, capture_output=True)
            for page in pathlib.Path(folder).glob("*.md"):
                for name, default in ROW.findall(page.read_text(encoding="utf-8")):
                    text = default.strip().strip("`*")
                    self.parameters.setdefault(name, {})[page.stem] = text
        if not self.parameters:
            raise ValueError("insula docs lists no parameters")
        self.elements = {e for found in self.parameters.values() for e in found}

    def read_options(self, program):
        helps = [subprocess.run([program, "--help"], capture_output=True, text=True).stdout]
        listed = helps[0].partition("Subcommands:")[2]
        commands = re.findall(r"^  ([a-z-]+)\s", listed, re.M)
        helps += [subprocess.run([program, c, "--help"], capture_output=True, text=True).stdout for c in commands]
        for text in helps:
            for name, value in OPTION.findall(text):
                self.others.setdefault("--" + name, []).append(value)

    # --- claims -------------------------------------------------------------------------------------------------------
    def name_in(self, span):
        """The declared name that a code span is about, or None."""
        word = re.sub(r"^<\w+ |[=:].*$|/?>$", "", span).split("::")[-1].split(".")[-1].strip()
        return word if word in self.parameters or word in self.others else None

    def subject(self, text, begin, end):
        spans = [(m.start(), self.name_in(m[1])) for m in SPAN.finditer(text) if not m[1][0].isdigit()]
        named = [(at, name) for at, name in spans if name]
        before = [name for at, name in named if at < begin]
        behind = [name for at, name in named if at >= end]
        return before[-1] if before else behind[0] if behind else None

    def declared(self, name, text):
        """What may stand there: the defaults of that name, of the element that the text names if it does."""
        found = self.parameters.get(name, {})
        named = [e for e in re.findall(r"`<?(\w+)[^`]*`", text) if e in found]
        return [found[e] for e in named] or list(found.values()) + self.others.get(name, [])

    def si(self, number, unit):
        return float(number.replace(",", "")) * (self.units[unit] if unit else 1.0)

    def agrees(self, number, word, unit, default, option):
        m = re.fullmatch(r"(%s)(?:\s*(\D.*))?" % NUMBER, default)
        if not m or (m[2] and m[2] not in self.units):
            return False
        a, b = self.si(number, unit) * WORDS.get(word, 1.0), self.si(m[1], m[2])
        same_kind = bool(unit) == bool(m[2]) or a == b == 0 or option
        return same_kind and math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-300)

    def check(self, text):
        """(number of claims, [what is wrong]) of one sentence or row of a page."""
        claims, wrong, taken = 0, [], set()
        for form in self.forms:
            for m in form.finditer(text):
                if m.start(1) in taken:
                    continue
                taken.add(m.start(1))
                claims += 1
                name = self.subject(text, m.start(1), m.end(1))
                if not name:
                    wrong.append("\"%s\": no declared name stands beside this default" % m[0])
                    continue
                defaults = self.declared(name, text)
                if not any(self.agrees(m[1], m[2], m[3], d, name.startswith("--")) for d in defaults):
                    wrong.append("\"%s\": the default of `%s` is %s" % (m[0], name, either(defaults)))
        for m in self.choice.finditer(text):
            name = m[1] or m[3] or self.subject(text, m.start(), len(text))
            value = m[2] or m[4] or m[5]
            if m.start() in taken or name not in self.parameters or re.match(NUMBER, value):
                continue
            claims += 1
            if value not in self.declared(name, text):
                wrong.append("`%s=\"%s\"`: the default is %s" % (name, value, either(self.declared(name, text))))
        return claims, wrong


def texts(outside):
    """[(line number, text)]: sentences of paragraphs and rows of tables, with their code spans."""
    out, number, text = [], 0, ""

    def close():
        nonlocal text
        out.extend((number, s) for s in re.split(r"(?<=[.!?])\s+(?=[A-Z`*\[])", text) if s)
        text = ""

    for at, line in outside:
        if re.match(r"\s*\|", line):
            close()
            out.append((at, line))
        elif not line.strip() or re.match(r"\s*([-*+]|\d+[.)]) |#", line):
            close()
            number, text = at, line
            if line.startswith("#"):
                close()
        else:
            number = number if text else at
            text = (text + " " + line.strip()).strip()
    close()
    return out
