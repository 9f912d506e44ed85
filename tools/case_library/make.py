#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes cases of the library from scenes/cases/library.json: make.py [--again | --exercises] NAME ...

Each becomes the folder scenes/cases/NAME: artery and lobes, artery.xml, field.xml, and of each exercise the scene, a
steady motion and one that fails. insula_artery makes the artery from its dimensions. insula_case places it and finds
the clip's place by playing, unless the table states it.
--again writes texts and motions from what a former run has built. --exercises writes texts, and the motions of further
exercises, from the folder alone. docs/case-library.md describes the table.
"""
import argparse
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import placed  # noqa: E402
import texts  # noqa: E402
import torn  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "motions"))
import vectors  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASES = ROOT / "scenes" / "cases"
PROGRAMS = ROOT / "build" / "release" / "bin"
AFTERWARDS = 4.5  # s after the hand has left the field
LED = 3.5  # s from the home of the applier to the start of a motion
HELD = 9  # row of a motion of the case builder: the shut clip is still held
KEPT = ("artery", "lobes", "artery.xml", "field.xml")


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))


def artery_of(case):
    """The dimensions: an object, or the name of an entry of arteries.json."""
    spec = case["artery"]
    if isinstance(spec, str):
        spec = next(c for c in read(ROOT / "tools/artery/arteries.json")["cases"] if c["name"] == spec)
    return {**spec, "name": case["name"], "about": case["about"]}


def build(case, work):
    """Runs both programs. What the case needs lies in its folder afterwards, all else in `work`."""
    folder, artery = CASES / case["name"], artery_of(case)
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    card = folder / "case.jpg"
    picture = card.read_bytes() if card.exists() else None
    shutil.rmtree(folder, ignore_errors=True)
    table = work / "table.json"
    table.write_text(json.dumps({"about": "one case of the library", "cases": [artery]}), encoding="utf-8")
    subprocess.run([PROGRAMS / "insula_artery", "make", table, work], check=True)
    inlet = "%g %g %g mm" % tuple(artery["parent"]["points"][0])
    words = [PROGRAMS / "insula_case", "new", case["name"], work / case["name"] / "wall.ply"]
    words += ["--approach", case["approach"]]
    words += ["--in-place", "--keep", "0 mm", "--inlet", inlet, "--site", case["site"], "--out", CASES]
    for option, value in case.get("options", {}).items():
        words += ["--" + option, value]
    for region, wall in case.get("walls", {}).items():
        for parameter, value in wall.items():
            words += ["--wall", "%s.%s=%s" % (region, parameter, value)]
    if texts.scripted(case.get("steady", {})):
        words += ["--no-rehearse"]
    subprocess.run(words, check=True, cwd=ROOT)
    for path in sorted(folder.iterdir()):
        if path.name not in KEPT:
            shutil.move(path, work / path.name)
    if picture:
        card.write_bytes(picture)
    share_lobes(case, folder, work)
    name_branches(case, artery, folder)
    set_variables(case, folder)
    add_to_tray(case, folder)
    set_jaw_contacts(case, folder)


def share_lobes(case, folder, work):
    """Lobes that need not give way for the vessel are those of the approach."""
    if any(room["moved_mm"] > 0 for room in read(work / "place.json")["rooms"]):
        return
    shutil.rmtree(folder / "lobes")
    field = folder / "field.xml"
    words = '\n    <variable name="lobes" value="../cases/%s/lobes"/>\n  </include>' % case["name"]
    text = field.read_text(encoding="utf-8")
    if words not in text:
        raise SystemExit("field.xml does not name the case's lobes")
    field.write_text(text.replace(">" + words, "/>"), encoding="utf-8")


def name_branches(case, artery, folder):
    """branch_1, branch_2 become what the case calls the superior and the inferior branch of the dimensions."""
    vessel = read(folder / "artery/vessel.json")
    names = {}
    for line in vessel["centrelines"]:
        if line["to"].startswith("outlet"):
            end = line["points"][-1]
            near = min(case["branches"], key=lambda b: math.dist(artery[b]["points"][-1], end))
            names[line["name"]] = case["branches"][near]["name"]
    if len(set(names.values())) != 2:
        raise SystemExit("the branches cannot be told apart")
    for path in (folder / "artery/vessel.json", folder / "artery.xml", folder / "field.xml"):
        text = path.read_text(encoding="utf-8")
        for old, new in names.items():
            text = text.replace(old, new)
        path.write_text(text, encoding="utf-8")


def set_variables(case, folder):
    """Variables of parts, such as the force at which the bleb tears: {"bleb.xml": {"bleb_force": "0.1 N"}}."""
    path = folder / "field.xml"
    text = path.read_text(encoding="utf-8")
    for part, variables in case.get("variables", {}).items():
        head = '<include file="../../parts/%s">' % part
        if head not in text:
            raise SystemExit("field.xml does not include " + part)
        lines = ['\n    <variable name="%s" value="%s"/>' % item for item in variables.items()]
        text = text.replace(head, head + "".join(lines))
    path.write_text(text, encoding="utf-8")


def add_to_tray(case, folder):
    """Clips that the case needs beside those of the builder: first on the tray, and in each contact of clips."""
    path = folder / "field.xml"
    text = path.read_text(encoding="utf-8")
    first = re.search(r'<clip id="([^"]*)"', text)[1]
    for name in reversed(case.get("tray", [])):
        line = '<clip id="%s" model="../../../meshes/clips/%s/%s.urdf"/>\n  ' % (name, name, name)
        text = text.replace('<clip id="%s"' % first, line + '<clip id="%s"' % first)
        text = re.sub(r'(clips="|between="[^"]*?)\b%s\b' % first, lambda m: m[1] + name + " " + first, text)
        first = name
    path.write_text(text, encoding="utf-8")


def set_jaw_contacts(case, folder):
    """Most contacts of a jaw with the wall, where those of the builder are not enough."""
    if "jaw_contacts" not in case:
        return
    path = folder / "field.xml"
    text, count = re.subn(r'(<contact id="blades"[^>]*max_contacts=")\d+', r"\g<1>%d" % case["jaw_contacts"],
                          path.read_text(encoding="utf-8"))
    if count != 1:
        raise SystemExit("field.xml has no contact of blades")
    path.write_text(text, encoding="utf-8")


def moved(rows, by, then=None, shut=False):
    """A motion whose right hand is shifted by a vector, mm. `then`: that from HELD on. `shut`: blades never opened."""
    out = []
    for k, row in enumerate(rows):
        words = row.split(",")
        by = then if then and k == HELD else by
        if words[1] == "right":
            words[2:5] = ["%.6f" % (float(w) + b / 1000) for w, b in zip(words[2:5], by)]
            words[9] = "0" if shut else words[9]
        out.append(",".join(words))
    return "\n".join(out) + "\n"


def directions(vessel, approach):
    """Unit vectors at the neck: towards the dome, and towards the surgeon along the neck's plane."""
    unit = lambda v: [x / math.hypot(*v) for x in v]
    dome, view = unit(vessel["neck"]["normal"]), unit(approach["to_surgeon"])
    along = sum(a * b for a, b in zip(dome, view))
    return dome, unit([v - along * d for v, d in zip(view, dome)])


