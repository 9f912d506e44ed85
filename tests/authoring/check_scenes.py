#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_scenes.py SOURCE INSULA: every shipped scene, example and curriculum is clean and quick to check, and valid by
the schema that editors complete from; what the schemas must refuse they refuse.
"""
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile

# Of processor time: a machine with other things to do takes longer by the clock. The scenes themselves take well under
# a second on an idle one; three times that is a change to look at.
MOST_SECONDS = 3.0

BAD = {
    "a typo of a parameter": '<scene titel="x"/>',
    "an unknown element": "<scene><soft_bdy/></scene>",
    "a wrong unit": '<scene time_step="20 N"/>',
    "a rule outside of an exercise": '<scene><time_limit limit="60 s"/></scene>',
}

ONE_TASK = (
    '<curriculum title="C"><module id="m" title="M"><task id="t" title="T" scene="%s"%s</task></module></curriculum>'
)
BAD_CURRICULA = {
    "a typo of a parameter": '<curriculum titel="x"/>',
    "an unknown element": '<curriculum title="x"><modul id="a" title="A"/></curriculum>',
    "a module without an id": '<curriculum title="x"><module title="A"/></curriculum>',
    "a unit of another quantity": ONE_TASK % ("a.xml", '><gate_goals in_a_row="2" within="3 s"/>'),
    "an unknown mode": ONE_TASK % ("a.xml", ' mode="exam"><gate_goals/>'),
    "a list with a word": ONE_TASK % ("a.xml", '><gate_goals/><repetition after="1 three day"/>'),
    "a gate outside of a task": '<curriculum title="x"><gate_goals/></curriculum>',
}


def check_each(insula, scenes, most_seconds=MOST_SECONDS):
    """Checks that each file has no diagnostics and takes little time. Returns the number of failures."""
    failures, slowest = 0, (0.0, "")
    for scene in scenes:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run([insula, "check", scene], capture_output=True, text=True, timeout=120)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        took = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        slowest = max(slowest, (took, scene.name))
        said = done.stdout + done.stderr
        # That this machine is too slow for a scene is a warning about the machine.
        rest = re.sub(r".*: warning: too slow for this machine.*\n", "", said)
        if done.returncode != 0 or "warning" in rest or took > most_seconds:
            failures += 1
            print("FAILED: %s: status %d, %.2f s\n%s" % (scene, done.returncode, took, said))
    print("%d files checked; the slowest took %.2f s of processor time: %s" % ((len(scenes),) + slowest))
    return failures


def refused(xsd, *files):
    """Validates the files with the schema. Returns the schema's errors, or an empty text."""
    done = subprocess.run(["xmllint", "--noout", "--schema", xsd, *files], capture_output=True, text=True, timeout=120)
    return "" if done.returncode == 0 else done.stderr or "status %d" % done.returncode


def explanations(xsd, scenes, least):
    """Checks that each parameter and element that an editor offers has an explanation. least: parameters."""
    text = xsd.read_text(encoding="utf-8")
    attribute = r'<xs:attribute name="(?!id|file|prefix|name|value|title)'
    named = len(re.findall(attribute, text))
    explained = len(re.findall(attribute + r'[^>]*>\s*<xs:annotation>', text))
    print("%d files valid by the schema, %d parameters offered, %d explained" % (len(scenes), named, explained))
    if named < least or explained < named:
        return ["parameters without an explanation"]
    return []


def check_schema(insula, scenes, bad, folder, *option):
    """Checks that a schema accepts the files and rejects wrong ones. Returns the schema and texts of failures."""
    xsd = folder / "insula.xsd"
    subprocess.run([insula, "schema", *option, xsd], check=True, capture_output=True)
    failures = [why] if (why := refused(xsd, *scenes)) else []
    for what, text in bad.items():
        file = folder / "bad.xml"
        file.write_text(text, encoding="utf-8")
        if not refused(xsd, file) or subprocess.run([insula, "check", file], capture_output=True).returncode != 2:
            failures.append("%s is not rejected by both" % what)
    return xsd, failures


def check_schemas(insula, scenes, curricula, folder):
    """Checks both schemas. Returns the texts of the failures."""
    xsd, failures = check_schema(insula, curricula, BAD_CURRICULA, folder, "--curriculum")
    failures += explanations(xsd, curricula, 20)
    xsd, more = check_schema(insula, scenes, BAD, folder)
    failures += more + explanations(xsd, scenes, 100)
    model = folder / "with_model.xml"
    model.write_text('<?xml version="1.0"?>\n<?xml-model href="insula.xsd"?>\n<scene title="x"/>\n', encoding="utf-8")
    if subprocess.run([insula, "check", model], capture_output=True).returncode != 0:
        failures.append("the line that links a scene to the schema is an error")
    return failures


def main():
    source, insula = pathlib.Path(sys.argv[1]), sys.argv[2]
    scenes = sorted(source.glob("scenes/**/*.xml")) + sorted(source.glob("plugins/*/*.xml"))
    whole = [s for s in scenes if re.search(r"<scene[\s>/]", s.read_text(encoding="utf-8"))]
    if len(whole) < 20:
        print("FAILED: only %d scenes were found" % len(whole))
        return 1
    curricula = sorted(source.glob("curricula/*.xml"))
    if len(curricula) < 2:
        print("FAILED: only %d curricula were found" % len(curricula))
        return 1
    # A curriculum reads each of its scenes.
    failures = check_each(insula, whole) + check_each(insula, curricula, 5 * MOST_SECONDS)
    if not shutil.which("xmllint"):
        print("xmllint (package libxml2-utils) is not installed: the schema is not tried")
        return 1 if failures else 0
    with tempfile.TemporaryDirectory() as name:
        for failure in check_schemas(insula, scenes, curricula, pathlib.Path(name)):
            failures += 1
            print("FAILED: " + failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
