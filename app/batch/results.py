"""Results of a run as they are read back: rows by scan and variant, columns as arrays."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from app.batch.batch_design import SCHEMA_VERSION
from app.batch.design_file import damaged_error, other_version_error
from app.batch.extra import missing_error
from app.batch.schema import DESIGN, DONE
from core.errors import UserError, reason_of
from core.geometry.mesh import Floats, Indices
from core.messages import Message

_NEEDED = ("scan", "scan_sha256", "variant", "state")


@dataclass(frozen=True)
class Results:
    """The rows of one variant of a run: ``columns`` by name, numbers as arrays with NaN for unknown ones.

    ``units`` are those of the columns that are numbers. No content of a scan occurs twice among rows that are
    done: ``duplicates`` is the number of rows that were left out for that.
    """

    folder: Path
    variant: str
    columns: Mapping[str, Floats | Sequence[str]]
    units: Mapping[str, str]
    duplicates: int

    def numbers(self, name: str) -> Floats:
        """Return a column of numbers; all are NaN if the table has none of that name."""
        if name not in self.units:
            return np.full(len(self.texts("scan")), np.nan)
        return np.asarray(self.columns[name], dtype=np.float64)

    def texts(self, name: str) -> Sequence[str]:
        """Return a column of texts, empty where unknown. Raises KeyError."""
        return [str(each) for each in self.columns[name]]

    @cached_property
    def done(self) -> Indices:
        """Return the places of the rows that have results."""
        return np.flatnonzero(np.array(self.texts("state")) == DONE)


def with_mean_sides(results: Results) -> Results:
    """Return results in which numbers of left and right are one column, their mean, without the side.

    The mean of a body is unknown where one side is.
    """
    columns, units = dict(results.columns), dict[str, str]()
    for name, unit in results.units.items():
        left, right = name.replace(" right_", " left_"), name.replace(" left_", " right_")
        if left == right or not {left, right} <= set(results.units):
            units[name] = unit
        elif name == left:
            units[mean := name.replace(" left_", "_")] = unit
            columns[mean] = 0.5 * (results.numbers(left) + results.numbers(right))
    return replace(results, columns=columns, units=units)


def read_results(folder: Path) -> tuple[Results, ...]:
    """Return the results in the output folder of a run, variant by variant. Raises UserError."""
    variants = _variants(folder)
    rows, units = _read_table(folder)
    names = np.array(rows["variant"])
    unknown = set(names) - set(variants)
    if unknown:
        raise damaged_error(folder, Message("design.json does not name all variants"))
    return tuple(_of_variant(folder, each, rows, units, np.flatnonzero(names == each)) for each in variants)


def chosen_variants(results: Sequence[Results], names: Sequence[str] | None) -> list[Results]:
    """Return the results of the variants by name, all without names. Raises UserError."""
    known = {each.variant: each for each in results}
    for name in names or []:
        if name not in known:
            raise UserError(
                Message("There is no variant '{name}'.", name=name),
                Message("Variants: {names}.", names=", ".join(known)),
            )
    return [known[name] for name in dict.fromkeys(names or known)]


def _variants(folder: Path) -> list[str]:
    try:
        values = json.loads((folder / DESIGN).read_text("utf-8"))
        version, variants = values["schema_version"], [str(each["name"]) for each in values["designs"]]
    except (FileNotFoundError, NotADirectoryError) as problem:
        raise UserError(
            Message("{folder} holds no results of a batch run.", folder=str(folder)),
            Message("Specify the output folder of busk batch."),
        ) from problem
    except (OSError, ValueError, KeyError, TypeError) as problem:
        raise damaged_error(folder, reason_of(problem)) from problem
    if version != SCHEMA_VERSION:
        raise other_version_error(folder)
    return variants


def _read_table(folder: Path) -> tuple[dict[str, Any], dict[str, str]]:
    """Return columns by name, and the units of those that are numbers. Raises UserError."""
    try:
        import pyarrow as pa  # noqa: PLC0415 (an extra)

        from app.batch.parts import part_files, read_part  # noqa: PLC0415
    except ImportError as missing:
        raise missing_error(str(missing)) from missing
    tables = [read_part(part) for part in part_files(folder)]
    try:
        table = pa.concat_tables(tables) if tables else None
    except pa.ArrowException as problem:  # parts of different runs
        raise damaged_error(folder, " ".join(str(problem).split()).rstrip(".")) from problem
    if table is None or not table.num_rows:
        raise UserError(
            Message("{folder} holds no rows.", folder=str(folder)),
            Message("Run busk batch with scans first."),
        )
    if missing_columns := [name for name in _NEEDED if name not in table.column_names]:
        raise damaged_error(folder, Message("column {name} is missing", name=missing_columns[0]))
    units = {
        field.name: (field.metadata or {}).get(b"unit", b"").decode()
        for field in table.schema
        if pa.types.is_floating(field.type)
    }
    return {
        name: table.column(name).to_numpy() if name in units else _texts(table.column(name).to_pylist())
        for name in table.column_names
    }, units


def _texts(values: Sequence[Any]) -> list[str]:
    return ["" if value is None else str(value) for value in values]


def _of_variant(
    folder: Path, variant: str, rows: Mapping[str, Any], units: Mapping[str, str], places: Indices
) -> Results:
    """Return the rows of a variant sorted by scan; of equal scans that are done the first one stays."""
    states, digests, scans = rows["state"], rows["scan_sha256"], rows["scan"]
    kept, seen = [], set[str]()
    for at in sorted(map(int, places), key=lambda at: (scans[at], at)):
        if states[at] == DONE and digests[at] in seen:
            continue
        seen |= {digests[at]} if states[at] == DONE and digests[at] else set()
        kept.append(at)
    columns = {
        name: np.asarray(column, dtype=np.float64)[kept] if name in units else [column[at] for at in kept]
        for name, column in rows.items()
    }
    return Results(folder, variant, columns, units, len(places) - len(kept))
