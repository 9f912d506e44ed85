# SPDX-License-Identifier: GPL-3.0-or-later
"""The command `insula` of an installed package: makes studies and exports itself, hands other words to the program."""

import os
import pathlib
import sys


def main() -> None:
    if sys.argv[1:2] == ["study"]:
        from insula.studies.command import main as study

        sys.exit(study(sys.argv[2:]))
    if sys.argv[1:2] == ["export"]:
        from insula.interchange.__main__ import main as export

        sys.exit(export(sys.argv[2:]))
    program = pathlib.Path(__file__).resolve().parent / "prefix" / "bin" / "insula"
    if not program.exists():
        sys.exit("error: this is no installed package; the program is ./insula of the source tree")
    os.execv(program, [str(program), *sys.argv[1:]])


if __name__ == "__main__":
    main()
