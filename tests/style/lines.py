#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""lines.py SOURCE: no line of source text is over 120 columns, none ends in a blank, and none holds a tab.

In Markdown, rows of tables and lines with an address may be longer. In C++, text in a raw literal may be.
"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from sources import tracked  # noqa: E402

COLUMNS = 120
ENDINGS = (".cpp", ".h", ".py", ".cmake", "CMakeLists.txt", ".ts", ".mjs", ".sh", ".lcm", ".md", "/insula", "/run")
LONG_IN_MARKDOWN = re.compile(r"^\s*\||https?://|^!\[|^\s*\[[^]]*\]:")
RAW_LITERAL = re.compile(r'R"([^(\s]{0,16})\(.*?\)\1"', re.S)


def lines_in_raw_literals(text):
    """Numbers of the lines that a raw literal of C++ touches."""
    out = set()
    for found in RAW_LITERAL.finditer(text):
        first = text.count("\n", 0, found.start()) + 1
        out.update(range(first, first + found[0].count("\n") + 1))
    return out


def faults(path, text):
    raw = lines_in_raw_literals(text) if path.suffix in (".cpp", ".h") else set()
    for number, line in enumerate(text.split("\n"), 1):
        may_be_long = number in raw or path.suffix == ".md" and LONG_IN_MARKDOWN.search(line)
        if len(line) > COLUMNS and not may_be_long:
            yield number, "%d columns; %d are allowed" % (len(line), COLUMNS)
        if line.endswith((" ", "\t")) and path.suffix != ".md":
            yield number, "ends in a blank"
        if "\t" in line.lstrip("\t") and path.suffix in (".cpp", ".h", ".py"):
            yield number, "holds a tab"


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    wrong = []
    for path in tracked(source, *ENDINGS):
        for number, fault in faults(path, path.read_text(encoding="utf-8")):
            wrong.append("%s:%d: %s" % (path.relative_to(source).as_posix(), number, fault))
    for fault in wrong[:100]:
        print(fault)
    if len(wrong) > 100:
        print("and %d more" % (len(wrong) - 100))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
