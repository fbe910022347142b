"""The template of the lower trunk: closed rows of control points from the under-bust to the thighs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from importlib import resources
from itertools import pairwise
from types import MappingProxyType
from typing import Any

import numpy as np

from core.control_mesh.embedding import Grid
from core.errors import FitError
from core.geometry.mesh import Faces, Flags, Floats, Indices, frozen
from core.messages import Message

HALF = 11
"""The column of the back centre; columns 1 to 10 are the subject's left side, their negatives the right."""

SIDE, SEAT = 6, 9
"""The columns of the side and of the buttock point."""

AROUND = 2 * HALF
"""Points of a closed row of the trunk."""

RING = 13
"""Points of a closed row of a leg."""

RULES = (
    *("underbust", "ribs", "between", "waist", "down", "belly", "down", "hip", "low", "fold", "leg", "leg"),
)
BELLY_ROW, HIGH_HIP_ROW, HIP_ROW, FOLD_ROW = 5, 6, 7, 9
CROTCH = "crotch"

_LEG_COLUMNS = (HALF, 0, *range(1, HALF), HALF)
"""The columns that the points of a row of a leg hang under, from its inside round by the front."""

Place = tuple[int, int] | str
"""A row and a column of the trunk, or "crotch"."""


@dataclass(frozen=True)
class LowerRow:
    """A row, the highest first. ``rule`` is one of ``RULES``, ``value`` what it needs, see ``lower_rows``."""

    rule: str
    value: float
    free: bool


@dataclass(frozen=True)
class Zone:
    """A part of the volume: cells between mean ``rows`` and mean ``columns`` [1], on one side or both.

    ``kept`` [1] is how much of the volume that lines displace stays in it.
    """

    name: str
    rows: tuple[float, float]
    columns: tuple[float, float]
    side: str
    kept: float


