# SPDX-License-Identifier: GPL-3.0-or-later
"""A copy of the project in which the manual's commands run, with what they are run on; nothing of the real one is
written to."""
import gzip
import json
import os
import pathlib
import shutil
import struct

COPIED = ("bench", "curricula", "docs", "examples", "lcm_types", "meshes", "plugins", "scenes", "studies", "tools")
# `./insula` without its building and installing: what is run is built already, and the rest of the script is as it is.
BUILT = "packages() { :; }\nconfigure() { :; }\ncompile() { :; }\ncompile_configured() { :; }\nbuild_page() { :; }\n"
BUILT += "python_environment() { :; }\n\n"
WORDS = 'case "${1:-help}" in'


def make(source, build, folder):
    """`folder` becomes the project, its build/release what was built in `build`."""
    for name in COPIED:
        shutil.copytree(source / name, folder / name)
    for file in source.iterdir():
        if file.is_file():
            shutil.copy(file, folder / file.name)
    script = (source / "insula").read_text(encoding="utf-8")
    if script.count(WORDS) != 1:
        raise ValueError("./insula has no line: " + WORDS)
    (folder / "insula").write_text(script.replace(WORDS, BUILT + WORDS), encoding="utf-8")
    release = folder / "build/release"
    release.mkdir(parents=True)
    for name in ("bin", "build.ninja"):
        (release / name).symlink_to(build / name)
    (folder / "build/python-env").symlink_to(source / "build/python-env")
    (release / "CTestTestfile.cmake").write_text('subdirs("%s")\n' % build, encoding="utf-8")
    for name in ("home", "run"):
        (folder / ".user" / name).mkdir(parents=True)


def environment(build, folder, url):
    out = {k: v for k, v in os.environ.items() if not k.startswith(("INSULA_", "DISPLAY", "WAYLAND"))}
    out.update(
        HOME=str(folder / ".user/home"),
        XDG_RUNTIME_DIR=str(folder / ".user/run"),
        LCM_DEFAULT_URL=url,
        PATH="%s:%s:/usr/bin:%s" % (build / "bin", build / "tests", os.environ["PATH"]),
    )
    out.pop("XDG_CONFIG_HOME", None)
    for library in ("libhd", "libdhd", "libspnav"):
        out["INSULA_" + library.upper()] = str(build / "tests" / ("stub_%s.so" % library))
    out["INSULA_STUB_BOARD"] = str(folder / ".user/arms")
    return out


# --- fixtures ---------------------------------------------------------------------------------------------------------
def stl(source, scale):
    """The wall of a shipped artery, which is closed, as binary STL."""
    data = (source / "meshes/arteries/anterior_superior/wall.ply").read_bytes()
    head, body = data.split(b"end_header\n", 1)
    counts = {line.split()[1]: int(line.split()[2]) for line in head.decode().split("\n") if line.startswith("element")}
    at = struct.unpack_from("<%df" % (3 * counts["vertex"]), body)
    vertex = [tuple(scale * x for x in at[3 * i : 3 * i + 3]) for i in range(counts["vertex"])]
    out = [b" " * 80, struct.pack("<I", counts["face"])]
    for i in range(counts["face"]):
        corners = struct.unpack_from("<3i", body, 12 * counts["vertex"] + 13 * i + 1)
        out.append(struct.pack("<12fH", 0, 0, 0, *(x for c in corners for x in vertex[c]), 0))
    return b"".join(out)


def labels(source):
    """The same artery as a NIfTI volume of labels: balls along its centrelines, in a box that cuts its ends off."""
    lines = json.loads((source / "meshes/arteries/anterior_superior/vessel.json").read_text())["centrelines"]
    balls = [(p, r) for line in lines for p, r in zip(line["points"], line["radius"])]
    low, high, cell = (35.0, 7.8, -17.9), (57.0, 22.0, -0.5), 0.3
    size = [int((b - a) / cell) for a, b in zip(low, high)]
    voxels = bytearray(size[0] * size[1] * size[2])
    for p, r in balls:
        ranges = [
            range(max(0, int((p[k] - r - low[k]) / cell)), min(size[k], int((p[k] + r - low[k]) / cell) + 2))
            for k in range(3)
        ]
        for z in ranges[2]:
            for y in ranges[1]:
                for x in ranges[0]:
                    if sum((low[k] + cell * i - p[k]) ** 2 for k, i in enumerate((x, y, z))) <= r * r:
                        voxels[(z * size[1] + y) * size[0] + x] = 1
    head = bytearray(352)
    struct.pack_into("<i", head, 0, 348)
    struct.pack_into("<8h", head, 40, 3, *size, 1, 1, 1, 1)
    struct.pack_into("<2h", head, 70, 2, 8)  # unsigned bytes
    struct.pack_into("<8f", head, 76, 1, cell, cell, cell, 1, 1, 1, 1)
    struct.pack_into("<f", head, 108, 352)
    struct.pack_into("<B", head, 123, 2)  # mm
    struct.pack_into("<2h", head, 252, 0, 1)
    for k in range(3):
        row = [0.0, 0.0, 0.0, low[k]]
        row[k] = cell
        struct.pack_into("<4f", head, 280 + 16 * k, *row)
    head[344:348] = b"n+1\0"
    return gzip.compress(bytes(head) + bytes(voxels), 1)


def arms():
    """Two arms on the board of the stand-ins (tests/devices/stub_board.h)."""
    out = bytearray(4 * 240 + 8)
    for i, name in enumerate((b"Left Device", b"Right Device")):
        # name, model; plugged, serial, type, buttons, calibration; largest force, p, q, v, force, torque; frames, open
        struct.pack_into(
            "32s32s5i4x17dqi4x", out, 240 * i, name, b"Touch", 1, 1001 + i, 0, 0, 0, 3.3, 0, 0, 0, 1, *([0] * 12), 0, 0
        )
    return bytes(out)


def fixture(name, source, build, folder):
    if name in ("vessel.stl", "patient.stl"):
        (folder / name).write_bytes(stl(source, 1))
    elif name == "vessel_cm.stl":
        (folder / name).write_bytes(stl(source, 0.1))
    elif name == "labels.nii.gz":
        (folder / name).write_bytes(labels(source))
    elif name == "arms":
        (folder / ".user/arms").write_bytes(arms())
    elif name == "tether.so":
        (folder / "build/tether.so").symlink_to(build / "tests/manual/tether.so")
    else:
        raise ValueError("no fixture " + name)
