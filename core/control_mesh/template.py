"""The template: rows and columns of control points to be laid over the bust, read from data."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib import resources
from types import MappingProxyType
from typing import Any

import numpy as np

from core.control_mesh.embedding import Grid
from core.errors import FitError
from core.geometry.mesh import Faces, Flags, Indices, frozen
from core.messages import Message

TEMPLATES = ("168", "120")
"""The names of the templates: their numbers of polygons in the paper (human, mannequin)."""

FOLDS = ("none", "hull", "crease")
ONE_EACH = ("below", "fold", "line", "bust point", "edge", "above")


@dataclass(frozen=True)
class Column:
    """A column of one side, the centre first.

    Its azimuth about the torso axis is ``bust_point`` times that of the bust point plus ``outer_root`` times
    that of the outer root of the breast plus ``degrees``. ``upper_edge`` [1] is where it ends across the
    upper edge. ``fold`` tells how its fold is found: "none" is looked for, the deepest place under the convex
    "hull", or the "crease" near that; it lies at least ``room`` down the skin, in parts of the height from
    the bust row to the collar below. ``without_fold`` [1] is the height of the fold row from that collar (0)
    to the bust row (1) where there is no fold; None: as high as the folds of both sides.
    """

    meaning: str
    bust_point: float
    outer_root: float
    degrees: float
    upper_edge: float
    fold: str
    room: float
    without_fold: float | None
    free: bool


@dataclass(frozen=True)
class Row:
    """A row, the lowest first.

    ``rule`` tells where it lies and ``value`` what the rule needs: mm below the breast ("below"), above the
    fold ("edge") and above that ("above") on a body of the reference size, or the part of the way from the
    bust row to the upper edge ("upper").
    """

    rule: str
    value: float
    free: bool


@dataclass(frozen=True, eq=False)
class Template:
    """Rows and columns of control points; the points are numbered row by row, from right (-x) to left.

    ``bust_column`` is the column of the bust points, ``lines`` the row of each named line. Points are free
    where both their row and their column are.
    """

    name: str
    columns: tuple[Column, ...]
    rows: tuple[Row, ...]
    bust_column: int
    lines: Mapping[str, int]

    @property
    def half(self) -> int:
        """Return the number of the outermost column of the left side."""
        return len(self.columns) - 1

    @cached_property
    def column(self) -> Indices:
        """Return the column of each point, shape (n,): 0 is the centre, positive the subject's left."""
        return _index(np.tile(np.arange(-self.half, self.half + 1), len(self.rows)))

    @cached_property
    def row(self) -> Indices:
        """Return the row of each point, shape (n,)."""
        return _index(np.repeat(np.arange(len(self.rows)), 2 * self.half + 1))

    @cached_property
    def free(self) -> Flags:
        """Return which points may move, shape (n,)."""
        column = np.array([column.free for column in self.columns])
        row = np.array([row.free for row in self.rows])
        free: Flags = column[np.abs(self.column)] & row[self.row]
        free.setflags(write=False)
        return free

    @cached_property
    def fixed(self) -> Flags:
        """Return which points are fixed, shape (n,)."""
        fixed: Flags = ~self.free
        fixed.setflags(write=False)
        return fixed

    @cached_property
    def faces(self) -> Faces:
        """The triangles, shape (m, 3), wound outward; the diagonals of the cells point at the bust points."""
        below = self.row_of("bust point")
        faces = []
        for row in range(len(self.rows) - 1):
            for column in range(-self.half, self.half):
                a, b = self.point(row, column), self.point(row, column + 1)
                d, e = self.point(row + 1, column), self.point(row + 1, column + 1)
                outside = (column if column >= 0 else -column - 1) >= self.bust_column
                rising = (outside == (row >= below)) == (column >= 0)
                faces += [(a, b, e), (a, e, d)] if rising else [(a, b, d), (b, e, d)]
        return _index(faces)

    @cached_property
    def paths(self) -> Mapping[str, tuple[int, ...]]:
        """Return the points of each named line, from right to left, without the collar columns."""
        inner = range(1 - self.half, self.half)
        return MappingProxyType(
            {name: tuple(self.point(row, column) for column in inner) for name, row in self.lines.items()}
        )

    @cached_property
    def mirror(self) -> Indices:
        """Return the point of the other side that belongs to each, (n,)."""
        return _index(self.row * (2 * self.half + 1) - self.column + self.half)

    @property
    def grid(self) -> Grid:
        """Return rows, columns and triangles of the points."""
        return Grid(self.row, self.column, self.faces)

    def point(self, row: int, column: int) -> int:
        """Return the number of the point at a place."""
        return row * (2 * self.half + 1) + column + self.half

    def row_of(self, rule: str) -> int:
        """Return the first row with this rule."""
        return next(number for number, row in enumerate(self.rows) if row.rule == rule)


