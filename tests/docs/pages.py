# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the manual's Markdown: fenced blocks with the comment that may stand before each, and text outside of them.

A comment in the line before a fence says what the block is:
    <!-- file: PATH -->       the file PATH of a project, which must be right
    <!-- bad: PATH -->        the same, with mistakes on purpose
    <!-- output: COMMAND -->  exactly what COMMAND prints
    <!-- in: PATH -->         a part of something: stands in the project's file PATH where that says @SNIPPET@
    <!-- lines of: PATH -->   each line stands in the file PATH, which the commands above it have written
"""
import dataclasses
import re

FENCE = re.compile(r"^(\s*)```(\S*)\s*$")
MARK = re.compile(r"^\s*<!-- (file|bad|output|in|lines of): (.+?) -->\s*$")


@dataclasses.dataclass
class Block:
    line: int  # of the fence
    language: str
    text: str
    role: str = ""  # file, bad, output, in, lines of, or nothing
    value: str = ""


def read(path):
    """(blocks, [(line number, text) of the lines outside of blocks]) of a page."""
    blocks, outside, block, mark = [], [], None, None
    for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
        fence = FENCE.match(line)
        if block is None and fence:
            block = Block(number, fence[2], "", *(mark or ("", "")))
        elif block is not None and fence:
            blocks.append(block)
            block = mark = None
        elif block is not None:
            block.text += line + "\n"
        else:
            found = MARK.match(line)
            mark = found.groups() if found else mark if not line.strip() else None
            outside.append((number, line))
    if block is not None:
        raise ValueError("%s:%d: the block is not closed" % (path, block.line))
    return blocks, outside


def commands(block):
    """[(line number, command)] of a block of sh: lines that go on are joined, comments left out."""
    out, begun = [], None
    for number, line in enumerate(block.text.split("\n"), block.line + 1):
        text = re.sub(r"(^|\s)#.*$", "", line).rstrip()
        if begun is not None:
            begun = (begun[0], begun[1] + " " + text.strip())
        elif text.strip():
            begun = (number, text.strip())
        if begun is not None and begun[1].endswith("\\"):
            begun = (begun[0], begun[1][:-1].rstrip())
        elif begun is not None:
            out.append(begun)
            begun = None
    return out


def all_pages(source):
    """The pages in the order in which they are read: the front page first, the notes last."""
    return (
        [source / "README.md"] + sorted((source / "docs").glob("*.md")) + sorted((source / "docs/notes").glob("*.md"))
    )
