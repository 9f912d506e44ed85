# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands of the tests of the installation: run, timed, and shown whole when one fails."""
import subprocess
import sys
import time


def run(*command, status=0, cwd=None, env=None):
    """Runs a command; ends the test when its status is another. Returns what it printed."""
    began = time.monotonic()
    done = subprocess.run([str(c) for c in command], cwd=cwd, env=env, capture_output=True, text=True, timeout=800)
    text = done.stdout + done.stderr
    print("%6.1f s  %s" % (time.monotonic() - began, " ".join(str(c) for c in command)[:150]), flush=True)
    if done.returncode != status:
        fail("status %d, not %d:\n%s" % (done.returncode, status, text[-6000:]))
    return text


def that(ok, text):
    if not ok:
        fail(text)


def fail(text):
    print("FAILED: " + text)
    sys.exit(1)