@dataclass(frozen=True, eq=False)
class LowerTemplate:
    """Rows of the trunk, the crotch, and rows of both legs; points are numbered so, rows from the top.

    A row of the trunk has columns -10 to 11, those of legs go from the inside round by the front.
    ``front_parts`` (7,) are the shares of the hull's arc at columns 0 to 6 from front centre to side,
    ``back_parts`` (4,) those at 7, 8, 9 of the way to the buttock point and at 10 of the way from there to
    the back centre; ``leg_front`` (8,) and ``leg_back`` (5,) those of a leg's outline. ``depths`` (8, 12)
    [mm] is how deep the tissue is at rows 2 to 9, an anatomical sketch (ours). ``routes`` are the places of
    each line.
    """

    name: str
    rows: tuple[LowerRow, ...]
    front_parts: tuple[float, ...]
    back_parts: tuple[float, ...]
    leg_front: tuple[float, ...]
    leg_back: tuple[float, ...]
    depths: Floats
    zones: tuple[Zone, ...]
    routes: Mapping[str, tuple[Place, ...]]

    def point(self, row: int, column: int) -> int:
        """Return the number of a point of the trunk."""
        return row * AROUND + column + HALF - 1

    @property
    def crotch(self) -> int:
        """Return the number of the point between the legs."""
        return (FOLD_ROW + 1) * AROUND

    def leg_point(self, side: int, row: int, place: int) -> int:
        """Return the number of a point of a leg, ``side`` 0 the left one; row 10 or 11, place 0 to 12."""
        return self.crotch + 1 + (2 * side + row - FOLD_ROW - 1) * RING + place

    def loop(self, side: int, row: int) -> tuple[int, ...]:
        """Return the points of a closed row of a leg from its inside round by the front, (13,).

        That of the fold row is made of the crotch and the points of the trunk round the leg's top.
        """
        if row > FOLD_ROW:
            return tuple(self.leg_point(side, row, place) for place in range(RING))
        sign = 1 if side == 0 else -1
        columns = (0, *(sign * column for column in range(1, HALF)), HALF)
        return self.crotch, *(self.point(FOLD_ROW, column) for column in columns)

    @cached_property
    def row(self) -> Indices:
        """Return the row of each point, (n,); the crotch is in the fold row."""
        legs = np.tile(np.repeat([FOLD_ROW + 1, FOLD_ROW + 2], RING), 2)
        return _index([*np.repeat(np.arange(FOLD_ROW + 1), AROUND), FOLD_ROW, *legs])

    @cached_property
    def column(self) -> Indices:
        """Return the column of each point, (n,): positive on the subject's left, 0 and 11 the centres."""
        left = np.tile(_LEG_COLUMNS, 2)
        right = np.where((left == 0) | (left == HALF), left, -left)
        return _index([*np.tile(np.arange(1 - HALF, HALF + 1), FOLD_ROW + 1), HALF, *left, *right])

    @cached_property
    def mirror(self) -> Indices:
        """Return the point of the other side that belongs to each, (n,)."""
        trunk = np.arange(self.crotch).reshape(FOLD_ROW + 1, AROUND)
        other = np.concatenate([trunk[:, :-1][:, ::-1], trunk[:, -1:]], axis=1).ravel()
        legs = self.crotch + 1 + np.arange(4 * RING).reshape(2, -1)[::-1].ravel()
        return _index([*other, self.crotch, *legs])

    @cached_property
    def fixed(self) -> Flags:
        """Return which points are fixed, (n,): also the centres of the fold row and the crotch."""
        free = np.array([row.free for row in self.rows])[self.row]
        centre = (self.column == 0) | (self.column == HALF)
        fixed: Flags = ~free | ((self.row == FOLD_ROW) & centre)
        fixed.setflags(write=False)
        return fixed

    @property
    def free(self) -> Flags:
        """Return which points may move, (n,)."""
        return ~self.fixed

    @property
    def grid(self) -> Grid:
        """Return rows, columns and triangles of the points of the trunk."""
        return trunk_grid(self.row, self.column, self.faces)

    @cached_property
    def faces(self) -> Faces:
        """The triangles, (m, 3), wound outward; diagonals lie closest to round bellies."""
        return _index([face for cell, _, _ in self._cells for face in cell])

    @cached_property
    def zone(self) -> Indices:
        """Return the number of the zone of each triangle, (m,)."""
        return _index([self._zone_at(row, column) for _, row, column in self._cells for _ in range(2)])

    @property
    def zone_names(self) -> tuple[str, ...]:
        """Return the names of the zones."""
        return tuple(zone.name for zone in self.zones)

    @property
    def kept(self) -> Floats:
        """Return how much of the displaced volume each zone keeps, (k,) [1]."""
        return frozen([zone.kept for zone in self.zones])

    @cached_property
    def depth(self) -> Floats:
        """Return the depth of the tissue at each point, (n,) [mm]; beyond the map that of its edge."""
        return frozen(self.depths[np.clip(self.row - 2, 0, len(self.depths) - 1), np.abs(self.column)])

    @cached_property
    def paths(self) -> Mapping[str, tuple[int, ...]]:
        """Return the points of each line; a closed one ends with its first."""
        return MappingProxyType(
            {name: tuple(self._number(place) for place in route) for name, route in self.routes.items()}
        )

    def _number(self, place: Place) -> int:
        return self.crotch if isinstance(place, str) else self.point(*place)

    @cached_property
    def _cells(self) -> tuple[tuple[tuple[tuple[int, int, int], ...], float, float], ...]:
        """The cells: two triangles each, with their mean row and column [1], negative on the right."""
        return *self._trunk_cells(), *self._leg_cells()

    def _trunk_cells(self) -> Iterator[tuple[tuple[tuple[int, int, int], ...], float, float]]:
        for row in range(FOLD_ROW):
            for column in range(HALF):
                for sign in (1, -1):
                    inner, outer = sign * column, sign * (column + 1)
                    inner = HALF if inner == -HALF else inner
                    outer = HALF if outer == -HALF else outer
                    corners = [self.point(r, c) for r in (row, row + 1) for c in (inner, outer)]
                    yield _cell(corners, _points_inward(row, column), sign), row + 0.5, sign * (column + 0.5)

    def _leg_cells(self) -> Iterator[tuple[tuple[tuple[int, int, int], ...], float, float]]:
        columns = (*_LEG_COLUMNS, HALF)
        for side, sign in enumerate((1, -1)):
            for row in range(FOLD_ROW, FOLD_ROW + 2):
                upper, lower = self.loop(side, row), self.loop(side, row + 1)
                for place in range(RING):
                    after = (place + 1) % RING
                    corners = [upper[place], upper[after], lower[place], lower[after]]
                    column = 0.5 * (columns[place] + columns[place + 1])
                    crease = row == FOLD_ROW and column == SEAT + 0.5
                    yield _cell(corners, (column > SIDE) == crease, sign), row + 0.5, sign * column

    def _zone_at(self, row: float, column: float) -> int:
        side = "left" if column > 0.0 else "right"
        for number, zone in enumerate(self.zones):
            low, high = zone.rows
            first, last = zone.columns
            if low <= row < high and first <= abs(column) < last and zone.side in ("", side):
                return number
        raise _refusal("a cell is in no zone")


def trunk_grid(row: Indices, column: Indices, faces: Faces) -> Grid:
    """Return rows, columns and triangles of the trunk among those of a whole lower mesh."""
    return Grid(row, column, faces[(row[faces] <= FOLD_ROW).all(axis=1)], around=True)