def borrowed(motion):
    """A motion that another program has made for this neck, with the clips' names of this tray."""
    text = (ROOT / motion["from"]).read_text(encoding="utf-8")
    for old, new in motion.get("clips", {}).items():
        text = text.replace("applier load %s\n" % old, "applier load %s\n" % new)
    return text


def led_from_home(text, folder, lead):
    """A motion that begins at the home of the applier, and turns the clip `lead` mm outside of its former start."""
    field = (folder / "field.xml").read_text(encoding="utf-8")
    found = re.search(r'<clip_applier [^>]*home="([^"]*) mm" shaft="([^"]*)" flat="([^"]*)"', field)
    home, shaft, flat = ([float(w) for w in found[k].split()] for k in (1, 2, 3))
    z = vectors.unit(shaft)
    x = vectors.across(flat, z)
    rows = text.split("\n")[:-1]
    first = next(k for k, row in enumerate(rows) if ",right," in row)
    p, q = ([float(w) for w in rows[first].split(",")[a:b]] for a, b in ((2, 5), (5, 9)))
    w, i, j, k = q
    out = [2 * (i * k + w * j), 2 * (j * k - w * i), 1 - 2 * (i * i + j * j)]  # the shaft in the scene
    begun = [v / 1000 for v in home] + list(vectors.quaternion(x, vectors.cross(z, x), z))
    turned = [a + lead / 1000 * b for a, b in zip(p, out)] + q
    row = lambda time, pose: "%g,right," % time + ",".join("%.6f" % v for v in pose) + ",0,0"
    later = [",".join(["%g" % (float(r.split(",")[0]) + LED)] + r.split(",")[1:]) for r in rows[first:]]
    return "\n".join(rows[:first] + [row(0.3, begun), row(1.8, turned)] + later) + "\n"


