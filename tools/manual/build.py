#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""build.py SOURCE REFERENCE OUT: the manual and the generated reference as one HTML site with a search, by MkDocs.

Pages come from docs/, from what they link to in the project, and from REFERENCE (what `insula docs` wrote). Their order
comes from the table of docs/README.md, so that a page is listed in one place; its section follows from whom the table
says it is for.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s#]+)(#[^)\s]*)?(\))")
ROW = re.compile(r"^\| (\[[^|]+) \| ([^|]+) \|", re.M)
PAGE = re.compile(r"\[([^\]]+)\]\(([\w-]+\.md)\)")
FENCE = re.compile(r"^\s*```")
SECTIONS = (
    "Trainee",
    "Instructor",
    "Author",
    "Developer",
    "Haptics and safety",
    "Validation",
    "Performance",
    "Machines and packages",
)
ELEMENTS = "Elements of scene files"  # the section of the generated reference


def section(page, whom):
    """The section of a page: by its name where it is about one thing, else by the first whom it is for."""
    for part, names in (
        ("Haptics and safety", ("haptic", "feel", "devices")),
        ("Validation", ("validation",)),
        ("Performance", ("performance", "solvers")),
    ):
        if page.startswith(names):
            return part
    for word, part in (
        ("trainee", "Trainee"),
        ("instructor", "Instructor"),
        ("author", "Author"),
        ("developer", "Developer"),
        ("reviewer", "Validation"),
    ):
        if whom.strip().startswith(word):
            return part
    return "Machines and packages"


class Site:
    def __init__(self, source, reference, stage):
        self.source, self.reference, self.stage = source, reference, stage
        self.placed = {}  # file of the project -> path in the site

    def place(self, file):
        """Where a file of the project goes: docs/ to the root, others as they lie."""
        if file in self.placed:
            return self.placed[file]
        inside = file.relative_to(self.source)
        to = pathlib.PurePosixPath(*(inside.parts[1:] if inside.parts[0] == "docs" else inside.parts))
        if file.name == "README.md":
            to = to.with_name("index.md")
        self.placed[file] = to
        if file.suffix == ".md":
            self.write(to, self.page(file, to))
        else:
            (self.stage / to).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, self.stage / to)
        return to

    def write(self, to, text):
        (self.stage / to).parent.mkdir(parents=True, exist_ok=True)
        (self.stage / to).write_text(text, encoding="utf-8")

    def page(self, file, to):
        def link(m):
            target = (file.parent / m[2]).resolve()
            if re.match(r"[a-z]+:", m[2]) or not target.is_relative_to(self.source):
                return m[0]
            if not target.is_file():
                return (
                    m[0][1 : m[0].index("]")] if target.is_dir() else m[0]
                )  # a folder is named, not shown; MkDocs tells of the rest
            return m[1] + os.path.relpath(self.place(target), to.parent) + (m[3] or "") + m[4]

        lines, code, table = [], False, False
        for line in file.read_text(encoding="utf-8").split("\n"):
            code ^= bool(FENCE.match(line))
            # Markdown of MkDocs wants an empty line before a list or a table; the project's pages do without.
            starts = re.match(r"([-*] |\d+\. |\|)", line)
            if starts and not code and lines and lines[-1].strip() and not re.match(r"([-*] |\d+\. |\||  )", lines[-1]):
                lines.append("")
            lines.append(line if code else LINK.sub(link, line))
        return "\n".join(lines)

    def nav(self):
        """MkDocs' navigation, in YAML."""
        groups = {name: [] for name in SECTIONS}
        listed = set()
        text = (self.source / "docs/README.md").read_text(encoding="utf-8")
        for cell, whom in ROW.findall(text):
            for title, page in PAGE.findall(cell):
                groups[section(page, whom)].append((title, page))
                listed.add(page)
        for page in re.findall(r"\]\(([\w-]+\.md)\)", text):  # named in a cell of another page's row
            if page not in listed and (self.source / "docs" / page).exists():
                title = (self.source / "docs" / page).read_text(encoding="utf-8").split("\n")[0].lstrip("# ")
                groups["Developer"].append((title, page))
                listed.add(page)
        missing = sorted(
            p.name for p in (self.source / "docs").glob("*.md") if p.name != "README.md" and p.name not in listed
        )
        if missing:
            sys.exit("error: docs/README.md lists no %s: add a row to its table" % ", ".join(missing))
        out = ["nav:", "  - Contents: index.md"]
        for name in SECTIONS:
            if not groups[name]:
                sys.exit("error: no page of docs/README.md is for section \"%s\"" % name)
            out.append("  - %s:" % name)
            out += ["      - \"%s\": %s" % entry for entry in groups[name]]
        out.append("  - %s:" % ELEMENTS)
        out.append("      - All elements: reference/index.md")
        out += [
            "      - %s: reference/%s" % (p.stem, p.name)
            for p in sorted(self.reference.glob("*.md"))
            if p.name != "README.md"
        ]
        return "\n".join(out) + "\n"


def search(source, out):
    """The search of MkDocs needs a web server; ours works from a folder, with the same index as a script."""
    index = (out / "search/search_index.json").read_text(encoding="utf-8")
    (out / "search/index.js").write_text(
        "window.manual_index = " + index.replace("\u2028", "\\u2028").replace("\u2029", "\\u2029") + ";\n",
        encoding="utf-8",
    )
    shutil.copyfile(source / "tools/manual/search.js", out / "search/main.js")
    (out / "search/worker.js").unlink()
    (out / "search/search_index.json").unlink()


def main():
    source, reference, out = (pathlib.Path(a).resolve() for a in sys.argv[1:4])
    if not shutil.which("mkdocs"):
        sys.exit("error: mkdocs is not installed: apt-get install mkdocs")
    if not (reference / "README.md").exists():
        sys.exit("error: %s holds no reference: run ./insula docs first" % reference)
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        site = Site(source, reference, root / "pages")
        for page in sorted((source / "docs").glob("*.md")):
            site.place(page)
        for page in reference.glob("*.md"):
            text = page.read_text(encoding="utf-8")
            site.write(
                pathlib.PurePosixPath("reference") / ("index.md" if page.name == "README.md" else page.name), text
            )
        config = (source / "tools/manual/mkdocs.yml").read_text(encoding="utf-8")
        (root / "mkdocs.yml").write_text(
            config + "docs_dir: %s\nsite_dir: %s\n" % (root / "pages", out) + site.nav(), encoding="utf-8"
        )
        done = subprocess.run(
            ["mkdocs", "build", "--strict", "--clean", "-f", root / "mkdocs.yml"], capture_output=True, text=True
        )
        if done.returncode != 0:
            sys.exit(
                "error: the manual cannot be built:\n"
                + "\n".join(
                    l
                    for l in (done.stdout + done.stderr).replace(str(root / "pages") + "/", "").split("\n")
                    if not l.startswith("INFO")
                )
            )
    search(source, out)
    print("%s: %d pages; open %s" % (out, len(list(out.rglob("*.html"))), out / "index.html"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
