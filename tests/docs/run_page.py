#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""run_page.py SOURCE BUILD PAGE: runs a page of the manual from its first line to its last in a copy of the project:
files are put where it says, commands run as they stand or as forms.py says. Then its snippets go through what reads
them.
"""
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import bus  # noqa: E402
import forms  # noqa: E402
import pages  # noqa: E402
import project  # noqa: E402
import snippets  # noqa: E402

LONGEST = 300  # seconds by the clock, of any one command on a busy machine
MESSAGES = 20  # of a session, until it counts as running
SKIPPED = 77


def seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def earlier(source, page):
    """What the pages before this one have run for it."""
    order = pages.all_pages(source)
    said = {
        c
        for p in order[: order.index(page)]
        for b in pages.read(p)[0]
        if b.language == "sh"
        for _, c in pages.commands(b)
    }
    return {c for c in said if re.fullmatch(forms.ONCE, c)}


class Runner:
    def __init__(self, source, build, page, folder):
        self.source, self.build, self.page, self.folder = source, build, page, folder
        self.name = str(page.relative_to(source))
        self.port = bus.free_port()
        self.environment = project.environment(build, folder, "udpm://%s:%d?ttl=0" % (bus.GROUP, self.port))
        self.multicast = None  # not asked yet
        self.failures = self.done = self.skipped = 0

    def that(self, ok, line, text):
        if not ok:
            self.failures += 1
            print("FAILED: %s:%d: %s" % (self.name, line, text), flush=True)

    def told(self, began, what):
        self.done += 1
        print("%6.1f s  %s" % (seconds() - began, what), flush=True)

    def run(self, words, line, shown, prints=""):
        began = seconds()
        try:
            done = subprocess.run(
                words,
                cwd=self.folder,
                env=self.environment,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                timeout=LONGEST,
            )
        except subprocess.TimeoutExpired:
            return self.that(False, line, "`%s` does not end" % shown)
        said = done.stdout + done.stderr
        self.told(began, shown)
        self.that(done.returncode == 0, line, "`%s` ends with status %d:\n%s" % (shown, done.returncode, said[-4000:]))
        self.that(re.search(prints, said), line, "`%s` does not print \"%s\":\n%s" % (shown, prints, said[-4000:]))

    def until_ctrl_c(self, words, line, shown, form):
        """A session, until it says something on the bus."""
        if self.multicast is None:
            self.multicast = bus.works()
        if not self.multicast:
            self.skipped += 1
            return print("no multicast on this machine, not run: " + shown)
        began = seconds()
        log = self.folder / ".user/log"
        with bus.join(self.port) as listener, open(log, "w+", encoding="utf-8") as out:
            process = subprocess.Popen(
                words,
                cwd=self.folder,
                env=self.environment,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
            )
            try:
                came = bus.heard(listener, form.channel, MESSAGES, lambda: process.poll() is None, LONGEST)
                process.send_signal(signal.SIGINT)
                status = process.wait(60)
            except subprocess.TimeoutExpired:
                status = "none: it does not end after Ctrl-C"
            finally:
                process.kill()
                process.wait()
        said = log.read_text(encoding="utf-8")
        self.told(began, shown + "   until it runs")
        self.that(came, line, "`%s` sends no %s:\n%s" % (shown, form.channel, said[-4000:]))
        self.that(status == 0, line, "`%s` ends with status %s:\n%s" % (shown, status, said[-4000:]))
        return self.that(
            re.search(form.prints, said), line, "`%s` does not print \"%s\":\n%s" % (shown, form.prints, said[-4000:])
        )

    def command(self, line, text):
        form = forms.form_of(text)
        if isinstance(form, forms.Never):
            print("          not run: %s: %s" % (text, form.why))
        elif isinstance(form, forms.Elsewhere):
            print("          run by test %s: %s" % (form.test, text))
        else:
            shown = forms.run_as(form, text).replace("{build}", str(self.build))
            words = ["bash", "-euo", "pipefail", "-c", shown]
            if isinstance(form, forms.UntilCtrlC):
                self.until_ctrl_c(words, line, shown, form)
            else:
                self.run(words, line, shown, form.prints if form else "")

    def all(self):
        blocks = pages.read(self.page)[0]
        project.make(self.source, self.build, self.folder)
        for name in forms.FIXTURES.get(self.name, ()):
            project.fixture(name, self.source, self.build, self.folder)
        known = earlier(self.source, self.page)
        for block in blocks:
            if block.role in ("file", "bad"):
                (self.folder / block.value).parent.mkdir(parents=True, exist_ok=True)
                (self.folder / block.value).write_text(block.text, encoding="utf-8")
            elif block.language == "sh":
                for line, text in pages.commands(block):
                    if text not in known:
                        self.command(line, text)
        for block in blocks:  # when all files of the page are there
            if block.role != "bad":
                snippets.check(self, block)


def main():
    source, build, page = (pathlib.Path(a).resolve() for a in sys.argv[1:4])
    with tempfile.TemporaryDirectory(prefix="insula_page_") as name:
        runner = Runner(source, build, page, pathlib.Path(name).resolve())
        runner.all()
    print(
        "%s: %d commands and snippets run, %.1f s of processor time; %d failures"
        % (runner.name, runner.done, seconds(), runner.failures)
    )
    return 1 if runner.failures else SKIPPED if runner.skipped else 0


if __name__ == "__main__":
    os.umask(0o022)
    sys.exit(main())
