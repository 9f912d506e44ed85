#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""quick.py SOURCE BUILD [--since COMMIT]: builds and runs the unit tests of what has changed, in three minutes at most.

What has changed: files that differ from the last commit, and new ones. With none, what the last commits changed since
the branch left the main branch, or the last commit itself. It prints which files it found, which tests it runs, and
what it left out.
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

BUDGET_S = 175
# Folder of the changed file, and the program that contains its tests. The test files lie in the same folder.
PROGRAMS = (
    ("core/", "core_tests"),
    ("plugins/", "plugin_tests"),
    ("haptic_server/", "servo_tests"),
    ("engine/", "engine_tests"),
    ("training/curriculum/", "curriculum_tests"),
    ("viewer/gateway/", "gateway_tests"),
    ("lcm_types/", "core_tests"),
    ("tools/workbench/", "workbench_tests"),
    ("tools/artery/", "artery_tool_tests"),
    ("tools/case_builder/", "case_builder_tests"),
    ("tests/artery/", "artery_mesh_tests"),
    ("tests/contracts/", "contract_tests"),
    ("tests/devices/", "device_tests"),
    ("tests/exercises/", "exercise_tests"),
    ("tests/faults/", "fault_tests"),
    ("tests/problems/", "problem_tests"),
    ("tests/docs/", "manual_plugin_tests"),
)
SUITE = re.compile(r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+)\s*,|^TYPED_TEST_SUITE\(\s*(\w+)", re.M)


def git(source, *words):
    done = subprocess.run(["git", "-C", source, *words], capture_output=True, text=True)
    return done.stdout.split("\n")[:-1] if done.returncode == 0 else []


def changed_files(source, since):
    """The changed files, and in words what they were compared with."""
    if since:
        return git(source, "diff", "--name-only", since), "changed since " + since
    here = git(source, "diff", "--name-only", "HEAD") + git(source, "ls-files", "--others", "--exclude-standard")
    if here:
        return here, "not committed yet"
    for main in ("origin/main", "main"):
        base = git(source, "merge-base", "HEAD", main)
        if base and base != git(source, "rev-parse", "HEAD"):
            return git(source, "diff", "--name-only", base[0], "HEAD"), "changed since the branch left " + main
    return git(source, "diff", "--name-only", "HEAD~1", "HEAD"), "of the last commit"


def suites(files):
    names = set()
    for f in files:
        for plain, typed in SUITE.findall(f.read_text(encoding="utf-8")):
            names.add(plain or typed)
    return names


def test_files(source, path, top):
    """The test files of a changed file: itself, files of the same name, those of its folder, or else of the next folder
    above, up to the folder `top`."""
    file = source / path
    if file.name.endswith("_test.cpp"):
        return [file] if file.exists() else []
    namesakes = sorted(file.parent.glob(file.stem + "*_test.cpp"))
    if namesakes:
        return namesakes
    folder = file.parent
    while True:
        found = sorted(folder.glob("*_test.cpp"))
        if found or folder == source / top or folder == source:
            return found
        folder = folder.parent


def home_of(path):
    """(folder, test program) of a changed file; (None, None) if there is no test program for it."""
    for folder, program in PROGRAMS:
        if path.startswith(folder):
            return folder, program
    match = re.match(r"tests/(\w+)/", path)
    return ("tests/%s/" % match[1], match[1] + "_tests") if match else (None, None)


def plan(source, files):
    """(program -> names of suites, files without unit tests)."""
    programs, rest = {}, []
    for path in files:
        top, program = home_of(path)
        if path.startswith("lcm_types/"):
            found = sorted((source / "core/bus").glob("*_test.cpp"))
        elif program and path.endswith((".cpp", ".h", ".xml")):
            found = test_files(source, path, top)
        else:
            found = []
        names = suites(found)
        if names:
            programs.setdefault(program, set()).update(names)
        else:
            rest.append(path)
    return programs, rest


class Clock:
    def __init__(self):
        self.end = time.monotonic() + BUDGET_S

    def run(self, command, **more):
        """Its exit status; None when the time was up."""
        left = self.end - time.monotonic()
        if left < 1:
            return None
        child = subprocess.Popen([str(c) for c in command], start_new_session=True, **more)
        try:
            return child.wait(timeout=left)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGTERM)
            child.wait()
            return None


def say(text):
    print("== " + text, flush=True)


