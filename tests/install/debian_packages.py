#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""debian_packages.py BUILD CMAKE: makes the Debian packages and looks into them: what they hold, what they depend on,
and whether the program and the CMake package work from where they unpack.
"""
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from steps import run, that  # noqa: E402


def main():
    build, cmake = pathlib.Path(sys.argv[1]), sys.argv[2]
    if not shutil.which("dpkg-deb") or not shutil.which("dpkg-shlibdeps"):
        print("no Debian tools here: skipped")
        return 77
    work = build / "tests/packed"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    run(pathlib.Path(cmake).with_name("cpack"), "-G", "DEB", "-B", work, cwd=build)
    packages = {p.name.split("_")[0]: p for p in work.glob("*.deb")}
    that(set(packages) == {"insula", "insula-dev"}, "made: %s" % sorted(packages))
    root = work / "root"
    for p in packages.values():
        run("dpkg-deb", "-x", p, root)
    needs = run("dpkg-deb", "-f", packages["insula"], "Depends")
    for library in ("libc6", "libassimp5", "liburdfdom", "libcholmod", "libfmt"):
        that(library in needs, "insula does not depend on %s: %s" % (library, needs))
    needs = run("dpkg-deb", "-f", packages["insula-dev"], "Depends")
    that("insula (= " in needs and "libeigen3-dev" in needs, "insula-dev depends on " + needs)
    for name in (
        "bin/insula",
        "bin/haptic_server",
        "bin/gateway",
        "share/applications/insula.desktop",
        "share/icons/hicolor/scalable/apps/insula.svg",
        "share/insula/scenes/training/1_sylvian_fissure.xml",
        "share/insula/curricula/residency_year.xml",
        "share/insula/docs/README.md",
        "share/insula/meshes/examples/block.msh",
        "include/insula/core/registry/registry.h",
        "include/insula/insula_headers.h",
        "lib/cmake/Insula/InsulaConfig.cmake",
    ):
        that((root / "usr" / name).exists(), "usr/%s is in no package" % name)
    insula = root / "usr/bin/insula"
    version = run("dpkg-deb", "-f", packages["insula"], "Version").strip()
    that("insula %s, " % version in run(insula, "--version"), "insula --version does not say " + version)
    if shutil.which("desktop-file-validate"):
        run("desktop-file-validate", root / "usr/share/applications/insula.desktop")
    run(insula, "check", root / "usr/share/insula/plugins/clip/example.xml")
    run(insula, "new-plugin", "stay", "--kind", "constraint", cwd=work)
    run(cmake, "-S", work / "stay", "-B", work / "stay/build", "-G", "Ninja", "-DCMAKE_PREFIX_PATH=%s" % (root / "usr"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
