"""Girdle sizes by waist and hip girth, from tables of the user's own: none with a source is known."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from core.document.printable_name import is_printable
from core.errors import SizeError, reason_of
from core.files.regular_file import read_text
from core.measurements.size_table import Step
from core.measurements.sizes import user_folder
from core.messages import Message

COLUMNS = ("size", "waist_from", "waist_to", "hip_from", "hip_to")
"""The columns of a table; girths are in cm."""

GIRTHS_OF_GIRDLES = ("waist_girth", "hip_girth")
"""The measures that a girdle size is made of."""

_LARGEST = 1_000_000  # bytes
_LONGEST = 100  # letters of the name of a size
_WIDEST = 300.0  # cm; no girth of a table is larger


@dataclass(frozen=True)
class GirdleTable:
    """Girdle sizes by the name of their file: steps [cm] of waist and of hip; where two overlap, both fit."""

    title: str
    steps: tuple[tuple[Step, Step], ...]

    def sizes(self, waist_mm: float, hip_mm: float) -> tuple[str, ...]:
        """Return the sizes that fit both girths [mm], that with the nearest middles first."""
        waist, hip = round(waist_mm / 10.0, 6), round(hip_mm / 10.0, 6)
        fitting = [pair for pair in self.steps if pair[0].is_listed(waist) and pair[1].is_listed(hip)]
        fitting.sort(key=lambda pair: abs(pair[0].middle - waist) + abs(pair[1].middle - hip))
        return tuple(pair[0].name for pair in fitting)


def read_girdle_table(path: Path) -> GirdleTable:
    """Read a CSV file with the columns ``COLUMNS``. Raises SizeError, which names the line at fault."""
    try:
        rows = csv.DictReader(read_text(path, _LARGEST, "utf-8-sig").splitlines())
        if tuple(rows.fieldnames or ()) != COLUMNS:
            raise ValueError(f"its columns must be {', '.join(COLUMNS)}")
        steps = tuple(_steps(rows.line_num, row) for row in rows)
        if not steps:
            raise ValueError("it has no sizes")
    except (OSError, ValueError, csv.Error) as problem:
        raise SizeError(
            Message("The size chart {name} cannot be read: {why}.", name=path.name, why=reason_of(problem)),
            Message("Correct the file or remove it."),
        ) from problem
    return GirdleTable(path.stem, steps)


def girdle_tables() -> tuple[list[GirdleTable], list[SizeError]]:
    """Return the tables of the user's folder of sizes, ``*.csv``, and why some cannot be read."""
    tables, problems = [], []
    for path in sorted(user_folder().glob("*.csv")):
        try:
            tables.append(read_girdle_table(path))
        except SizeError as problem:
            problems.append(problem)
    return tables, problems


def _steps(line: int, row: dict[str, str]) -> tuple[Step, Step]:
    name = (row["size"] or "").strip()
    if not name or not is_printable(name, _LONGEST):
        raise ValueError(f"line {line} has no name of a size")
    try:
        low, high, hip_low, hip_high = (float(row[column]) for column in COLUMNS[1:])
    except (TypeError, ValueError):
        raise ValueError(f"line {line} must have four numbers") from None
    if not (0.0 < low <= high <= _WIDEST and 0.0 < hip_low <= hip_high <= _WIDEST):
        raise ValueError(f"line {line} has a girth that ends before it begins, or is implausible")
    return Step(name, low, high), Step(name, hip_low, hip_high)
