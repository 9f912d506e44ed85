#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""forms_test.py SOURCE BUILD CTEST: the table of forms.py against the pages and ctest's tests: every entry fits a
command and is the first that does, every test that it names exists, every page with something to run has its test, and
what nothing runs is little.
"""
import json
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import forms  # noqa: E402
import pages  # noqa: E402
import snippets  # noqa: E402

MOST_NEVER = 8  # commands; more is a manual that is not tried


def main():
    source, build, ctest = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[3]
    listed = subprocess.run(
        [ctest, "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True, check=True
    ).stdout
    tests = {t["name"] for t in json.loads(listed)["tests"]}
    failures = []
    used, never, commands = set(), set(), set()
    for page in pages.all_pages(source):
        name = page.relative_to(source)
        blocks = pages.read(page)[0]
        if (
            any(b.language == "sh" or b.language in snippets.READERS for b in blocks)
            and "docs_run.%s" % name not in tests
        ):
            failures.append("%s has no test docs_run.%s" % (name, name))
        for block in blocks:
            if block.language in ("bash", "shell", "console", "c++", "py"):
                failures.append(
                    "%s:%d: ```%s is read by nothing; say sh, cpp or python" % (name, block.line, block.language)
                )
            if not block.language and re.search(r"^\s*(\./insula |<\w+[ >]|sudo )", block.text, re.M):
                failures.append("%s:%d: a block without a language holds what could be run" % (name, block.line))
        for _, command in (c for b in blocks if b.language == "sh" for c in pages.commands(b)):
            commands.add(command)
            form = forms.form_of(command)
            used.add(id(form))
            if isinstance(form, forms.Never):
                never.add(command)
            if isinstance(form, forms.Shorter) and forms.run_as(form, command) == command:
                failures.append("the form %s does not change `%s`" % (form.pattern, command))
    for form in forms.FORMS:
        if id(form) not in used:
            failures.append("no command has the form %s" % form.pattern)
        if isinstance(form, forms.Elsewhere) and form.test not in tests:
            failures.append("there is no test %s, which is to run %s" % (form.test, form.pattern))
    for page in forms.FIXTURES:
        if not (source / page).exists():
            failures.append("there is no page %s" % page)
    if len(never) > MOST_NEVER:
        failures.append("%d commands are run by nothing: %s" % (len(never), ", ".join(sorted(never))))
    if len(commands) < 60:
        failures.append("only %d commands were found; are the pages read rightly?" % len(commands))
    for text in failures:
        print("FAILED: " + text)
    print(
        "%d commands, %d run by nothing, %d forms; %d failures"
        % (len(commands), len(never), len(forms.FORMS), len(failures))
    )
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