def _points_inward(row: int, column: int) -> bool:
    """Return whether the diagonal of a cell goes from its upper inner to its lower outer corner."""
    if column < SIDE:
        return row < BELLY_ROW
    above, inside = row < HIP_ROW, column >= SEAT
    return above == inside


def _cell(corners: list[int], falling: bool, sign: int) -> tuple[tuple[int, int, int], ...]:
    """Return the triangles of a cell, wound outward.

    ``corners`` are upper inner, upper outer, lower inner, lower outer; ``falling`` cuts from the first to
    the last.
    """
    a, b, c, d = corners
    faces = ((a, c, d), (a, d, b)) if falling else ((a, c, b), (b, c, d))
    return faces if sign > 0 else tuple((i, k, j) for i, j, k in faces)


def _index(values: Any) -> Indices:
    return frozen(values, np.int64).view(np.int64)


@cache
def read_lower_template() -> LowerTemplate:
    """Return the template of the lower trunk."""
    text = (resources.files("resources") / "templates" / "lower.json").read_text(encoding="utf-8")
    return parse_lower_template(text)


def parse_lower_template(text: str) -> LowerTemplate:
    """Return the template that a JSON text describes. Raises FitError if it is not one."""
    try:
        data = json.loads(text)
        rows = tuple(LowerRow(str(r["rule"]), float(r["value"]), bool(r["free"])) for r in data["rows"])
        parts = {
            key: tuple(float(part) for part in data[key])
            for key in ("front_parts", "back_parts", "leg_front", "leg_back")
        }
        depths = np.array(data["depths"], dtype=np.float64)
        zones = tuple(
            Zone(str(z["name"]), _pair(z["rows"]), _pair(z["columns"]), str(z["side"]), float(z["kept"]))
            for z in data["zones"]
        )
        routes = {
            name: route for each, entry in data["lines"].items() for name, route in _routes(each, entry)
        }
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise _refusal(f"{type(error).__name__}, {error}") from error
    template = LowerTemplate(
        str(data["name"]), rows, **parts, depths=frozen(depths), zones=zones, routes=MappingProxyType(routes)
    )
    _check(template)
    return template


def _pair(values: Any) -> tuple[float, float]:
    low, high = values
    return float(low), float(high)


def _routes(name: str, entry: Mapping[str, Any]) -> Iterator[tuple[str, tuple[Place, ...]]]:
    """Yield a line by its name, or both sides of it, with its places from right to left or as it closes."""
    if "row" in entry:
        row = int(entry["row"])
        first, last = entry.get("columns", (1 - HALF, HALF))
        route = tuple((row, column) for column in range(int(first), int(last) + 1))
        yield name, route if "columns" in entry else ((row, HALF), *route)
        return
    places = [CROTCH if place == CROTCH else (int(place[0]), int(place[1])) for place in entry["each_side"]]
    yield f"{name}-left", tuple(places)
    yield f"{name}-right", tuple(_mirrored(place) for place in places)


def _mirrored(place: Place) -> Place:
    if isinstance(place, str):
        return place
    row, column = place
    return row, column if column == HALF else -column


def _check(template: LowerTemplate) -> None:
    if tuple(row.rule for row in template.rows) != RULES:
        raise _refusal(f"the rows must be {', '.join(RULES)}")
    if [row.free for row in template.rows] != [False] * 2 + [True] * 8 + [False] * 2:
        raise _refusal("the two highest and the two lowest rows must be fixed, all others free")
    parts = template.front_parts, template.leg_front, (0.0, *template.leg_back, 1.0)
    lengths = [len(part) for part in (*parts, template.back_parts)]
    if lengths != [7, 8, 7, 4] or any(np.any(np.diff(part) <= 0.0) for part in parts):
        raise _refusal("the columns cross or are not complete")
    if template.depths.shape != (8, HALF + 1) or not (template.depths > 0.0).all():
        raise _refusal("the map of depths is not complete")
    if not all(0.0 <= zone.kept <= 1.0 for zone in template.zones):
        raise _refusal("a zone keeps less than nothing or more than all")
    _check_lines(template)
    _ = template.zone


def _check_lines(template: LowerTemplate) -> None:
    for name, route in template.routes.items():
        numbered = [place for place in route if not isinstance(place, str)]
        known = all(0 <= row <= FOLD_ROW and -HALF < column <= HALF for row, column in numbered)
        if not known or len(route) < 2 or any(a == b for a, b in pairwise(route)):
            raise _refusal(f"the line {name} leaves the mesh")


def _refusal(why: str) -> FitError:
    return FitError(Message("The template cannot be used: {why}.", why=why), Message("Reinstall Busk."))
