#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""upgrade.py SOURCE BUILD: an upgrade of the Debian package keeps sessions, persons and calibrations.

An older version is installed into a root of its own by dpkg. With its programs a session is recorded and a person
added, and an arm has a calibration. Then the packages of install_packages take its place. They read all of it. What the
older version alone had is gone, and removing the package leaves the user's files alone.
"""
import json
import os
import pathlib
import re
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "docs"))
import project  # noqa: E402
from steps import run, that  # noqa: E402

CALIBRATION = {"device": "touch left", "axes": [[1, 0, 0], [0, 0, -1], [0, 1, 0]], "rest_p_m": [0, 0.1, 0],
               "rest_q": [1, 0, 0, 0], "scale": 1.5}


def older(package, work):
    """The same package as version 0.0.9, with a file that the newer one lacks."""
    tree = work / "older"
    run("dpkg-deb", "-R", package, tree)
    control = tree / "DEBIAN/control"
    control.write_text(re.sub(r"^Version: .*$", "Version: 0.0.9", control.read_text(), flags=re.M))
    (tree / "usr/share/insula/of_0.0.9").write_text("gone after the upgrade\n")
    (tree / "DEBIAN/md5sums").unlink(missing_ok=True)
    made = work / "insula_0.0.9.deb"
    run("dpkg-deb", "-Zgzip", "-z1", "--root-owner-group", "-b", tree, made)
    return made


def main():
    build = pathlib.Path(sys.argv[2])
    work = build / "tests/upgrade"
    packages = list((build / "tests/packed").glob("insula_*.deb"))
    stand_in = build / "tests/stub_libhd.so"
    if os.geteuid() != 0 or not shutil.which("dpkg") or not packages or not stand_in.exists():
        print("skipped: needs root, dpkg, the packages of install_packages and the stand-ins for devices")
        return 77
    shutil.rmtree(work, ignore_errors=True)
    root, home = work / "root", work / "home"
    for folder in (root / "var/lib/dpkg/updates", root / "var/lib/dpkg/info", root / "var/lib/dpkg/triggers", home):
        folder.mkdir(parents=True)
    (root / "var/lib/dpkg/status").touch()
    (home / "arms").write_bytes(project.arms())
    env = {**os.environ, "HOME": str(home), "INSULA_LIBHD": str(stand_in), "INSULA_STUB_BOARD": str(home / "arms")}
    for name in ("XDG_DATA_HOME", "XDG_CONFIG_HOME"):
        env.pop(name, None)

    def dpkg(*words):
        run("dpkg", "--root=%s" % root, "--force-depends", "--force-script-chrootless", "--force-unsafe-io", *words)

    def insula(*words):
        return run(root / "usr/bin/insula", *words, env=env)

    dpkg("-i", older(packages[0], work))
    that((root / "usr/share/insula/of_0.0.9").exists(), "the older version is not installed")
    session = home / ".local/share/insula/sessions/before.insula"
    session.parent.mkdir(parents=True)
    scene = root / "usr/share/insula/plugins/clip/example.xml"
    insula("run", scene, "--duration", "0.5 s", "--record", session, "--field", "person=P07")
    insula("people", "add", "P07", "--role", "resident", "--year", "3")
    calibration = home / ".config/insula/devices/touch_left.json"
    calibration.parent.mkdir(parents=True)
    calibration.write_text(json.dumps(CALIBRATION))
    before = {p: p.read_bytes() for p in (session, calibration)}

    dpkg("-i", packages[0])
    version = run("dpkg-deb", "-f", packages[0], "Version").strip()
    that("insula %s, " % version in insula("--version"), "the newer version is not installed")
    that(not (root / "usr/share/insula/of_0.0.9").exists(), "a file of the older version is still there")
    for path, content in before.items():
        that(path.read_bytes() == content, "%s has changed" % path)
    insula("session", "verify", session)
    insula("rerun", session)
    that("P07" in insula("people", "list"), "the person is lost")
    listed = insula("devices")
    that(re.search("serial number 1001.*, calibrated", listed), "the calibration is lost:\n" + listed)

    dpkg("-r", "insula")
    that(not (root / "usr/bin/insula").exists(), "the program is still there")
    that(session.exists() and (home / ".local/share/insula/training.sqlite").exists() and calibration.exists(),
         "removing the package took files of the user")
    shutil.rmtree(work, ignore_errors=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
