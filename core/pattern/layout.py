"""Layout of pieces on a width, the test square in a free corner, and tiles of paper that cover them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from core.geometry.mesh import Floats
from core.pattern.allowance import CutPiece

APART = 8.0
"""What stays free between two pieces [mm]."""

EDGE = 3.0
"""What stays free between pieces and the edge of the layout [mm]."""

SQUARE = 50.0
"""Side of the square that is measured after printing [mm]."""

SQUARE_WORDS = f"{SQUARE:g} mm"
"""What is written in it: rulers have millimetres, whatever the unit in use."""

SQUARE_ROOM = (58.0, 72.0)
"""Width and height of what stays free round the square and the words below it [mm]."""

MARGIN, OVERLAP = 10.0, 10.0
"""What stays empty round a sheet of paper, and how far neighbouring sheets are glued over each other [mm]."""

PAPERS = {"a4": (210.0, 297.0), "a3": (297.0, 420.0), "letter": (215.9, 279.4)}
"""Width and height of the sheets of paper [mm]."""

_MOST_COLUMNS = 8
_STEP = 4.0  # between places that are tried for the square [mm]
_INSIDE = 4.0  # from the edge of its room to the square [mm]

Box = tuple[float, float, float, float]
"""Left, lower, right and upper end [mm]."""


@dataclass(frozen=True, eq=False)
class Layout:
    """Pieces in their places, from (0, 0) at the top left ``width`` to the right and ``height`` down, where y
    is negative, and the lower left corner of the test ``square``, (2,) [mm].
    """

    pieces: tuple[CutPiece, ...]
    width: float
    height: float
    square: Floats


@dataclass(frozen=True)
class Tile:
    """A sheet of paper; it shows the layout within a ``window``. Rows and columns are counted from 1."""

    row: int
    column: int
    window: Box

    @property
    def name(self) -> str:
        """Return what is printed on the sheet."""
        return f"{self.row}-{self.column}"


@dataclass(frozen=True, eq=False)
class Tiling:
    """A layout on ``tiles`` of paper of a ``size``, without those that would show nothing.

    ``rows`` and ``columns`` count all places of tiles.
    """

    layout: Layout
    size: tuple[float, float]
    tiles: tuple[Tile, ...]
    rows: int
    columns: int


def lay_out(pieces: Sequence[CutPiece], width: float) -> Layout:
    """Return pieces on shelves of a width [mm], the highest first; a piece that is wider widens the layout.

    The test square stands where it is free, from the top left on; if nowhere, below the pieces.
    """
    placed, used, height = _shelves(pieces, width)
    return _with_square(placed, used, height, [(0.0, -height - SQUARE_ROOM[1], used, 0.0)])


def lay_out_on_tiles(pieces: Sequence[CutPiece], paper: tuple[float, float]) -> Tiling:
    """Return pieces on as few sheets of ``paper`` as any width needs, upright or turned [mm].

    The test square stands whole on one sheet, the first that has room for it.
    """
    tries: dict[tuple[int, float, float], _Try] = {}
    for size, columns, along in product((paper, paper[::-1]), range(1, _MOST_COLUMNS + 1), (1, 0)):
        each = _try(pieces, size, columns, along)
        tries.setdefault((len(each.kept()), each.used, each.height), each)
    fewest = min(count for count, _, _ in tries)
    best = [each.tiling() for (count, _, _), each in tries.items() if count == fewest]
    return min(best, key=lambda each: (len(each.tiles), each.rows * each.columns, each.columns))


def whole_sheet(pieces: Sequence[CutPiece], width: float) -> Tiling:
    """Return pieces on one sheet that is as large as their layout on a width, with ``MARGIN`` [mm]."""
    layout = lay_out(pieces, width)
    size = (layout.width + 2.0 * MARGIN, layout.height + 2.0 * MARGIN)
    return Tiling(layout, size, (Tile(1, 1, (0.0, -layout.height, layout.width, 0.0)),), 1, 1)


def cut_shape(piece: CutPiece) -> shapely.Polygon:
    """Return the area inside the cut line."""
    return shapely.Polygon(piece.cut)


@dataclass(frozen=True, eq=False)
class _Try:
    """Pieces that take a room ``used`` wide and ``height`` high [mm] of tiles of paper of a ``size``."""

    placed: tuple[CutPiece, ...]
    used: float
    height: float
    size: tuple[float, float]
    tiles: tuple[Tile, ...]

    def kept(self, more: tuple[BaseGeometry, ...] = ()) -> tuple[Tile, ...]:
        """Return the sheets that show a piece, or one of ``more`` shapes."""
        shapes = (*map(cut_shape, self.placed), *more)
        return tuple(each for each in self.tiles if _shows(each, shapes))

    def tiling(self) -> Tiling:
        """Return the tiles with the test square on the first that has room for it."""
        layout = _with_square(self.placed, self.used, self.height, [each.window for each in self.tiles])
        kept = self.kept((shapely.box(*layout.square, *(layout.square + SQUARE)),))
        rows, columns = max(each.row for each in kept), max(each.column for each in kept)
        return Tiling(layout, self.size, kept, rows, columns)


def _try(pieces: Sequence[CutPiece], size: tuple[float, float], columns: int, along: int) -> _Try:
    """Return pieces on tiles of a number of columns at most, where the pieces are not wider."""
    window = np.array(size) - 2.0 * MARGIN
    step = window - OVERLAP
    placed, used, height = _shelves(pieces, columns * step[0] + OVERLAP, along)
    tiles = (
        Tile(row + 1, column + 1, (x, y - float(window[1]), x + float(window[0]), y))
        for row in range(_count(height, step[1]) + 1)  # one more: it has room for the square
        for column in range(_count(used, step[0]))
        for x, y in [(column * float(step[0]), -row * float(step[1]))]
    )
    return _Try(tuple(placed), used, height, size, tuple(tiles))


def _count(length: float, step: float) -> int:
    """Return how many sheets are needed for a length [mm]."""
    return max(1, math.ceil((length - OVERLAP) / step - 1e-9))


def _shows(tile: Tile, shapes: Sequence[BaseGeometry]) -> bool:
    """Return whether a sheet shows any shape where those to the left and above do not."""
    left, low, right, top = tile.window
    own = shapely.box(left + OVERLAP * (tile.column > 1), low, right, top - OVERLAP * (tile.row > 1))
    return any(own.intersects(each) for each in shapes)


def _shelves(pieces: Sequence[CutPiece], width: float, along: int = 1) -> tuple[list[CutPiece], float, float]:
    """Return pieces side by side on shelves from the top down, with the width and height that they take.

    The largest come first, by their height, or by their width if ``along`` is 0.
    """
    lows, highs = ([at(each.cut, axis=0) for each in pieces] for at in (np.min, np.max))
    sizes = [high - low for low, high in zip(lows, highs, strict=True)]
    shelves: list[list[float]] = []  # of each its top, how far right it is filled, and its height
    placed: dict[int, CutPiece] = {}
    below = EDGE
    for k in sorted(range(len(pieces)), key=lambda k: (-round(float(sizes[k][along]), 1), k)):
        wide, high = sizes[k]
        fits = (each for each in shelves if each[1] + wide + EDGE <= width and high <= each[2])
        shelf = next(fits, None)
        if shelf is None:
            shelf = [-below, EDGE, float(high)]
            shelves.append(shelf)
            below += float(high) + APART
        placed[k] = pieces[k].shifted(np.array([shelf[1] - lows[k][0], shelf[0] - highs[k][1]]))
        shelf[1] += float(wide) + APART
    used = max((each[1] - APART + EDGE for each in shelves), default=0.0)
    height = below - APART + EDGE if shelves else 0.0
    return [placed[k] for k in range(len(pieces))], max(used, SQUARE_ROOM[0]), height


def _with_square(placed: Sequence[CutPiece], used: float, height: float, boxes: Sequence[Box]) -> Layout:
    """Return the layout with its square in the first free place within one of the boxes."""
    taken = shapely.union_all([cut_shape(each) for each in placed])
    shapely.prepare(taken)
    x, y = next(place for each in boxes if (place := _free_place(taken, each)) is not None)
    square = np.array([x + _INSIDE, y - _INSIDE - SQUARE])
    return Layout(tuple(placed), max(used, x + SQUARE_ROOM[0]), max(height, SQUARE_ROOM[1] - y), square)


def _free_place(taken: BaseGeometry, box: Box) -> tuple[float, float] | None:
    """Return the upper left corner of the first free room for the square in a box, by rows, if any."""
    (left, low, right, top), (wide, high) = box, SQUARE_ROOM
    rows, columns = np.arange(top, low + high - 1e-9, -_STEP), np.arange(left, right - wide + 1e-9, _STEP)
    y, x = (each.ravel() for each in np.meshgrid(rows, columns, indexing="ij"))
    free = np.flatnonzero(~shapely.intersects(taken, shapely.box(x, y - high, x + wide, y)))
    return (float(x[free[0]]), float(y[free[0]])) if len(free) else None
