#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""plugins_out_of_tree.py SOURCE BUILD CMAKE: installs Insula into a folder of its own and, with nothing but that,
builds and tests a plugin of each kind as `insula new-plugin` writes it, and the plugin of the manual's tutorial as it
is printed there.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "docs"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import pages  # noqa: E402
from steps import fail, run, that  # noqa: E402

KINDS = ("constraint", "force", "body", "support", "instrument", "exercise", "metric")
TUTORIALS = {
    "pia_membrane": ("force", ("docs/tutorial-plugin.md", "docs/tutorial-plugin-test.md")),
    "suture": ("constraint", ("docs/tutorial-channels.md",)),
}


def installed_page(prefix):
    """The gateway of the prefix serves the page of the prefix."""
    page = prefix / "share/insula/page/index.html"
    if not page.exists():
        print("the page is not built: not checked")
        return
    gateway = subprocess.Popen(
        [prefix / "bin/gateway", "--port", "18700"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    try:
        for line in gateway.stdout:
            if "serving " in line:
                with urllib.request.urlopen(line.split("serving ")[1].strip().rstrip("/") + "/", timeout=20) as answer:
                    that(answer.read() == page.read_bytes(), "the gateway serves another page than the installed one")
                return
        fail("the gateway says no address")
    finally:
        gateway.terminate()
        gateway.wait()


def tutorial(source, insula, folder, plugin):
    """Follows a tutorial: its commands, its files as printed."""
    kind, tutorial_pages = TUTORIALS[plugin]
    wanted = {}
    for page in tutorial_pages:
        for block in pages.read(source / page)[0]:
            if block.role == "file":
                wanted[block.value] = block.text
    that(
        set(wanted) == {"%s/%s" % (plugin, f) for f in (plugin + ".cpp", plugin + "_test.cpp", "example.xml")},
        "the tutorial prints %s" % sorted(wanted),
    )
    begin = [
        line
        for page in tutorial_pages
        for block in pages.read(source / page)[0]
        if block.language == "sh"
        for line in block.text.split("\n")
        if "new-plugin" in line
    ]
    that(begin == ["insula new-plugin %s --kind %s" % (plugin, kind)], "the tutorial begins with %s" % begin)
    run(insula, *begin[0].split()[1:], cwd=folder)
    for name, text in wanted.items():
        that((folder / name).exists(), "new-plugin does not write %s" % name)
        (folder / name).write_text(text, encoding="utf-8")


def step_data_of_the_suture(insula, folder, library):
    """What the suture declares is described, recorded and scored."""
    said = run(insula, "--plugin-path", library, "describe", "suture")
    that("channels\n  tension" in said and "drawables\n  thread" in said, said)
    report = folder / "suture_report"
    run(insula, "--plugin-path", library, "run", folder / "suture/example.xml", "--duration", "1", "--report", report)
    data = json.loads((report / "report.json").read_text())
    tension = data["channels"]["stay.tension"]
    that(
        tension["unit"] == "N" and 0 <= tension["min"] <= tension["mean"] <= tension["max"] and tension["max"] > 0.1,
        "tension: %s" % tension,
    )
    curve = data["series"]["channels"]["stay.tension"]
    that(
        len(curve) == len(data["series"]["time_s"]) and abs(curve[-1] - tension["last"]) < 1e-6, "its curve is another"
    )
    that([f["count"] for f in data["exercise"]["faults"] if f["id"] == "tight"] == [1], "its fault is not counted once")
    that("stay: tension" in (report / "report.html").read_text(), "the report has no curve of it")


def write_plugins(source, insula, folder):
    """Writes a plugin of each kind and those of the tutorials. Returns their names."""
    names = []
    for kind in KINDS:
        names.append("my_%s_1" % kind)
        run(insula, "new-plugin", names[-1], "--kind", kind, cwd=folder)
    for plugin in TUTORIALS:
        tutorial(source, insula, folder, plugin)
        names.append(plugin)
    return names


def refused_names(insula, folder, existing):
    run(insula, "new-plugin", "contact", "--kind", "force", cwd=folder, status=2)
    run(insula, "new-plugin", existing, "--kind", "force", cwd=folder, status=2)
    that(
        "\"Contact\" is no name" in run(insula, "new-plugin", "Contact", "--kind", "force", cwd=folder, status=2),
        "a bad name is not named",
    )


def build_and_test(cmake, prefix, folder, names):
    """Builds all plugins as one project and runs their tests. Returns the build folder."""
    (folder / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(all_plugins LANGUAGES CXX)\nenable_testing()\n"
        + "".join("add_subdirectory(%s)\n" % n for n in names)
    )
    out = folder / "build"
    settings = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_PREFIX_PATH=%s" % prefix, "-DCMAKE_CXX_FLAGS=-Werror"]
    settings += ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    run(cmake, "-S", folder, "-B", out, "-G", "Ninja", *settings)
    run(cmake, "--build", out)
    ctest = pathlib.Path(cmake).with_name("ctest")
    said = run(ctest, "--test-dir", out, "--output-on-failure", "-j", str(os.cpu_count()))
    that("100% tests passed" in said and "out of %d" % (3 * len(names)) in said, said)
    for name in names:  # author's tests and contracts both ran
        listed = run(out / name / (name + "_test"))
        ran = int(re.search(r"(\d+) tests from 2 test suites ran", listed)[1])
        that(ran >= 5 and "Contract.OfElement_" + name in listed, "%s: %d tests ran" % (name, ran))
    return out


def stale_library(insula, prefix, file):
    """Checks that a library with another hash of the headers is rejected."""
    library = (prefix / "lib/insula/plugins/pia_membrane.so").read_bytes()
    stale = re.sub(rb"insula headers [0-9a-f]{12}", b"insula headers 000000000000", library)
    that(stale != library, "the library does not contain the hash of the headers")
    file.write_bytes(stale)
    said = run(insula, "--plugin-path", file, "list", status=2)
    that("was built for another Insula" in said and "build the plugin again" in said, said)


def main():
    source, build, cmake = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    work = build / "tests/installed"
    shutil.rmtree(work, ignore_errors=True)
    prefix, folder = work / "prefix", work / "plugins"
    folder.mkdir(parents=True)
    run(cmake, "--install", build, "--prefix", prefix)
    insula = prefix / "bin/insula"
    run(insula, "check", prefix / "share/insula/plugins/contact/example.xml")
    installed_page(prefix)
    names = write_plugins(source, insula, folder)
    refused_names(insula, folder, names[0])
    out = build_and_test(cmake, prefix, folder, names)
    step_data_of_the_suture(insula, folder, out / "suture/suture.so")
    run(cmake, "--install", out, "--prefix", prefix)
    known = run(insula, "list")
    for name in names:
        that(re.search(r"^\s*%s\s" % name, known, re.M), "%s is installed and not listed" % name)
    stale_library(insula, prefix, work / "old.so")
    return 0


if __name__ == "__main__":
    sys.exit(main())
