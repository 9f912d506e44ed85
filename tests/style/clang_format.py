#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""clang_format.py SOURCE [--fix]: each C++ source is as clang-format 14 writes it; --fix writes it so.

Other versions of clang-format break some lines elsewhere, so without version 14 the test is skipped (status 77).
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from sources import tracked  # noqa: E402

VERSION = "14"
TEMPLATES = ("tools/new_plugin/", "tests/docs/frames/")  # no C++ before their words between @ are filled in


def program():
    for name in ("clang-format-" + VERSION, "clang-format"):
        found = shutil.which(name)
        if not found:
            continue
        said = subprocess.run([found, "--version"], capture_output=True, text=True).stdout
        if "version %s." % VERSION in said:
            return found
    return None


def main():
    source, fix = pathlib.Path(sys.argv[1]).resolve(), "--fix" in sys.argv
    tool = program()
    if not tool:
        print("no clang-format %s here: skipped" % VERSION)
        return 77

    def check(paths):
        how = ["-i"] if fix else ["--dry-run", "--ferror-limit=1", "-Werror"]
        done = subprocess.run([tool, *how, *paths], cwd=source, capture_output=True, text=True)
        return re.findall(r"^(\S+?:\d+):\d+: error: code should be clang-formatted", done.stderr, re.M)

    files = [p.relative_to(source).as_posix() for p in tracked(source, ".cpp", ".h")]
    files = [f for f in files if not f.startswith(TEMPLATES)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = [w for found in pool.map(check, [files[k:k + 20] for k in range(0, len(files), 20)]) for w in found]
    for place in sorted(wrong):
        print(place + ": not as clang-format writes it")
    if wrong:
        print("tests/style/clang_format.py %s --fix puts %d files right" % (sys.argv[1], len(wrong)))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
