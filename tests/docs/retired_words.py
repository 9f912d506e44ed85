#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Retired words stay retired: no word of retired_words.txt stands in code, scenes or manual, and no former parameter.

    retired_words.py SOURCE_FOLDER
"""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
FOLDERS = "cmake core docs engine examples haptic_server lcm_types plugins scenes tests tools viewer".split()
ENDINGS = set(".h .cpp .in .lcm .ts .mjs .js .py .cmake .txt .sh .xml .md .expected .json".split())
SKIPPED = {"node_modules", "dist", "build", "notes", "__pycache__"}
FORMERLY = re.compile(r'\.formerly = "(\w+)"')
DECLARED = re.compile(r'\.name = "(\w+)"')


def words(file):
    """The rows of retired_words.txt: kind, retired word, new word, anchor of the glossary."""
    rows = []
    for line in file.read_text(encoding="utf-8").split("\n"):
        if line and not line.startswith("#"):
            row = [cell.strip() for cell in line.split("|")]
            assert len(row) == 4 and row[0] in ("token", "phrase"), "retired_words.txt: " + line
            rows.append(row)
    return rows


def files(source):
    for folder in FOLDERS:
        for file in sorted((source / folder).rglob("*")):
            if SKIPPED.isdisjoint(file.parts) and file.suffix in ENDINGS and file.is_file():
                if not file.name.startswith("retired_"):
                    yield file
    yield source / "README.md"


def former_parameters(texts):
    """Former names of parameters that no element uses today."""
    code = [text for file, text in texts if file.suffix in (".h", ".cpp") and not file.name.endswith("_test.cpp")]
    former = {name for text in code for name in FORMERLY.findall(text)}
    return former - {name for text in code for name in DECLARED.findall(text)}


class Search:
    def __init__(self, rows, former):
        def any_of(kind):
            return "|".join(re.escape(row[1]) for row in rows if row[0] == kind)
        self.new = {row[1].lower(): row[2] for row in rows}
        self.token = re.compile(r"(?<![\w-])(%s)(?!\w)" % any_of("token"))
        self.phrase = re.compile(r"(?<![\w-])(%s)(?![\w-])" % any_of("phrase"), re.I)
        names = "|".join(sorted(former)) or "(?!)"
        self.attribute = re.compile(r'(?<![\w.])(%s)(?==\\?")|(?<=`)(%s)(?=`)' % (names, names))

    def in_line(self, line, ending):
        line = FORMERLY.sub("", line)
        found = [m.group(0) for m in self.token.finditer(line)]
        if ending not in (".json", ".expected", ".mjs"):
            found += [m.group(0) for m in self.phrase.finditer(line)]
        if ending in (".md", ".xml"):
            found += [m.group(0) for m in self.attribute.finditer(line)]
        return found


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    rows = words(HERE / "retired_words.txt")
    texts = [(f, f.read_text(encoding="utf-8", errors="replace")) for f in files(source)]
    former = former_parameters(texts)
    search = Search(rows, former)
    failures = []
    # What is looked for is found where it stands.
    for kind, old, _, _ in rows:
        if old not in search.in_line("// see %s here" % old, ".md" if kind == "phrase" else ".cpp"):
            failures.append("%s is not found where it stands" % old)
    for name in former:
        if name not in search.in_line('<contact %s="1"/>' % name, ".xml"):
            failures.append("parameter %s is not found where it stands" % name)
    # Every new word that has an entry in the glossary has it.
    glossary = (source / "docs/glossary.md").read_text(encoding="utf-8")
    anchors = set(re.findall(r'<a id="([\w-]+)"></a>', glossary))
    for _, old, new, anchor in rows:
        if anchor not in anchors | {"-"}:
            failures.append("%s -> %s: the glossary has no anchor %s" % (old, new, anchor))
    for file, text in texts:
        for number, line in enumerate(text.split("\n"), 1):
            for old in search.in_line(line, file.suffix):
                new = search.new.get(old.lower(), "otherwise (see its declaration)")
                failures.append("%s:%d: %s is now called %s" % (file.relative_to(source), number, old, new))
    for failure in failures:
        print("FAILED: " + failure)
    counts = (len(rows), len(former), len(texts), len(failures))
    print("%d retired words, %d former parameters, %d files; %d failures" % counts)
    return 1 if failures or len(rows) < 50 or len(texts) < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
