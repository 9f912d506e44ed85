#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""extract.py PAGE MESHES FOLDER: writes the files that a page holds into FOLDER, beside a copy of the example meshes.

A file that is already as it should be is left alone, so that nothing is built again.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import pages  # noqa: E402


def put(path, data):
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_bytes() != data:
        path.write_bytes(data)


def main():
    page, meshes, folder = map(pathlib.Path, sys.argv[1:4])
    for block in pages.read(page)[0]:
        if block.role == "file":
            put(folder / block.value, block.text.encode())
    for file in (meshes / "examples").iterdir():
        put(folder / "meshes" / "examples" / file.name, file.read_bytes())


if __name__ == "__main__":
    main()
