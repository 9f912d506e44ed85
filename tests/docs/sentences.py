#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the words of the manual's sentences, and fails where they are too long.

    sentences.py [--json] [--headers] [--long] [PATH...]

The pages are README.md, CONTRIBUTING.md, all of docs/, and each README.md below scenes/ and meshes/. With --headers the
comments of C++ sources and message types are counted too, an entry for each file. PATH limits the count to files and
folders; with it, --headers counts the sources under those paths.

A page's mean may be at most 20 words a sentence, and no sentence may have more than 40. The mean of a source counts
from five sentences on. The exit status is 1 above a limit. --json prints {page: {"sentences", "mean", "max",
"longest"}}; "longest" is the text of the longest sentence. --long lists every sentence above the limit.

What counts as a sentence:
  - A paragraph, a list item and a quotation are split at full stops, question marks and exclamation marks. A colon that
    ends one ends its last sentence.
  - A code span counts as one word, and a link counts as its text. A word has at least one letter or digit.
  - Code blocks, formulas (indented by four spaces or more, in comments by two), headings, images and HTML comments do
    not count.
  - A table's cells do not count for the mean, since they are notes. No cell may hold a sentence above the limit.
"""
import argparse
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import pages  # noqa: E402

LARGEST_MEAN = 20.0
LONGEST = 40
FEW = 5  # a source with fewer sentences has no mean to speak of
SOURCES = ("core", "plugins", "haptic_server", "engine", "lcm_types", "platform", "viewer/gateway", "tools", "tests")
SUFFIXES = (".h", ".cpp", ".lcm")
ITEM = re.compile(r"^\s*([-*+]|\d+[.)])\s+")
# A full stop after these does not end a sentence.
ABBREVIATION = re.compile(r"\b(?:e\.g|i\.e|et al|vs|cf|approx|resp|eqs?|figs?|pp|sec)\.$", re.I)
# What a sentence begins with: a capital, a digit, a code span or a name of code.
BEGIN = re.compile(r"[\W_]*[A-Z0-9]|code\b|[a-z]\w*(?:\(\)|_\w)")
END = re.compile(r"[.!?][)\"'*_]*(?=\s)")


def plain(text):
    """Markdown as it is read aloud: a code span is one word, a link is its text."""
    text = re.sub(r"<!--.*?-->", " ", text, flags=re.S)
    text = re.sub(r"(`+)[^`]+?\1", " code ", text)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", " ", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"\s+", " ", text.replace("**", "")).strip()


def sentences(text):
    """[(words, text)] of a paragraph."""
    out, begin = [], 0
    shown = plain(text)
    for end in [m.end() for m in END.finditer(shown)] + [len(shown)]:
        sentence = shown[begin:end].strip()
        following = shown[end:].lstrip()
        abbreviated = ABBREVIATION.search(sentence.rstrip(")\"'*_"))
        if following and (abbreviated or not BEGIN.match(following)):
            continue
        words = sum(1 for w in sentence.split() if re.search(r"\w", w))
        if words:
            out.append((words, sentence))
        begin = end
    return out


def paragraphs(lines):
    """(paragraphs, cells) of Markdown without its fenced blocks."""
    out, cells, text, in_list = [], [], [], False

    def close():
        nonlocal text
        if text:
            out.append(" ".join(text))
        text = []

    for line in lines:
        if not line.strip():
            close()
        elif re.match(r"\s*\|", line):
            close()
            if not re.fullmatch(r"[\s|:\-]+", line):
                cells += [c for c in re.split(r"(?<!\\)\|", line.strip().strip("|"))]
        elif re.match(r"#{1,6}\s", line):
            close()
            in_list = False
        elif ITEM.match(line) and (in_list or len(line) - len(line.lstrip()) < 4):
            close()
            in_list = True
            text = [ITEM.sub("", line)]
        elif re.match(r"(    |\t)", line) and not (in_list and text):
            close()
        elif re.match(r"[-=]{3,}\s*$", line):
            close()
        else:
            in_list = in_list and (line[0] == " " or bool(text))  # a list ends at an unindented paragraph
            text.append(re.sub(r"^\s*>\s?", "", line))
    close()
    return out, cells


def of_page(path):
    # A comment that runs over several lines is blanked as a whole, so that its lines are not read as text.
    text = "\n".join(line for _, line in pages.read(path)[1])
    text = re.sub(r"<!--.*?-->", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
    return paragraphs(text.split("\n"))


def comments(path):
    """The comments of a C++ file or a message type as Markdown lines."""
    out, block, code = [], False, False
    for line in path.read_text(encoding="utf-8", errors="replace").split("\n"):
        if block:
            begin, end = line, "*/" in line
            out.append(re.sub(r"\*/.*", "", begin))
            block = not end
            continue
        comment = re.match(r"\s*//[/!]?<?\s?(.*)$", line)
        if comment:
            if "SPDX-License-Identifier" not in line:
                out.append(re.sub(r"^[-=/*]{3,}|[-=/*]{3,}$", "", comment[1]))
        elif re.match(r"\s*/\*", line):
            out.append(re.sub(r"^\s*/\*+!?|\*/.*", "", line))
            block = "*/" not in line
        else:
            trailing = re.search(r"[;,{})]\s*//[/!]?<?\s?(.*)$", line)
            if trailing and code and out and re.match(r"\s{20,}//", line):
                out.append(trailing[1])
            else:
                out += ["", trailing[1]] if trailing else [""]
        code = not comment
    # A comment beside code that continues in the next lines keeps its paragraph. Fences in comments are left out.
    kept, fence = [], False
    for line in out:
        if re.match(r"\s*```", line):
            fence = not fence
        elif not fence:
            kept.append(re.sub(r"^ {2,3}(?=\S)", "    ", line))  # comments indent their formulas by less than pages do
    return paragraphs(kept)


def measure(paragraph_texts, cell_texts):
    counted = [s for text in paragraph_texts for s in sentences(text)]
    in_cells = [s for text in cell_texts for s in sentences(text)]
    longest = max(counted + [s for s in in_cells if s[0] > LONGEST], default=(0, ""))
    words = sum(n for n, _ in counted)
    counts = {"sentences": len(counted), "mean": round(words / len(counted), 1) if counted else 0.0}
    counts.update({"max": longest[0], "longest": longest[1]})
    return counts, [s for s in counted + in_cells if s[0] > LONGEST]


def files_of(source, paths, headers):
    """[(path, its reader)]"""
    wanted = [(source / p).resolve() for p in paths]

    def taken(file):
        return not wanted or any(file == w or w in file.parents for w in wanted)

    markdown = [source / "README.md", source / "CONTRIBUTING.md"] + sorted((source / "docs").rglob("*.md"))
    markdown += [p for folder in ("meshes", "scenes") for p in sorted((source / folder).rglob("README.md"))]
    out = [(p, of_page) for p in markdown if p.exists() and taken(p)]
    for folder in SOURCES if headers else ():
        found = sorted(p for p in (source / folder).rglob("*") if p.suffix in SUFFIXES)
        out += [(p, comments) for p in found if taken(p)]
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--json", action="store_true", help="print the counts of every page as JSON")
    parser.add_argument("--headers", action="store_true", help="count the comments of C++ sources too")
    parser.add_argument("--long", action="store_true", help="list every sentence above the limit")
    parser.add_argument("--source", default=pathlib.Path(__file__).resolve().parents[2], type=pathlib.Path,
                        help="the project's folder")
    parser.add_argument("paths", nargs="*", metavar="PATH", help="files and folders of the project")
    options = parser.parse_args()
    source = options.source.resolve()
    result, failures = {}, []
    for path, read in files_of(source, options.paths, options.headers):
        name = str(path.relative_to(source))
        counts, long = measure(*read(path))
        if not counts["sentences"] and not long:
            continue
        result[name] = counts
        if counts["mean"] > LARGEST_MEAN and (read is of_page or counts["sentences"] >= FEW):
            failures.append("%s: %.1f words a sentence on average; at most %.0f" % (name, counts["mean"], LARGEST_MEAN))
        for words, text in sorted(long, reverse=True)[:None if options.long else 1]:
            failures.append("%s: %d words in a sentence; at most %d: %s" % (name, words, LONGEST, text))
    if not result:
        sys.exit("error: no sentence was found; are these paths of the project?")
    if options.json:
        print(json.dumps(result, indent=1))
    for failure in failures:
        print("FAILED: " + failure, file=sys.stderr)
    if not options.json:
        total = sum(c["sentences"] for c in result.values())
        print("%d pages, %d sentences; %d failures" % (len(result), total, len(failures)))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
