#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_scenes.py SOURCE INSULA: every shipped scene and example is clean and quick to check, and valid by the schema
that editors complete from; what the schema must refuse it refuses.
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


def check_each(insula, scenes):
    """Checks that each scene has no diagnostics and takes little time. Returns the number of failures."""
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
        if done.returncode != 0 or "warning" in rest or took > MOST_SECONDS:
            failures += 1
            print("FAILED: %s: status %d, %.2f s\n%s" % (scene, done.returncode, took, said))
    print("%d scenes checked; the slowest took %.2f s of processor time: %s" % ((len(scenes),) + slowest))
    return failures


def refused(xsd, *files):
    """Validates the files with the schema. Returns the schema's errors, or an empty text."""
    done = subprocess.run(["xmllint", "--noout", "--schema", xsd, *files], capture_output=True, text=True, timeout=120)
    return "" if done.returncode == 0 else done.stderr or "status %d" % done.returncode


def explanations(xsd, scenes):
    """Checks that each parameter and element that an editor offers has an explanation."""
    text = xsd.read_text(encoding="utf-8")
    attribute = r'<xs:attribute name="(?!id|file|prefix|name|value|title)'
    named = len(re.findall(attribute, text))
    explained = len(re.findall(attribute + r'[^>]*>\s*<xs:annotation>', text))
    print(
        "%d scenes and parts valid by the schema, %d parameters offered, %d explained" % (len(scenes), named, explained)
    )
    if named < 100 or explained < named:
        return ["parameters without an explanation"]
    return []


def check_schema(insula, scenes, folder):
    """Checks that the schema accepts the scenes and rejects wrong ones. Returns the texts of the failures."""
    xsd = folder / "insula.xsd"
    subprocess.run([insula, "schema", xsd], check=True, capture_output=True)
    failures = [why] if (why := refused(xsd, *scenes)) else []
    for what, text in BAD.items():
        file = folder / "bad.xml"
        file.write_text(text, encoding="utf-8")
        if not refused(xsd, file) or subprocess.run([insula, "check", file], capture_output=True).returncode != 2:
            failures.append("%s is not rejected by both" % what)
    failures += explanations(xsd, scenes)
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
    failures = check_each(insula, whole)
    if not shutil.which("xmllint"):
        print("xmllint (package libxml2-utils) is not installed: the schema is not tried")
        return 1 if failures else 0
    with tempfile.TemporaryDirectory() as name:
        for failure in check_schema(insula, scenes, pathlib.Path(name)):
            failures += 1
            print("FAILED: " + failure)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
