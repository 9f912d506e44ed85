#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""html_manual.py SOURCE INSULA OUT: the manual as a site: it builds without a warning, its parts are there, its links lead somewhere,
and the search finds pages and parameters.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

SECTIONS = ("Trainee", "Instructor", "Author", "Developer", "Haptics and safety", "Validation", "Performance", "Elements of scene files")


def main():
    source, insula, out = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
    if not shutil.which("mkdocs"):
        print("mkdocs is not installed: skipped")
        return 77
    reference, site = out / "reference", out / "html"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    subprocess.run([insula, "docs", reference, "--plugins", source / "plugins"], check=True, capture_output=True)
    done = subprocess.run([sys.executable, "-B", source / "tools/manual/build.py", source, reference, site], capture_output=True, text=True)
    if done.returncode != 0:
        print("FAILED: " + done.stdout + done.stderr)
        return 1
    failures, links = 0, 0

    def that(ok, text):
        nonlocal failures
        if not ok:
            failures += 1
            print("FAILED: " + text)

    front = (site / "index.html").read_text(encoding="utf-8")
    for name in SECTIONS:
        that(re.search(r">\s*%s\s*<" % name, front), "the front page has no section " + name)
    for page in (source / "docs").glob("*.md"):
        that((site / ("index.html" if page.name == "README.md" else page.stem + ".html")).exists(), page.name + " is not in the site")
    for page in site.rglob("*.html"):
        if page.name == "404.html":  # its addresses begin at a server's root
            continue
        text = page.read_text(encoding="utf-8")
        for target in re.findall(r'(?:href|src)="([^"]+)"', text):
            address = urllib.parse.urlsplit(target)
            if address.scheme or address.netloc or not address.path:
                continue
            links += 1
            file = (page.parent / urllib.parse.unquote(address.path)).resolve()
            that(file.exists(), "%s links to %s, which is not there" % (page.relative_to(site), target))
    # Tables and lists came out as such.
    that("<table>" in (site / "exercises.html").read_text(encoding="utf-8"), "exercises.html has no table")
    index = json.loads((site / "search/search_index.json").read_text(encoding="utf-8"))["docs"]
    for word, page in (("rayleigh_stiffness", "reference/corotational_fem.html"), ("warm start", "one-step.html"), ("pia", "tutorial-plugin.html"), ("clip", "trainee.html")):
        found = [d["location"] for d in index if word in (d["title"] + " " + d["text"]).lower()]
        that(any(l.split("#")[0] == page for l in found), "a search for \"%s\" does not find %s" % (word, page))
    that(links > 1000, "only %d links were found; is the site read rightly?" % links)
    print("%d pages, %d links, %d places to search; %d failures" % (len(list(site.rglob("*.html"))), links, len(index), failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
