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

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools/manual"))
from build import ELEMENTS, SECTIONS  # noqa: E402

# Page on which the search starts, words of the search, and the page that must be among the first results.
SEARCHES = (
    ("index.html", "rayleigh_stiffness", "reference/corotational_fem.html"),
    ("index.html", "warm start", "one-step.html"),
    ("reference/contact.html", "pia", "../tutorial-plugin.html"),
    ("trainee.html", "Sindou", "exercises.html"),
    ("trainee.html", "instruc", "instructor.html"),
)


def make_site(source, insula, out):
    """Builds the site into `out`. Returns the error text, or an empty text."""
    reference, site = out / "reference", out / "html"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    subprocess.run([insula, "docs", reference, "--plugins", source / "plugins"], check=True, capture_output=True)
    command = [sys.executable, "-B", source / "tools/manual/build.py", source, reference, site]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.stdout + done.stderr if done.returncode != 0 else ""


def missing_parts(source, site):
    """Texts of the parts that the site lacks."""
    front = (site / "index.html").read_text(encoding="utf-8")
    for name in SECTIONS + (ELEMENTS,):
        if not re.search(r">\s*%s\s*<" % name, front):
            yield "the front page has no section " + name
    for page in (source / "docs").glob("*.md"):
        if not (site / ("index.html" if page.name == "README.md" else page.stem + ".html")).exists():
            yield page.name + " is not in the site"
    # Tables must be HTML tables.
    if "<table>" not in (site / "exercises.html").read_text(encoding="utf-8"):
        yield "exercises.html has no table"


def links_of(site):
    """Yields (page, address, file) for each link within the site."""
    for page in site.rglob("*.html"):
        if page.name == "404.html":  # its addresses begin at a server's root
            continue
        for target in re.findall(r'(?:href|src)="([^"]+)"', page.read_text(encoding="utf-8")):
            address = urllib.parse.urlsplit(target)
            if not address.scheme and not address.netloc and address.path:
                yield page, target, (page.parent / urllib.parse.unquote(address.path)).resolve()


def search(chromium, site, page, words):
    """The first results of a search in a site that is opened from its folder, without a web server."""
    address = (site / page).as_uri() + "?q=" + urllib.parse.quote(words)
    with tempfile.TemporaryDirectory() as profile:
        command = [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--user-data-dir=" + profile]
        command += ["--virtual-time-budget=30000", "--dump-dom", address]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    results = done.stdout.split('id="mkdocs-search-results"')[-1].split("</div>")[0]
    return [urllib.parse.urlsplit(a).path for a in re.findall(r'<a href="([^"]+)"', results)][:10]


def failed_searches(site):
    """Texts of the searches that fail. One search starts from a page in a subfolder of the site."""
    chromium = os.environ.get("CHROMIUM", "/usr/bin/chromium")
    if not os.path.exists(chromium):
        print("Chromium is not installed: searches are skipped")
        return
    for page, words, wanted in SEARCHES:
        def whole(path):
            return os.path.normpath(os.path.join(os.path.dirname(page), path))

        found = search(chromium, site, page, words)
        if whole(wanted) not in [whole(f) for f in found]:
            yield "in %s a search for \"%s\" does not find %s but %s" % (page, words, wanted, found)


def main():
    source, insula, out = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
    if not shutil.which("mkdocs"):
        print("mkdocs is not installed: skipped")
        return 77
    if why := make_site(source, insula, out):
        print("FAILED: " + why)
        return 1
    site = out / "html"
    failures = list(missing_parts(source, site))
    links = list(links_of(site))
    failures += ["%s links to %s, which is not there" % (page.relative_to(site), target)
                 for page, target, file in links if not file.exists()]
    index = (site / "search/index.js").read_text(encoding="utf-8")
    places = len(json.loads(index[index.index("{") : index.rindex("}") + 1])["docs"])
    if places <= 300:
        failures.append("only %d entries can be searched" % places)
    failures += failed_searches(site)
    if len(links) <= 1000:
        failures.append("only %d links were found; the site may be read wrongly" % len(links))
    for failure in failures:
        print("FAILED: " + failure)
    pages = len(list(site.rglob("*.html")))
    print("%d pages, %d links, %d entries to search; %d failures" % (pages, len(links), places, len(failures)))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
