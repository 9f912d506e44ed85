# SPDX-License-Identifier: GPL-3.0-or-later
"""case.xml and README.md of a case of the library, from its entry in library.json."""
import json
import textwrap
from xml.sax.saxutils import escape, quoteattr

RULE_FILE = "../../parts/case_rules.xml"


def scripted(motion):
    """Whether a motion does not come from the place that the case builder has found."""
    return "from" in motion or "clip" in motion


def motions(case):
    """Both motions of a case, the good one first."""
    return [{**case.get("steady", {}), "motion": "steady"}, case["fails"]]


def case_xml(case, approach):
    branches = [case["branches"][b] for b in ("superior", "inferior")]
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<!-- %s For training only. -->" % escape(case["about"])]
    lines += ["<scene title=%s time_step=\"16.6667 ms\">" % quoteattr("Clipping: " + case["title"])]
    lines += ['  <include file="field.xml"/>']
    lines += ["  " + line for line in case.get("scene", [])]
    where = (case["site"], case["difficulty"])
    lines += ["", '  <exercise id="clipping" title="Clipping" site="%s" difficulty="%d"' % where]
    lines += ["            text=%s>" % quoteattr(case["text"])]
    lines += ['    <include file="%s">' % RULE_FILE]
    lines += ['      <variable name="branches" value="%s"/>' % " ".join(b["name"] for b in branches)]
    if approach["parts"]["limits"] != "brain_limits.xml":
        lines += ['      <variable name="limits" value="%s"/>' % approach["parts"]["limits"]]
    if case.get("clips", 1) > 1:
        lines += ['      <variable name="clips" value="%d"/>' % case["clips"]]
    lines += ["    </include>"]
    lines += ["    " + line for line in case.get("rules", [])]
    for b in branches:
        words = (b["name"], b["called"], b["name"])
        lines += [
            '    <channel_metric id="%s_flow_least" text="Least flow of the %s over that at rest" '
            'channel="clip.%s.flow" statistic="smallest" better="high"/>' % words
        ]
    for motion in motions(case):
        lines += ['    <motion id="%s" file="case_%s.csv"/>' % (motion["motion"], motion["motion"])]
    return "\n".join(lines + ["  </exercise>", "</scene>", ""])


def shifted(motion):
    """What was moved from the found place, in words."""
    words = []
    if motion.get("raise_mm"):
        where = "towards the dome" if motion["raise_mm"] > 0 else "towards the parent"
        words.append("%g mm %s" % (abs(motion["raise_mm"]), where))
    if motion.get("back_mm"):
        where = "towards the surgeon" if motion["back_mm"] > 0 else "away from the surgeon"
        words.append("%g mm %s" % (abs(motion["back_mm"]), where))
    if motion.get("shut"):
        words.append("with shut blades")
    if motion.get("then"):
        words.append("then by " + shifted(motion["then"]))
    return ", ".join(words)


def how_made(motion):
    """Where a motion comes from that the case builder has not found."""
    if "from" in motion:
        return "`case_%s.csv` is the scripted motion `%s`." % (motion["motion"], motion["from"])
    said = "`case_%s.csv` brings the clip `%s` to the place at the neck that `../library.json` states."
    return said % (motion["motion"], motion["clip"])


def how_moved(case, work):
    """Where both motions come from."""
    steady, failing = motions(case)
    if scripted(steady):
        said = [how_made(steady)]
    else:
        clip = json.loads((work / "scenes.json").read_text(encoding="utf-8"))["clip"]["name"]
        said = ["The case builder found the place of the clip `%s` by playing." % clip]
        by = shifted(steady)
        said += ["In `case_steady.csv` it is moved by %s." % by if by else "`case_steady.csv` closes it there."]
    by = "In `case_%s.csv` it is moved by %s." % (failing["motion"], shifted(failing))
    said += [how_made(failing) if scripted(failing) else by]
    return " ".join(said)


def readme(case, work):
    said = how_moved(case, work)
    parts = [case["about"], "The lesson: " + case["lesson"], said, "Sources of the sizes: " + " ".join(case["sources"])]
    wrap = lambda text: textwrap.fill(text, 118, break_long_words=False, break_on_hyphens=False)
    head = case["title"][0].upper() + case["title"][1:]
    made = "    tools/case_library/make.py " + case["name"]
    terms = "Terms are those of the meshes: GPL-3.0-or-later for the artery, BSD-3-Clause for the lobes."
    return "\n\n".join(["# " + head] + [wrap(p) for p in parts[:2]]
                       + ["Dimensions and options are in `../library.json`. The folder is made by", made]
                       + [wrap(p) for p in parts[2:]] + [terms]) + "\n"


def write(case, approach, folder, work):
    (folder / "case.xml").write_text(case_xml(case, approach), encoding="utf-8")
    (folder / "README.md").write_text(readme(case, work), encoding="utf-8")
