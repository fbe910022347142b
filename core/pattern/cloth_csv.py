"""Cloths as tables of comma-separated values: tested by a designer, and handed on."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from core.document.cloth import Cloth, Pair
from core.errors import PatternError
from core.files.atomic_write import write_text
from core.files.table_text import (
    decimal,
    header_line,
    header_values,
    is_yes,
    numbered_rows,
    percent,
    read_table_text,
)
from core.messages import Message
from core.pattern.cloth_library import cloth_of_stretch, stretch_test

HELP = Message(
    "The table requires the headings 'direction' and 'stretch %' (or '10 cm to cm'), and the rows 'across' "
    "and 'down'. The columns 'ease %' and 'stiffness' are optional, as are lines such as '# name: ...' and "
    "'# limit_percent: 20' before the headings."
)
"""What a user has to know to write a table."""

_UNFILLED = "whose it is, and when it was tested"

TEMPLATE = f"""\
# name: my cloth
# source: {_UNFILLED}
direction,10 cm to cm,ease %
across,,0
down,,0
"""
"""A table to fill in: mark 10 cm on the cloth, stretch it by hand until it resists, and read its length."""

_DIGITS = 12  # of shares that are written in %: a hundredth of a number is seldom exact

_COLUMNS = {
    "direction": re.compile(r"direction|richtung|方向", re.IGNORECASE),
    "stretch": re.compile(r"(stretch|elongation|dehnung|伸).*[%％]", re.IGNORECASE),
    "test": re.compile(r"\b10\s*cm\b", re.IGNORECASE),
    "ease": re.compile(r"(ease|ゆとり).*[%％]", re.IGNORECASE),
    "stiffness": re.compile(r"stiffness|剛", re.IGNORECASE),
}
_ROWS = {
    "across": re.compile(r"\s*(across|course|quer|横|よこ)", re.IGNORECASE),
    "down": re.compile(r"\s*(down|wale|längs|縦|たて)", re.IGNORECASE),
}


def cloth_from_csv(text: str, name: str) -> Cloth:
    """Read a table of a cloth, see ``HELP``; ``name`` is used where the text specifies none.

    Without stiffness or limit these are estimated from the stretch, and so is the cloth. Raises PatternError.
    """
    told = header_values(text)
    name = told.get("name") or name
    values = _values(text, name)
    stretch, stiffness = _stretch(values), _pair(values, "stiffness")
    given = {key: _number(told, key, name) for key in ("shear", "poisson", "limit_percent")}
    complete = None not in (stiffness, given["shear"], given["limit_percent"])
    if stretch is None and not complete:
        raise PatternError(
            Message("The table of the cloth {name} does not specify the stretch both ways.", name=name), HELP
        )
    source = told.get("source", "").replace(_UNFILLED, "")
    cloth = cloth_of_stretch(name, stretch or (0.0, 0.0), source, _pair(values, "ease", 100.0))
    shear, poisson, limit = given["shear"], given["poisson"], given["limit_percent"]
    return replace(
        cloth,
        title=told.get("title") or name,
        stiffness=(*(stiffness or cloth.stiffness[:2]), cloth.stiffness[2] if shear is None else shear),
        poisson=cloth.poisson if poisson is None else poisson,
        limit=cloth.limit if limit is None else round(limit / 100.0, _DIGITS),
        stretch=stretch,
        estimate=is_yes(told["estimate"]) if "estimate" in told else not complete,
    )


def csv_of(cloth: Cloth) -> str:
    """Return a cloth as a table that ``cloth_from_csv`` reads back as it was, its source on one line."""
    told = {
        "name": cloth.name,
        "title": cloth.title,
        "source": " ".join(cloth.source.split()),
        "estimate": "yes" if cloth.estimate else "no",
        "limit_percent": percent(cloth.limit),
        "shear": repr(cloth.stiffness[2]),
        "poisson": repr(cloth.poisson),
    }
    stretch = [percent(each) for each in cloth.stretch] if cloth.stretch else ["", ""]
    rows = [
        f"{way},{stretch[k]},{percent(cloth.ease[k])},{cloth.stiffness[k]!r}" for k, way in enumerate(_ROWS)
    ]
    heading = [header_line(key, value) for key, value in told.items()]
    return "\n".join([*heading, "direction,stretch %,ease %,stiffness", *rows]) + "\n"


def read_cloth(path: Path) -> Cloth:
    """Read a table of one's own; its name is the file's unless it specifies one. Raises PatternError."""
    return cloth_from_csv(read_table_text(path, PatternError), path.stem)


def write_cloth(path: Path, cloth: Cloth) -> None:
    """Write a cloth as a table, whole or not at all. Raises ProjectError."""
    write_text(path, csv_of(cloth), "utf-8-sig")


def write_template(path: Path) -> None:
    """Write a table to be filled in with what is tested, whole or not at all. Raises ProjectError."""
    write_text(path, TEMPLATE, "utf-8-sig")


def _values(text: str, name: str) -> dict[str, dict[str, float]]:
    """Return the numbers of both rows by their columns; empty cells are left out."""
    mark, rows = numbered_rows(text)
    if not mark:
        raise PatternError(Message("The table of the cloth {name} has no columns.", name=name), HELP)
    heading = rows[0][1]
    columns = {
        key: next((k for k, cell in enumerate(heading) if pattern.search(cell)), None)
        for key, pattern in _COLUMNS.items()
    }
    found: dict[str, dict[str, float]] = {}
    for way, pattern in _ROWS.items():
        row = next((row for row in rows[1:] if any(map(pattern.match, row[1]))), None)
        if row is None:
            raise PatternError(
                Message("The table of the cloth {name} has no row '{way}'.", name=name, way=way), HELP
            )
        found[way] = _numbers(row, columns, mark, name)
    return found


def _numbers(
    row: tuple[int, Sequence[str]], columns: Mapping[str, int | None], mark: str, name: str
) -> dict[str, float]:
    count, cells = row
    filled = {key: cells[at] for key, at in columns.items() if at is not None and at < len(cells)}
    try:
        return {
            key: decimal(cell, mark) for key, cell in filled.items() if key != "direction" and cell.strip()
        }
    except ValueError:
        raise PatternError(
            Message(
                "Row {count} of the table {name} contains a cell that is not a number.",
                count=count,
                name=name,
            ),
            HELP,
        ) from None


def _stretch(values: Mapping[str, Mapping[str, float]]) -> Pair | None:
    """Return what both rows tell of the stretch [1]: in %, or as the 10 cm test in centimetres."""
    told, test = _pair(values, "stretch", 100.0), _pair(values, "test", 0.1)
    return told or (stretch_test(*test) if test else None)


def _pair(values: Mapping[str, Mapping[str, float]], key: str, parts: float = 1.0) -> Pair | None:
    """Return a column of both rows divided by ``parts``, None if a cell of it is empty."""
    across, down = (values[way].get(key) for way in _ROWS)
    return (
        None
        if across is None or down is None
        else (round(across / parts, _DIGITS), round(down / parts, _DIGITS))
    )


def _number(told: Mapping[str, str], key: str, name: str) -> float | None:
    """Return the number above a table, None if there is none. Raises PatternError."""
    words = told.get(key, told.get(key.removesuffix("_percent"), "")).strip().removesuffix("%")
    if not words:
        return None
    try:
        return float(words.replace(",", "."))
    except ValueError:
        raise PatternError(
            Message("The {what} '{text}' of {name} is not a number.", what=key, text=words, name=name), HELP
        ) from None
