# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as a Parquet file, by pyarrow. Each column says its unit, and the file the title of its study."""

from __future__ import annotations

import importlib
import os
import pathlib
from typing import Any

from insula.studies.planning import Plan
from insula.studies.running import Row
from insula.studies.store import Store

NEEDED = "results in Parquet need pyarrow: pip install \"insula[studies]\""
LAST = ("simulated", "steps", "wall", "cpu", "state_hash", "scene_hash", "version", "machine", "process", "ended",
        "error")


def _pyarrow() -> Any:
    try:
        importlib.import_module("pyarrow.parquet")
        return importlib.import_module("pyarrow")
    except ImportError:
        raise RuntimeError(NEEDED) from None


def column_names(rows: list[Row]) -> list[str]:
    """What a run is, what was measured, how it went."""
    names = dict.fromkeys(k for r in rows for k in r)
    return [n for n in names if n not in LAST] + [n for n in LAST if n in names]


def _column(rows: list[Row], name: str, pyarrow: Any) -> Any:
    values = [r.get(name) for r in rows]
    kinds = {type(v) for v in values if v is not None}
    if kinds <= {bool}:
        return pyarrow.array(values, pyarrow.bool_() if kinds else pyarrow.null())
    if kinds <= {int}:
        return pyarrow.array(values, pyarrow.int64())
    if kinds <= {int, float}:
        return pyarrow.array([None if v is None else float(v) for v in values], pyarrow.float64())  # type: ignore
    return pyarrow.array([None if v is None else str(v) for v in values], pyarrow.string())


def write(store: Store, plan: Plan, rows: list[Row]) -> pathlib.Path:
    """results.parquet of these rows."""
    pyarrow = _pyarrow()
    names = column_names(rows)
    fields, arrays = [], []
    for name in names:
        array, unit = _column(rows, name, pyarrow), plan.units.get(name, "")
        arrays.append(array)
        fields.append(pyarrow.field(name, array.type, metadata={"unit": unit} if unit else None))
    schema = pyarrow.schema(fields, metadata={"study": plan.study.title, "file": str(plan.study.file)})
    file = store.folder / "results.parquet"
    part = file.with_suffix(".part")
    pyarrow.parquet.write_table(pyarrow.Table.from_arrays(arrays, schema=schema), part, compression="zstd")
    os.replace(part, file)
    return file


def needed() -> None:
    """Raises RuntimeError where pyarrow is missing, before hours of work."""
    _pyarrow()
