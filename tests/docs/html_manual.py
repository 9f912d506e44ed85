#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""html_manual.py SOURCE INSULA OUT: the manual as a site: it builds without a warning, its parts are there, its links
lead somewhere, and the search finds pages and parameters.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

def main():
    source, insula, out = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(source / "tools/manual"))
    from build import ELEMENTS, SECTIONS

    if not shutil.which("mkdocs"):
        print("mkdocs is not installed: skipped")
        return 77
    reference, site = out / "reference", out / "html"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    subprocess.run([insula, "docs", reference, "--plugins", source / "plugins"], check=True, capture_output=True)
    done = subprocess.run(
        [sys.executable, "-B", source / "tools/manual/build.py", source, reference, site],
        capture_output=True,
        text=True,
    )
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
    for name in SECTIONS + (ELEMENTS,):
        that(re.search(r">\s*%s\s*<" % name, front), "the front page has no section " + name)
    for page in (source / "docs").glob("*.md"):
        that(
            (site / ("index.html" if page.name == "README.md" else page.stem + ".html")).exists(),
            page.name + " is not in the site",
        )
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
    index = (site / "search/index.js").read_text(encoding="utf-8")
    places = len(json.loads(index[index.index("{") : index.rindex("}") + 1])["docs"])
    that(places > 300, "only %d places can be searched" % places)
    # What a person finds who opened the site from its folder, without a web server; from a page of a folder in it, too.
    chromium = os.environ.get("CHROMIUM", "/usr/bin/chromium")
    for page, words, wanted in (
        ("index.html", "rayleigh_stiffness", "reference/corotational_fem.html"),
        ("index.html", "warm start", "one-step.html"),
        ("reference/contact.html", "pia", "../tutorial-plugin.html"),
        ("trainee.html", "Sindou", "exercises.html"),
        ("trainee.html", "instruc", "instructor.html"),
    ):
        if not os.path.exists(chromium):
            print("no Chromium here: nothing is searched")
            break
        address = (site / page).as_uri() + "?q=" + urllib.parse.quote(words)
        with tempfile.TemporaryDirectory() as profile:
            done = subprocess.run(
                [
                    chromium,
                    "--headless",
                    "--no-sandbox",
                    "--disable-gpu",
                    "--user-data-dir=" + profile,
                    "--virtual-time-budget=30000",
                    "--dump-dom",
                    address,
                ],
                capture_output=True,
                text=True,
                timeout=120,
            )
        results = done.stdout.split('id="mkdocs-search-results"')[-1].split("</div>")[0]
        found = [urllib.parse.urlsplit(a).path for a in re.findall(r'<a href="([^"]+)"', results)]
        that(
            any(
                os.path.normpath(os.path.join(os.path.dirname(page), f))
                == os.path.normpath(os.path.join(os.path.dirname(page), wanted))
                for f in found[:10]
            ),
            "in %s a search for \"%s\" does not find %s but %s" % (page, words, wanted, found[:10]),
        )
    that(links > 1000, "only %d links were found; is the site read rightly?" % links)
    print(
        "%d pages, %d links, %d places to search; %d failures"
        % (len(list(site.rglob("*.html"))), links, places, failures)
    )
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
