"""Curves on the control mesh: places between control points, by row and column of the template (ours).

Rows and columns are whole numbers at control points and go evenly over each triangle, so a pair of them names
a place on the control mesh of any body. A control point is the case of two whole numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from scipy import sparse

from core.geometry.mesh import Flags, Floats, Indices

_NEAR = 1e-9
"""Places nearer to each other than this, in rows or columns, are one."""

Cell = tuple[float, float]
"""A place by its row and column of the template [1]."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Row and column of each control point, (n,), and the triangles between them, ``faces`` (m, 3).

    ``around`` tells that rows are closed: beyond the last column comes the first. Points of no triangle, such
    as those of legs, are none of the grid.
    """

    row: Indices
    column: Indices
    faces: Indices
    around: bool = False

    @cached_property
    def top(self) -> int:
        """Return the highest row."""
        return int(self.row[self.faces].max())

    @cached_property
    def half(self) -> int:
        """Return the outermost column of the left side."""
        return int(self.column[self.faces].max())

    @cached_property
    def first(self) -> int:
        """Return the outermost column of the right side."""
        return int(self.column[self.faces].min())

    @property
    def period(self) -> int:
        """Return after how many columns a closed row is round."""
        return self.half - self.first + 1

    @cached_property
    def _cells(self) -> Indices:
        """Return the two triangles of each cell between four points, (rows - 1, columns, 2)."""
        row = self.row[self.faces].min(axis=1)
        columns = self.column[self.faces]
        column = self.near(columns, columns[:, :1]).min(axis=1) - self.first
        if self.around:
            column %= self.period
        order = np.lexsort((column, row))
        return order.reshape(self.top, -1, 2)

    def near(self, columns: Any, others: Any) -> Any:
        """Return ``columns`` counted so that they are less than half way round from ``others``."""
        if not self.around:
            return columns
        return columns + self.period * np.rint((others - columns) / self.period).astype(np.int64)

    def cell(self, places: Floats) -> Indices:
        """Return the lowest row and column of the cell around each place, shape (k, 2)."""
        low, high = np.array([0, self.first]), np.array([self.top - 1, self.half - 1])
        cells = np.floor(places).astype(np.int64)
        if self.around:
            cells[:, 1] = (cells[:, 1] - self.first) % self.period + self.first
            high[1] = self.half
        return np.clip(cells, low, high)

    def triangles(self, cells: Indices) -> Indices:
        """Return the corners of the two triangles of each cell, shape (k, 2, 3)."""
        return np.asarray(self.faces[self._cells[cells[:, 0], cells[:, 1] - self.first]])

    def has_rising_diagonal(self, cell: Indices) -> bool:
        """Return whether the diagonal of a cell runs from its lowest row and column to its highest."""
        points = np.concatenate(self.triangles(cell[None])[0])
        at = self.row[points] - cell[0] + self.near(self.column[points], cell[1]) - cell[1]
        return bool((at == 0).sum() == 2)  # both triangles have that corner

    def covers(self, corners: Indices) -> Flags:
        """Return which triangles, by their ``corners`` (k, 3), are between rows of the grid."""
        return np.asarray((self.row[corners] <= self.top).all(axis=1))

    def places(self, corners: Indices, weights: Floats) -> Floats:
        """Return rows and columns, (k, 2), of places between ``corners`` (k, 3) with ``weights`` (k, 3)."""
        columns = self.column[corners]
        at = np.stack([self.row[corners], self.near(columns, columns[:, :1])], axis=2)
        found = np.asarray(np.einsum("kc,kcx->kx", weights, at))
        if self.around:
            found[:, 1] = self.half - (self.half - found[:, 1]) % self.period
        return found

    def has(self, place: Cell) -> bool:
        """Return whether the control mesh covers a position."""
        return 0.0 <= place[0] <= self.top and abs(place[1]) <= self.half

    def unrolled(self, places: Sequence[Cell]) -> list[Cell]:
        """Return places whose columns count on where a curve goes round past the last one."""
        counted = list(places[:1])
        for row, column in places[1:]:
            counted.append((row, float(self.near(column, counted[-1][1]))))
        return counted


@dataclass(frozen=True, eq=False)
class EmbeddedCurve:
    """The vertices of a free line: ``places`` (k, 2), rows and columns, and their ``weights`` (k, n).

    ``steps`` [1] is its length in rows or columns, whichever is more in each piece: the number of edges of a
    path along edges.
    """

    places: Floats
    weights: sparse.csr_array
    steps: float


def embed(grid: Grid, places: Sequence[Cell]) -> EmbeddedCurve:
    """Return a curve on the control mesh through ``places``, straight over each triangle.

    Vertices are added where it crosses an edge of the mesh, so that it stays on the triangles.
    """
    whole = np.array(_crossed(grid, grid.unrolled(places)))
    steps = float(np.abs(np.diff(whole, axis=0)).max(axis=1).sum())
    corners, weights = locate_on_grid(grid, whole)
    row = np.repeat(np.arange(len(whole)), 3)
    shape = len(whole), len(grid.row)
    matrix = sparse.csr_array((weights.ravel(), (row, corners.ravel())), shape=shape)
    matrix.eliminate_zeros()
    return EmbeddedCurve(whole, matrix, steps)


def locate_on_grid(grid: Grid, places: Floats) -> tuple[Indices, Floats]:
    """Return the corners of the triangle around each place, and the weights of the place, both (k, 3)."""
    triangles = grid.triangles(grid.cell(places))
    best, weights = triangles[:, 0], np.full((len(places), 3), -np.inf)
    for faces in np.moveaxis(triangles, 1, 0):
        columns = grid.near(grid.column[faces], places[:, 1:])
        at = np.stack([grid.row[faces], columns], axis=2).astype(np.float64)
        a, b, way = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0], places - at[:, 0]
        area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        u = (way[:, 0] * b[:, 1] - way[:, 1] * b[:, 0]) / area
        v = (a[:, 0] * way[:, 1] - a[:, 1] * way[:, 0]) / area
        shares = np.stack([1.0 - u - v, u, v], axis=1)
        better = (shares.min(axis=1) > weights.min(axis=1))[:, None]
        best, weights = np.where(better, faces, best), np.where(better, shares, weights)
    weights = np.where(weights > _NEAR, weights, 0.0)
    return best, weights / weights.sum(axis=1, keepdims=True)


def _crossed(grid: Grid, places: Sequence[Cell]) -> list[Cell]:
    """Return ``places`` with those where the way from one to the next crosses an edge of the mesh."""
    found = [places[0]]
    for start, end in pairwise(places):
        at = np.array([start, end], dtype=np.float64)
        way = at[1] - at[0]
        shares = [*_of_rows(at[:, 0]), *_of_rows(at[:, 1])]
        shares = [0.0, *sorted(share for share in shares if _NEAR < share < 1.0 - _NEAR), 1.0]
        for low, high in pairwise(shares):
            share = _diagonal(grid, at[0] + low * way, at[0] + high * way)
            for each in (low + share * (high - low), high):
                there = tuple((at[0] + each * way).tolist()) if each < 1.0 else end
                if max(abs(a - b) for a, b in zip(there, found[-1], strict=True)) > _NEAR:
                    found.append(there)
    return found


def _of_rows(ends: Floats) -> list[float]:
    """Return at which shares of the way between two ``ends`` (2,) whole numbers lie."""
    low, high = sorted(ends.tolist())
    if high - low < _NEAR:
        return []
    numbers = range(int(np.ceil(low)), int(np.floor(high)) + 1)
    return [float((number - ends[0]) / (ends[1] - ends[0])) for number in numbers]


def _diagonal(grid: Grid, start: Floats, end: Floats) -> float:
    """Return at which share of a way within a cell it crosses the diagonal of the cell, 1 if it does not."""
    middle = 0.5 * (start + end)
    cell = grid.cell(middle[None])[0]
    rising = grid.has_rising_diagonal(cell)
    base = np.array([cell[0], grid.near(cell[1], middle[1] - 0.5)])
    a, b = (float(x - y if rising else x + y - 1.0) for x, y in (start - base, end - base))
    return a / (a - b) if a * b < 0.0 and min(abs(a), abs(b)) > _NEAR else 1.0
