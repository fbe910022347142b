"""Tables of values as people write them: lines '# key: value' above, then cells between commas."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from core.errors import UserError, reason_of
from core.files.regular_file import read_regular
from core.messages import Message

LARGEST = 1_000_000
"""Bytes of the largest table that is read."""

_TOLD = re.compile(r"#\s*([a-z][a-z_ ]*?)\s*[:=]\s*(.*?)[\s,;]*$", re.IGNORECASE)
_QUOTED = re.compile(r'^"(.*)"$')


def read_table_text(path: Path, error: type[UserError]) -> str:
    """Return the text of a table. Raises ``error`` if the file cannot be read or is not a text."""
    try:
        data = read_regular(path, LARGEST)
    except OSError as problem:
        raise error(
            Message(
                "The table {name} cannot be read: {problem}.", name=path.name, problem=reason_of(problem)
            ),
            Message("Check the name and folder of the table."),
        ) from problem
    if b"\0" in data:
        raise error(
            Message("The file {name} is not a text file.", name=path.name),
            Message("Export the table as CSV and import that file."),
        )
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp932", errors="replace")  # what spreadsheets write in Japan


def header_values(text: str) -> dict[str, str]:
    """Return the values above a table by their keys, in small letters."""
    found = (match for match in map(_TOLD.match, text.splitlines()) if match)
    return {match[1].lower().replace(" ", "_"): _QUOTED.sub(r"\1", match[2]) for match in found}


def header_line(key: str, words: str) -> str:
    """Return the line above a table that ``header_values`` reads back as these words."""
    plain = _TOLD.match(f"# {key}: {words}")
    quoted = not plain or plain[2] != words or _QUOTED.match(words)
    return f'# {key}: "{words}"' if quoted else f"# {key}: {words}"


def is_yes(word: str) -> bool:
    """Return whether a value above a table means yes."""
    return word.strip().lower() in ("yes", "true", "1")


def percent(share: float) -> str:
    """Return a share in %, rounded where that comes back as the same share."""
    short = f"{100.0 * share:.12g}"
    return short if float(short) / 100.0 == share else repr(100.0 * share)


def numbered_rows(text: str) -> tuple[str, list[tuple[int, Sequence[str]]]]:
    """Return what separates the cells, empty for one column, and the cells of each line with its number.

    Empty lines and those that begin with # are left out. A line that cannot be read has no cells: a quotation
    mark that stays open takes no other line into its cell.
    """
    numbered = [
        (count, line)
        for count, line in enumerate(text.splitlines(), start=1)
        if line.strip(" \t,;") and not line.lstrip().startswith("#")
    ]
    mark = next((mark for mark in "\t;," if numbered and mark in numbered[0][1]), "")
    return mark, [(count, _cells(line, mark or ",")) for count, line in numbered]


def decimal(cell: str, mark: str) -> float:
    """Return the number in a cell; where the comma separates no cells it is a decimal point.

    Raises ValueError.
    """
    return float(cell.strip().replace("." if mark == "," else ",", "."))


def best_names(text: str, names: Iterable[str]) -> list[str]:
    """Return the name that has the words of a text alone, or else all that have them among others."""
    every = list(names)
    words = _words(text)
    exact = [name for name in every if _words(name) == words]
    return exact or [name for name in every if words and set(words) <= set(_words(name))]


def _words(name: str) -> list[str]:
    """Return the words of a name without capitals and commas."""
    return name.casefold().replace(",", " ").split()


def _cells(line: str, mark: str) -> Sequence[str]:
    try:
        return next(csv.reader([line], delimiter=mark))
    except csv.Error:
        return ()