def run_programs(clock, source, build, programs):
    """Builds and runs the programs of tests; what failed, what there was no time for."""
    failed, left_out = [], []
    known = subprocess.run(["ninja", "-C", build, "-t", "targets", "all"], capture_output=True, text=True).stdout
    targets = [p for p in sorted(programs) if re.search(r"^%s: phony" % p, known, re.M)]
    left_out += ["%s (no such program)" % p for p in sorted(programs) if p not in targets]
    if not targets:
        return failed, left_out
    say("building " + ", ".join(targets))
    status = clock.run(["ninja", "-C", build, "--quiet", *targets])
    if status is None:
        return failed, left_out + ["%s (the build took all of the time; start again to go on)" % t for t in targets]
    if status:
        return ["the build"], left_out
    for target in targets:
        names = sorted(programs[target])
        say("%s: %s" % (target, " ".join(names)))
        chosen = ":".join("%s.*:%s/*:*/%s.*:*/%s/*" % (n, n, n, n) for n in names)
        status = clock.run([build / "tests" / target, "--gtest_brief=1", "--gtest_filter=" + chosen], cwd=source)
        if status is None:
            left_out.append(target + " (no time left)")
        elif status:
            failed.append(target)
    return failed, left_out


class Outcome:
    def __init__(self):
        self.failed, self.left_out = [], []

    def take(self, what, status, good=(0,)):
        """Records the exit status of a check; None: there was no time for it."""
        if status is None:
            self.left_out.append(what + " (no time left)")
        elif status not in good:
            self.failed.append(what)


def style(clock, source, outcome):
    for script in ("function_length.py", "lines.py", "clang_format.py"):
        path = source / "tests/style" / script
        outcome.take("tests/style/" + script, clock.run([sys.executable, "-B", path, source]), (0, 77))


def page(clock, source, outcome):
    folder = source / "viewer/page"
    if not (folder / "node_modules").exists():
        say("viewer/page: npm ci")
        status = clock.run(["npm", "ci", "--no-audit", "--no-fund", "--silent"], cwd=folder)
        if status != 0:
            return outcome.take("viewer/page: npm ci", status)
    say("viewer/page: npm test")
    outcome.take("viewer/page", clock.run(["npm", "test", "--silent"], cwd=folder))


def tidy(clock, source, build, files, outcome):
    """clang-tidy on the changed sources, as many as the time allows."""
    script = source / "tests/style/clang_tidy.py"
    for file in files:
        status = clock.run([sys.executable, "-B", script, source, build, file])
        outcome.take("clang-tidy on " + file, status, (0, 77))


def report(outcome, rest, seconds):
    if rest:
        more = " and %d more" % (len(rest) - 12) if len(rest) > 12 else ""
        say("no unit test exists for: " + " ".join(rest[:12]) + more)
    for what in outcome.left_out:
        say("left out: " + what)
    if outcome.failed:
        say("FAILED: %s after %d s" % (", ".join(outcome.failed), seconds))
    else:
        say("passed after %d s; ./insula test runs everything" % seconds)
    return 1 if outcome.failed or outcome.left_out else 0


def main():
    source, build = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    since = sys.argv[sys.argv.index("--since") + 1] if "--since" in sys.argv else None
    clock, begin = Clock(), time.monotonic()
    files, how = changed_files(source, since)
    say("%d files %s" % (len(files), how))
    programs, rest = plan(source, files)
    outcome = Outcome()
    style(clock, source, outcome)
    if any(f.startswith("viewer/page/") for f in files):
        page(clock, source, outcome)
        rest = [f for f in rest if not f.startswith("viewer/page/")]
    scenes = [f for f in files if f.startswith("scenes/") and f.endswith(".xml") and (source / f).exists()]
    if scenes and (build / "bin/insula").exists():
        say("insula check " + " ".join(scenes))
        outcome.take("insula check", clock.run([build / "bin/insula", "check", *scenes], cwd=source))
        rest = [f for f in rest if f not in scenes]
    failed, left_out = run_programs(clock, source, build, programs)
    outcome.failed += failed
    outcome.left_out += left_out
    tidy(clock, source, build, [f for f in files if f.endswith(".cpp") and (source / f).exists()], outcome)
    return report(outcome, rest, time.monotonic() - begin)


if __name__ == "__main__":
    sys.exit(main())