def _index(values: Any) -> Indices:
    return frozen(values, np.int64).view(np.int64)


def read_template(name: str) -> Template:
    """Return one of the TEMPLATES. Raises FitError if there is no such template."""
    if name not in TEMPLATES:
        raise FitError(
            Message("There is no template '{name}'.", name=name),
            Message("Choose one of: {choices}.", choices=", ".join(TEMPLATES)),
        )
    text = (resources.files("resources") / "templates" / f"{name}.json").read_text(encoding="utf-8")
    return parse_template(text)


def parse_template(text: str) -> Template:
    """Return the template that a JSON text describes. Raises FitError if it is not a template."""
    try:
        data = json.loads(text)
        columns = tuple(_column(entry) for entry in data["columns"])
        rows = tuple(_row(entry) for entry in data["rows"])
        order = [row.rule for row in rows]
        lines = {str(line): order.index(rule) for line, rule in data["lines"].items()}
        template = Template(
            str(data["name"]), columns, rows, int(data["bust_point_column"]), MappingProxyType(lines)
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise _refusal(f"{type(error).__name__}, {error}") from error
    _check_columns(template)
    _check_rows(template)
    return template


def _column(entry: Mapping[str, Any]) -> Column:
    azimuth, low = entry["azimuth"], entry["without_fold"]
    return Column(
        str(entry["meaning"]),
        float(azimuth.get("bust_point", 0.0)),
        float(azimuth.get("outer_root", 0.0)),
        float(azimuth.get("degrees", 0.0)),
        float(entry["upper_edge"]),
        str(entry["fold"]),
        float(entry["room"]),
        None if low is None else float(low),
        bool(entry["free"]),
    )


def _row(entry: Mapping[str, Any]) -> Row:
    return Row(str(entry["rule"]), float(entry["value"] or 0.0), bool(entry["free"]))


def _check_columns(template: Template) -> None:
    columns = template.columns
    if not 0 < template.bust_column < len(columns):
        raise _refusal("the bust points lie in no column of a side")
    centre = columns[0]
    if any((centre.bust_point, centre.outer_root, centre.degrees, centre.upper_edge)):
        raise _refusal("the first column is not the centre")
    bust = columns[template.bust_column]
    if (bust.bust_point, bust.outer_root, bust.degrees) != (1.0, 0.0, 0.0):
        raise _refusal("the column of the bust points does not run through them")
    if any(column.fold not in FOLDS for column in columns):
        raise _refusal(f"a column's fold is none of {', '.join(FOLDS)}")
    azimuths = [45.0 * column.bust_point + 80.0 * column.outer_root + column.degrees for column in columns]
    if np.any(np.diff(azimuths) <= 0.0) or np.any(np.diff([column.upper_edge for column in columns]) <= 0.0):
        raise _refusal("the columns cross")
    if any(column.free for column in columns[-2:]):
        raise _refusal("the two outermost columns must be fixed")


def _check_rows(template: Template) -> None:
    rules = [row.rule for row in template.rows]
    if [rule for rule in rules if rule != "upper"] != list(ONE_EACH) or rules[:4] != list(ONE_EACH[:4]):
        raise _refusal("the rows must be below, fold, line, bust point, upper ..., edge, above")
    parts = [0.0, *(row.value for row in template.rows if row.rule == "upper"), 1.0]
    if np.any(np.diff(parts) <= 0.0):
        raise _refusal("the rows of the upper breast do not rise")
    if any(row.free for row in (*template.rows[:2], *template.rows[-2:])):
        raise _refusal("the two lowest and the two highest rows must be fixed")


def _refusal(why: str) -> FitError:
    return FitError(Message("The template cannot be used: {why}.", why=why), Message("Reinstall Busk."))
