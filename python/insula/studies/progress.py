# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a study is, and how long it will still take."""

from __future__ import annotations

import collections
import sys
import time
from typing import TextIO


def span(seconds: float) -> str:
    if seconds < 90:
        return "%.0f s" % seconds
    if seconds < 5400:
        return "%.0f min" % (seconds / 60)
    return "%.1f h" % (seconds / 3600)


class Progress:
    """Says a line at most once a second on a terminal, and every fifteen seconds in a log."""

    def __init__(self, total: int, before: int, quiet: bool = False, out: TextIO | None = None):
        self.total, self.before, self.quiet = total, before, quiet
        self.out = out or sys.stderr
        self.ended, self.failed, self.wall = 0, 0, 0.0
        self.start = time.monotonic()
        self.terminal = self.out.isatty()
        self.said = self.start if not self.terminal else 0.0
        self.recent: collections.deque[float] = collections.deque([self.start], maxlen=200)

    def add(self, status: object, count: int = 1) -> None:
        self.ended += count
        self.failed += count if status != "done" else 0
        self.recent.extend([time.monotonic()] * count)
        self.tell()

    def left(self) -> float | None:
        """s, by the pace of the last 200 runs; None while nothing has ended."""
        open_runs = self.total - self.before - self.ended
        since = time.monotonic() - self.recent[0]
        if self.ended == 0 or since <= 0:
            return None
        return open_runs * since / max(1, len(self.recent) - 1 if self.ended < 200 else len(self.recent))

    def line(self) -> str:
        left = self.left()
        parts = ["%d of %d runs" % (self.before + self.ended, self.total)]
        parts += ["%d failed" % self.failed] if self.failed else []
        parts += [span(time.monotonic() - self.start)]
        text = ", ".join(parts)
        return text if left is None else text + "; about %s left" % span(left)

    def tell(self, last: bool = False) -> None:
        now, every = time.monotonic(), 1.0 if self.terminal else 15.0
        if self.quiet or (not last and now - self.said < every):
            return
        self.said = now
        if self.terminal:
            self.out.write("\r\033[K" + self.line() + ("\n" if last else ""))
        else:
            self.out.write(self.line() + "\n")
        self.out.flush()
