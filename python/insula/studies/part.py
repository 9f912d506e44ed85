# SPDX-License-Identifier: GPL-3.0-or-later
"""A task of an array job: python -m insula.studies.part FOLDER RUNS PART PARTS

It makes those runs of its part of the file RUNS that are not finished, and writes them into the folder.
"""

from __future__ import annotations

import pathlib
import sys

from insula.studies.engines.local import LocalEngine
from insula.studies.running import Row
from insula.studies.store import Store


def part_of(ids: list[str], part: int, parts: int) -> list[str]:
    """Neighbours in the plan, since these share a scene."""
    return ids[part * len(ids) // parts : (part + 1) * len(ids) // parts]


def main() -> None:
    folder, file, part, parts = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
    store = Store(folder)
    plan = store.read_plan()
    mine = set(part_of(file.read_text(encoding="utf-8").split(), part, parts))
    runs = store.open(r for r in plan.runs if r.id in mine)

    def record(row: Row) -> None:
        store.record(row)
        print("%s %s" % (row["run"], row["status"]), flush=True)

    LocalEngine(1).run(plan.study, runs, record)


if __name__ == "__main__":
    main()