def built_rows(work):
    """The motion that the case builder has found, with time for the vessel to come to rest afterwards."""
    rows = (work / "3_clipping_steady.csv").read_text(encoding="utf-8").split("\n")[:-1]
    last, before = rows[-1].split(","), rows[-2].split(",")
    rows[-1] = ",".join(["%g" % (float(before[0]) + AFTERWARDS)] + last[1:])
    return rows


def motion_text(motion, case, approach, folder, work):
    if "from" in motion:
        return borrowed(motion)
    lead = case.get("lead_mm", 0)
    led = lambda text: led_from_home(text, folder, lead) if lead else text
    if "clip" in motion:
        return led(placed.motion(motion, folder, approach["to_surgeon"]))
    dome, out = directions(read(folder / "artery/vessel.json"), approach)
    shift = lambda m: [m.get("raise_mm", 0) * d + m.get("back_mm", 0) * o for d, o in zip(dome, out)]
    then = shift(motion["then"]) if "then" in motion else None
    return led(moved(built_rows(work), shift(motion), then, motion.get("shut", False)))


def write_motions(case, approach, folder, work):
    for motion in texts.motions(case):
        text = motion_text(motion, case, approach, folder, work)
        (folder / ("case_%s.csv" % motion["motion"])).write_text(text, encoding="utf-8")


def write_exercises(case, approach, folder):
    """Motions of the exercises beside clipping."""
    for more in case.get("exercises", []):
        for motion in ("steady", more["fails"]["motion"]):
            text = torn.text(motion, more, folder, approach)
            (folder / ("%s_%s.csv" % (more["id"], motion))).write_text(text, encoding="utf-8")


def approach_of(name):
    for path in sorted((ROOT / "meshes").glob("*/approach.json")):
        approach = read(path)
        if approach["name"] == name:
            return approach
    raise SystemExit("there is no approach " + name)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--again", action="store_true", help="write texts and motions only")
    which.add_argument("--exercises", action="store_true", help="write texts and motions of further exercises only")
    parser.add_argument("names", nargs="+", metavar="NAME")
    args = parser.parse_args()
    table = {case["name"]: case for case in read(CASES / "library.json")["cases"]}
    for name in args.names:
        case, folder, work = table[name], CASES / name, ROOT / "build" / "case_library" / name
        approach = approach_of(case["approach"])
        if not args.again and not args.exercises:
            build(case, work)
        if not args.exercises:
            write_motions(case, approach, folder, work)
            print(name, json.dumps(read(work / "scenes.json").get("clipping")))
        write_exercises(case, approach, folder)
        texts.write(case, approach, folder)


if __name__ == "__main__":
    main()
