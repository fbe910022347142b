"""What a command found, printed or written to a file."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from core.errors import UserError
from core.export import csv_cells as cells
from core.files.atomic_write import write_text

T = TypeVar("T")


def told(forms: Mapping[str, Callable[[T], str]], found: T, kind: str, out: str | None) -> str:
    """Return what to print of ``found``; with a file ``out`` it is written there.

    ``forms`` are "csv", "json" and, as a plain table, ""; where ``kind`` is that one the file's ending
    chooses. Raises UserError if it cannot be written.
    """
    if out is None:
        return forms[kind](found)
    if not out.strip():
        raise UserError("The output folder has no name.", "Specify a file: --out table.csv.")
    form = forms[kind or {".json": "json", ".csv": "csv"}.get(Path(out).suffix.lower(), "")]
    write_text(Path(out), form(found) + "\n")
    return f"written to {out}"


def csv_text(columns: Sequence[str], rows: Iterable[object]) -> str:
    """Return rows as comma-separated values: what each has under the names of the columns, with a heading."""
    values = ([getattr(row, column) for column in columns] for row in rows)
    return cells.csv_text(columns, values).rstrip("\n")
