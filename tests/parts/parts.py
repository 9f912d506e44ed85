#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""parts.py SOURCE BUILD CTEST [--check]: which long tests and browser checks this commit runs.

long_tests.txt names the long tests. They are divided into parts of equal time. A commit runs one part, which its hash
chooses: the same commit always runs the same tests, and a few commits run all of them. Prints two lines: the numbers of
the tests to run (for ctest -I; a regular expression of all that is left out is too long for ctest), and the names of
the browser checks to run. --check reads the list and says what is wrong with it: a line that names no test, tests that
two lines name, and a part of which ctest would run something else.
"""
import pathlib
import re
import subprocess
import sys

PARTS = 12
BROWSER = "browser:"


def read(path):
    """(seconds, names) of each line; names are regular expressions of tests or `browser:CHECK`."""
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split("#")[0].split()
        if words:
            yield float(words[0]), tuple(words[1:])


def divide(lines, parts):
    """Each line's part: the longest first, each to the part that has the least seconds so far."""
    load = [0.0] * parts
    home = {}
    for seconds, names in sorted(lines, key=lambda line: (-line[0], line[1])):
        lightest = load.index(min(load))
        load[lightest] += seconds
        home[names] = lightest
    return home, load


def tests_of(build, ctest, *options):
    """Number and name of each test, with options only of those that they choose."""
    command = [ctest, "--test-dir", build, "-N", *options]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return {int(number): name for number, name in re.findall(r"^ +Test +#(\d+): (.*)$", out, re.M)}


def checks_of(source):
    text = (source / "viewer/page/test/e2e_all.mjs").read_text(encoding="utf-8")
    return re.findall(r"^  '(\w+)',$", text, re.M)


def commit_of(source):
    done = subprocess.run(["git", "-C", source, "rev-parse", "HEAD"], capture_output=True, text=True)
    return int(done.stdout[:8], 16) if done.returncode == 0 else 0


def mistakes(lines, tests, checks):
    found, owner = [], {}
    for _, names in lines:
        for name in names:
            if name.startswith(BROWSER):
                hits = [c for c in checks if c == name[len(BROWSER):]]
            else:
                hits = [t for t in tests if re.search(name, t)]
            if not hits:
                found.append("%s: there is no such test" % name)
            for hit in hits:
                if owner.setdefault(hit, name) != name:
                    found.append("%s is named by %s and by %s" % (hit, owner[hit], name))
    return found


def numbers_of(left_out, tests):
    """What `ctest -I` takes: no range, and the numbers of the tests that no name of left_out is found in."""
    unwanted = [re.compile(name) for name in left_out if not name.startswith(BROWSER)]
    chosen = [number for number, name in tests.items() if not any(u.search(name) for u in unwanted)]
    return ",".join(["0,0,0", *map(str, chosen)])


def disagreements(home, build, ctest, tests):
    """Parts of which ctest, asked with their numbers, would run another number of tests."""
    for part in range(PARTS):
        numbers = numbers_of([n for names, p in home.items() for n in names if p != part], tests)
        if len(tests_of(build, ctest, "-I", numbers)) != len(numbers.split(",")) - 3:
            yield "part %d: ctest reads its numbers otherwise" % part


def main():
    source, build, ctest = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    lines, checks = list(read(source / "tests/parts/long_tests.txt")), checks_of(source)
    home, _ = divide(lines, PARTS)
    tests = tests_of(build, ctest)
    if "--check" in sys.argv:
        found = mistakes(lines, tests.values(), checks) + list(disagreements(home, build, ctest, tests))
        print("\n".join("tests/parts/long_tests.txt: " + f for f in found) or "%d lines" % len(lines))
        return 1 if found else 0
    part = commit_of(source) % PARTS
    left_out = [name for names, home_part in home.items() for name in names if home_part != part]
    print(numbers_of(left_out, tests))
    print(" ".join(c for c in checks if BROWSER + c not in left_out))
    return 0


if __name__ == "__main__":
    sys.exit(main())
