"""Own lines as text: control points by number, or by row and column of the template."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import groupby

from core.design_lines import OwnLine
from core.errors import LineError
from core.template import Template

HELP = (
    "NAME=POINT,POINT,...[,closed]: a line of your own, straight from control point to control point. A "
    "POINT is its number, or its place like r2c-3: row 2 from below, column 3 on the subject's right (c0 is "
    "the middle); r2c-3:r2c3 goes along a row or a column. control.csv lists them all. Set its length with "
    "--line NAME=LENGTH, else it is measured only"
)
"""What a user has to know to write an own line."""

_PLACE = re.compile(r"r(\d+)c([+-]?\d+)")
_ASK = "Write NAME=r2c-3,r3c0,r2c3 or NAME=28,45,34, with ,closed at the end for a line that goes round."


def own_line(text: str, template: Template) -> OwnLine:
    """Read ``NAME=POINT,POINT,...[,closed]`` on a template (ours). Raises LineError, see ``HELP``."""
    name, equals, path = text.replace("\N{MINUS SIGN}", "-").partition("=")
    name, words = name.strip().lower(), path.lower().replace(" ", "").split(",")
    closed = words[-1] == "closed"
    words = words[:-1] if closed else words
    if not equals or not name or not words or not all(words):
        raise LineError(f"'{text}' is no line.", _ASK)
    points = [point for word in words for point in _walk(word, template)]
    return OwnLine(name, tuple(points), closed)


def place_of(point: int, template: Template) -> str:
    """Return how a control point is written: r2c-3."""
    return f"r{template.row[point]}c{template.column[point]}"


def mirrored(points: Sequence[int], template: Template) -> tuple[int, ...]:
    """Return the control points of the other side, in the same order."""
    return tuple(template.point(int(template.row[point]), -int(template.column[point])) for point in points)


def _walk(word: str, template: Template) -> list[int]:
    """Return the points of one word: one, or all from one to the other along a row or a column."""
    ends = [_point(each, template) for each in word.split(":")]
    if len(ends) == 1:
        return ends
    (row, column), (to_row, to_column) = (
        (int(template.row[end]), int(template.column[end])) for end in (ends[0], ends[-1])
    )
    if len(ends) != 2 or (row == to_row) == (column == to_column):
        raise LineError(f"'{word}' does not go along a row or a column.", "Name its points one by one.")
    rows, columns = _steps(row, to_row), _steps(column, to_column)
    return [template.point(r, c) for r in rows for c in columns]


def _steps(start: int, end: int) -> range:
    step = 1 if end >= start else -1
    return range(start, end + step, step)


def _point(word: str, template: Template) -> int:
    """Return the number of the control point that a word names."""
    match = _PLACE.fullmatch(word)
    if match is None:
        count = len(template.row)
        if not word.isdecimal() or not int(word) < count:
            raise LineError(
                f"'{word}' is no control point of the template {template.name}.",
                f"Its points are 0 to {count - 1}, or places like r2c-3. {_ASK}",
            )
        return int(word)
    row, column = int(match[1]), int(match[2])
    if not (row < len(template.rows) and abs(column) <= template.half):
        raise LineError(
            f"The template {template.name} has no place '{word}'.",
            f"Its rows are 0 to {len(template.rows) - 1}, its columns {-template.half} to {template.half}.",
        )
    return template.point(row, column)


def ready_made(template: Template) -> dict[str, tuple[OwnLine, ...]]:
    """Return lines that garments have, a pair of each, by kind (ours): they go where the template has rows.

    "straps" rise through the bust points, "slings" hang round each breast from the upper edge, "obliques" go
    from the side under the bust point and up inside it, "rings" are closed round the bust point.
    """
    low, bust = template.lines["mid-bust"], template.row_of("bust point")
    top, side, tip = template.row_of("edge"), template.half - 1, template.bust_column
    up = range(low, top + 1)
    around = [(bust - 1, column) for column in range(tip - 1, tip + 2)] + [(bust, tip + 1)]
    around += [(bust + 1, column) for column in range(tip + 1, tip - 2, -1)] + [(bust, tip - 1)]
    inner = max(tip - 2, 1)
    rising = [(bust, tip - 1), *((row, inner) for row in range(bust + 1, top + 1))]
    kinds = {
        "strap": [(row, tip) for row in up],
        "sling": [*((row, tip + 1) for row in reversed(up)), (low, tip), *((row, tip - 1) for row in up)],
        "oblique": [(low, column) for column in range(side, tip - 1, -1)] + rising,
        "ring": around,
    }
    sides = (("left", 1), ("right", -1))
    return {
        f"{kind}s": tuple(
            OwnLine(f"{kind} {word}", _places(cells, sign, template), kind == "ring") for word, sign in sides
        )
        for kind, cells in kinds.items()
    }


def _places(cells: list[tuple[int, int]], sign: int, template: Template) -> tuple[int, ...]:
    points = [template.point(row, sign * column) for row, column in cells]
    return tuple(point for point, _ in groupby(points))
