# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs `insula case` on a segmentation and reads what it says. Needs Python alone, no 3D Slicer."""
import json
import pathlib
import re
import subprocess

NAME = re.compile(r"[A-Za-z0-9_-]{1,64}")
PROGRESS = re.compile(r"^(\w+)\s+(\d+) %\s+(.*)$")


class CaseError(Exception):
    """What the program refused, in its words."""


def case_name(text):
    """A name for a case from any text: other characters become _."""
    name = re.sub(r"[^A-Za-z0-9_-]+", "_", text).strip("_")[:64]
    return name or "case"


def command(program, name, labels, out, site="", difficulty=0, left=False, rehearse=True):
    """The words of the command line. labels: file of a volume in which the vessel has the label 1.

    rehearse: play the exercises until scripted hands succeed, which takes most of the time.
    """
    if not NAME.fullmatch(name):
        raise CaseError(f'"{name}" is no name of a case: letters, digits, _ and -')
    words = [str(program), "case", "new", name, str(labels), "--label", "1", "--out", str(out)]
    if site:
        words += ["--site", site]
    if difficulty:
        words += ["--difficulty", str(difficulty)]
    if left:
        words.append("--mirror")
    if not rehearse:
        words.append("--no-rehearse")
    return words


def progress_of(line):
    """(stage, percent, what is being done) of a line of progress, else None."""
    found = PROGRESS.match(line.strip())
    return (found[1], int(found[2]), found[3]) if found else None


class CaseRun:
    """A running case builder: read lines() to its end, or stop() it."""

    def __init__(self, words):
        self.folder = None  # of the finished case
        self.progress = ("", 0, "")
        self._error = []
        self._out = pathlib.Path(words[words.index("--out") + 1]) / words[3]
        try:
            self._process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        except OSError as error:
            raise CaseError(f"{words[0]} cannot be run: {error.strerror}") from error

    def lines(self):
        """All lines until the end; the state is up to date after each."""
        with self._process.stdout as stdout:
            for line in stdout:
                if told := progress_of(line):
                    self.progress = told
                elif line.startswith("error:") or self._error:
                    self._error.append(line.strip())
                yield line.rstrip("\n")
        if self._process.wait() != 0:
            raise CaseError(" ".join(self._error).removeprefix("error: ") or "the case builder ended without a word")
        self.folder = self._out

    def stop(self):
        """Ends the program; what it has written stays."""
        self._process.terminate()
        self._process.stdout.close()
        self._process.wait()


def read_report(folder):
    """report.json of a case. Raises CaseError."""
    try:
        return json.loads((pathlib.Path(folder) / "report.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise CaseError(f"{folder}: no report: {error}") from error


def summary(report):
    """Lines that tell an author what became of the case."""
    neck, clipping = report["neck"], report.get("clipping")
    lines = [f"Neck {neck['diameter_mm']:.1f} mm; three methods agree on {100 * neck['confidence']:.0f} % of the dome."]
    if clipping:
        lines.append(
            f"Scripted hands: grade {clipping['grade']}, {clipping['remnant_pct']:.0f} % of the neck left open, "
            f"{clipping['faults']} faults."
        )
    lines.append(f"A step takes {report['step_ms']['p50']:.1f} ms of {report['step_ms']['budget']:.1f} ms.")
    lines += [f"{p['text']} -> {p['what_to_do']}" for p in report["problems"]]
    return lines
