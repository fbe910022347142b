"""Cells of tables that other programs open: figures short, texts as texts, letters beyond English marked."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from core.document.printable_name import printable
from core.files.atomic_write import atomic_path

Table = Sequence[Sequence[str]]
"""Cells row by row, a heading first."""

ENCODING = "utf-8-sig"
"""With the mark that tells spreadsheets that letters beyond English follow."""

_FORMULA = re.compile(r"[\t\r\n]|\s*[=@＝＠＋－]|\s*[+\-](?![\d.,\s]*\d\s?%?$)")


def cell(value: object) -> object:
    """Return what stands in a cell for a value, floats in six digits; nothing for None.

    A text that a spreadsheet would work out as a formula gets an apostrophe before it: customers, lines and
    elastics may be called anything, also by somebody who sent a project.
    """
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return " ".join(str(cell(each)) for each in value)
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, str):
        return f"'{printable(value)}" if is_formula(value) else printable(value)
    return value


def is_formula(text: str) -> bool:
    """Return whether a spreadsheet would compute a text."""
    return _FORMULA.match(text) is not None


def write_table(path: Path, table: Table) -> None:
    """Write a table as comma-separated values, all of it or nothing. Raises UserError."""
    with atomic_path(path) as partial, open(partial, "w", newline="", encoding=ENCODING) as file:
        csv.writer(file).writerows([cell(each) for each in row] for row in table)


def csv_text(columns: Sequence[str], rows: Iterable[Iterable[object]]) -> str:
    """Return rows under a heading as comma-separated values, each value as ``cell`` writes it."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([cell(value) for value in row] for row in rows)
    return text.getvalue()
