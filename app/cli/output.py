"""Print or write the result of a command: text tables, CSV, warnings, exit codes."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TypeVar

from core.document.printable_name import shown_line
from core.errors import UserError, reason_of
from core.export import csv_cells
from core.files.atomic_write import write_text
from core.messages import Message

T = TypeVar("T")

DONE, NOT_CONVERGED = 0, 3
"""Exit codes of a command that has converged or is done, and of one that has not or misses its targets."""

_NUMBER = re.compile(r"[-+\N{MINUS SIGN}±]?\d.*|[-\N{EN DASH}]?")


def finish(text: str, converged: bool, warnings: Iterable[Message | str] = ()) -> int:
    """Print a text, if any, then the ``warnings`` that are not a line of it; return the exit code."""
    if text:
        print(text, flush=True)
    printed = {line.strip() for line in text.splitlines()}
    warn(each for each in map(str, warnings) if each not in printed)
    return DONE if converged else NOT_CONVERGED


def warn(sentences: Iterable[str]) -> None:
    """Print warnings to the standard error."""
    for sentence in sentences:
        print(f"busk: {shown_line(sentence)}", file=sys.stderr)


def write_output(forms: Mapping[str, Callable[[T], str]], result: T, kind: str, out: str | None) -> str:
    """Return the text to print of a result; with a file ``out`` it is written there.

    ``forms`` are "csv", "json" and, as a plain table, "". An empty ``kind`` is chosen by the ending of
    ``out``. Raises UserError if the file cannot be written.
    """
    if out is None:
        return forms[kind](result)
    if not out.strip():
        raise UserError(Message("The output file has no name."), Message("Specify a file: --out table.csv."))
    form = forms[kind or {".json": "json", ".csv": "csv"}.get(Path(out).suffix.lower(), "")]
    write_text(Path(out), form(result) + "\n")
    return f"written to {out}"


def make_folder(name: str) -> Path:
    """Create an output folder, if it does not exist, and return it. Raises UserError."""
    if not name.strip():
        raise UserError(Message("The output folder has no name."), Message("Specify a folder: --out result."))
    folder = Path(name)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as why:
        raise UserError(
            Message("The folder {name} cannot be created: {problem}.", name=name, problem=reason_of(why)),
            Message("Choose another folder."),
        ) from why
    return folder


def csv_text(columns: Sequence[str], rows: Iterable[object]) -> str:
    """Return rows as CSV: the attributes named by the columns, with a heading."""
    values = ([getattr(row, column) for column in columns] for row in rows)
    return csv_cells.csv_text(columns, values).rstrip("\n")


def table_lines(table: Iterable[Sequence[str]]) -> list[str]:
    """Return rows as lines with aligned columns, the first row being the heading.

    Columns of numbers are aligned on the right, others on the left. Rows may be shorter than the heading.
    """
    rows = list(table)
    width = max(map(len, rows), default=0)
    columns = [[row[at] if at < len(row) else "" for row in rows] for at in range(width)]
    aligned = []
    for at, column in enumerate(columns):
        wide = max(map(len, column))
        right = at > 0 and all(map(_NUMBER.fullmatch, column[1:]))
        aligned.append([each.rjust(wide) if right else each.ljust(wide) for each in column])
    return ["  ".join(cells).rstrip() for cells in zip(*aligned, strict=True)]
