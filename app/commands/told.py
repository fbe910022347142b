"""What a command found, printed or written to a file."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from core.errors import UserError
from core.project import whole_file

T = TypeVar("T")


def told(forms: Mapping[str, Callable[[T], str]], found: T, kind: str, out: str | None) -> str:
    """Return what to print of ``found``; with a file ``out`` it is written there.

    ``forms`` are "csv", "json" and, as a plain table, ""; where ``kind`` is that one the file's ending
    chooses. Raises UserError if it cannot be written.
    """
    if out is None:
        return forms[kind](found)
    if not out.strip():
        raise UserError("The place to write to has no name.", "Name a file: --out table.csv.")
    form = forms[kind or {".json": "json", ".csv": "csv"}.get(Path(out).suffix.lower(), "")]
    with whole_file(Path(out).absolute()) as partial:
        partial.write_text(form(found) + "\n", encoding="utf-8")
    return f"written to {out}"


def csv_text(columns: Sequence[str], rows: Iterable[object]) -> str:
    """Return rows as comma-separated values: what each has under the names of the columns, with a heading."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_cell(getattr(row, column)) for column in columns] for row in rows)
    return text.getvalue().rstrip("\n")


def _cell(value: object) -> object:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return " ".join(str(_cell(each)) for each in value)
    return f"{value:.6g}" if isinstance(value, float) else value
