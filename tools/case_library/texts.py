# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes and README.md of a case of the library, from its entry in library.json."""
import textwrap
from xml.sax.saxutils import escape, quoteattr

import torn

RULE_FILE = "../../parts/case_rules.xml"
SCORED = ("metrics", "bleeding_metrics", "clip_metrics")


def scripted(motion):
    """Whether a motion does not come from the place that the case builder has found."""
    return "from" in motion or "clip" in motion


def branches(case):
    return [case["branches"][b] for b in ("superior", "inferior")]


def motions(case):
    """Both motions of a case, the good one first."""
    return [{**case.get("steady", {}), "motion": "steady"}, case["fails"]]


def opened(case, title, scene):
    """Head of a scene of the case: its field, and what lies beside it."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<!-- %s For training only. -->" % escape(case["about"])]
    lines += ["<scene title=%s time_step=\"16.6667 ms\">" % quoteattr(title + ": " + case["title"])]
    lines += ['  <include file="field.xml"/>']
    return lines + ["  " + line for line in case.get("scene", []) + scene]


def exercise(case, identity, title, text, difficulty):
    """First lines of the element."""
    where = (identity, title, case["site"], difficulty)
    lines = ["", '  <exercise id="%s" title="%s" site="%s" difficulty="%d"' % where]
    return lines + ["            text=%s>" % quoteattr(text)]


def rules(case, approach, file, variables=()):
    """The shared rules, with the case's branches and the limits of its approach."""
    lines = ['    <include file="%s">' % file]
    lines += ['      <variable name="branches" value="%s"/>' % " ".join(b["name"] for b in branches(case))]
    if approach["parts"]["limits"] != "brain_limits.xml":
        lines += ['      <variable name="limits" value="%s"/>' % approach["parts"]["limits"]]
    lines += ['      <variable name="%s" value="%s"/>' % v for v in variables]
    return lines + ["    </include>"]


def branch_metrics(case, identity, text, channel, statistic, better):
    """One metric of each branch; `%s` in the text is what the branch is called."""
    line = '    <channel_metric id="%s_%s" text="%s" channel="clip.%s.%s" statistic="%s" better="%s"/>'
    return [
        line % (b["name"], identity, text % b["called"], b["name"], channel, statistic, better) for b in branches(case)
    ]


def closed(names, file):
    lines = ['    <motion id="%s" file="%s_%s.csv"/>' % (name, file, name) for name in names]
    return "\n".join(lines + ["  </exercise>", "</scene>", ""])


def case_xml(case, approach):
    several = [("clips", case["clips"])] if case.get("clips", 1) > 1 else []
    lines = opened(case, "Clipping", []) + exercise(case, "clipping", "Clipping", case["text"], case["difficulty"])
    lines += rules(case, approach, RULE_FILE, several) + ["    " + line for line in case.get("rules", [])]
    lines += branch_metrics(case, "flow_least", "Least flow of the %s over that at rest", "flow", "smallest", "high")
    return "\n".join(lines) + "\n" + closed([m["motion"] for m in motions(case)], "case")


def torn_xml(case, approach, more):
    """An exercise in which the dome tears. Behind a temporary clip and in a pause of the heart no branch has its flow,
    so none is scored."""
    lines = opened(case, more["title"], ['<include file="%s"/>' % torn.CHANCE] + more.get("scene", []))
    lines += exercise(case, more["id"], more["title"], more["text"], more.get("difficulty", case["difficulty"]))
    lines += rules(case, approach, torn.RULES[more["id"]])
    lines += ["    " + line for line in case.get("rules", []) + more.get("rules", [])]
    lines += ['    <include file="../../parts/%s.xml"/>' % part for part in SCORED]
    lines += branch_metrics(case, "stenosis", "Stenosis of the %s at the end", "stenosis", "last", "low")
    return "\n".join(lines) + "\n" + closed(["steady", more["fails"]["motion"]], more["id"])


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


def called(case, branch):
    return next((b["called"] for b in branches(case) if b["name"] == branch), branch)


def how_made(case, motion):
    """Where a motion comes from that the case builder has not found."""
    if "from" in motion:
        return "`case_%s.csv` is the scripted motion `%s`." % (motion["motion"], motion["from"])
    where = "to the place at the neck"
    if "across" in motion:
        where = "across the %s, at the place" % called(case, motion["across"]["name"])
    said = "`case_%s.csv` brings the clip `%s` %s that `../library.json` states."
    return said % (motion["motion"], motion["clip"], where)


def how_moved(case, folder):
    """Where both motions come from."""
    steady, failing = motions(case)
    if scripted(steady):
        said = [how_made(case, steady)]
    else:
        said = ["The case builder found the place of the clip `%s` by playing." % torn.neck_clip(folder)[0]]
        by = shifted(steady)
        said += ["In `case_steady.csv` it is moved by %s." % by if by else "`case_steady.csv` closes it there."]
    by = "In `case_%s.csv` it is moved by %s." % (failing["motion"], shifted(failing))
    said += [how_made(case, failing) if scripted(failing) else by]
    return " ".join(said)


def exercises(case):
    """All exercises with their files, in a list."""
    lines = ["- Clipping (`case.xml`, motions `steady` and `%s`)." % case["fails"]["motion"]]
    for more in case.get("exercises", []):
        files = "`%s.xml`, motions `steady` and `%s`" % (more["id"], more["fails"]["motion"])
        lines.append(wrapped("- %s (%s): %s" % (more["title"], files, more["lesson"]), "  "))
    return "\n".join(["Exercises:", ""] + lines)


def wrapped(text, later=""):
    return textwrap.fill(text, 118, break_long_words=False, break_on_hyphens=False, subsequent_indent=later)


def readme(case, folder):
    said = how_moved(case, folder)
    parts = [case["about"], "The lesson: " + case["lesson"], said, "Sources of the sizes: " + " ".join(case["sources"])]
    head = case["title"][0].upper() + case["title"][1:]
    made = "    tools/case_library/make.py " + case["name"]
    terms = "Terms are those of the meshes: GPL-3.0-or-later for the artery, BSD-3-Clause for the lobes."
    return "\n\n".join(["# " + head] + [wrapped(p) for p in parts[:2]]
                       + ["Dimensions and options are in `../library.json`. The folder is made by", made]
                       + [wrapped(parts[2]), exercises(case), wrapped(parts[3]), terms]) + "\n"


def write(case, approach, folder):
    (folder / "case.xml").write_text(case_xml(case, approach), encoding="utf-8")
    for more in case.get("exercises", []):
        (folder / (more["id"] + ".xml")).write_text(torn_xml(case, approach, more), encoding="utf-8")
    (folder / "README.md").write_text(readme(case, folder), encoding="utf-8")
