"""Pieces laid beside each other on the screen: in the order of the body, as large as the room allows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Faces, Floats, Indices
from core.pattern.garment import Pattern

GAP = 14.0
"""Between pieces [mm]."""

_WIDTHS = 24  # of rows that are tried
_ROW = 22.0  # pieces whose middles on the body differ less in height are of one row [mm]


@dataclass(frozen=True, eq=False)
class PieceShape:
    """A piece as it is drawn: ``points`` (p, 2) [mm] with y up, ``faces`` (m, 3), ``strain`` of each, (m,).

    ``sides`` are name of seam and points, (k,), in order round it. ``middle`` is where it is on the body:
    bearing [rad], 0 in front and positive at the subject's left, and height [mm].
    """

    name: str
    points: Floats
    faces: Faces
    strain: Floats
    limit: float
    sides: tuple[tuple[str, Indices], ...]
    fits: bool
    middle: tuple[float, float]

    @property
    def size(self) -> Floats:
        """Return width and height, (2,) [mm]."""
        return np.asarray(np.ptp(self.points, axis=0))


def piece_shapes(pattern: Pattern) -> tuple[PieceShape, ...]:
    """Return the pieces of a pattern as they are drawn."""
    every = np.concatenate(pattern.places)
    axis = 0.5 * (every[:, :2].min(axis=0) + every[:, :2].max(axis=0))
    shapes = []
    for flat, places in zip(pattern.flats, pattern.places, strict=True):
        x, y, z = places.mean(axis=0)
        shapes.append(
            PieceShape(
                flat.panel.name,
                flat.points,
                flat.panel.faces,
                flat.largest,
                pattern.cloths[flat.panel.cloth].limit,
                tuple((side.name, side.points) for side in flat.panel.sides),
                pattern.fits(flat),
                (float(np.arctan2(x - axis[0], axis[1] - y)), float(z)),
            )
        )
    return tuple(shapes)


def arranged(shapes: Sequence[PieceShape], aspect: float) -> Floats:
    """Return how far each piece is moved, (n, 2) [mm], in a room of an ``aspect`` of width by height.

    Pieces lie in rows from above, in a row from the subject's right to her left as she is seen from the
    front. Of all widths that is taken in which they are largest.
    """
    if not shapes:
        return np.zeros((0, 2))
    order = _order(shapes)
    sizes = np.array([shape.size for shape in shapes]) + GAP
    low = np.array([shape.points.min(axis=0) for shape in shapes])
    best, moves = np.inf, -low
    for width in np.linspace(sizes[:, 0].max(), sizes[:, 0].sum(), _WIDTHS):
        corners, used, high = _rows(order, sizes, float(width))
        scale = max(used / max(aspect, 0.05), high)
        if scale < best - 1e-6:
            best, moves = scale, corners - low
    return np.asarray(moves)


def _order(shapes: Sequence[PieceShape]) -> list[int]:
    """Return pieces from above, those of about one height from her right to her left."""
    down = sorted(range(len(shapes)), key=lambda k: -shapes[k].middle[1])
    rows: list[list[int]] = []
    for k in down:
        if rows and shapes[rows[-1][0]].middle[1] - shapes[k].middle[1] < _ROW:
            rows[-1].append(k)
        else:
            rows.append([k])
    return [k for row in rows for k in sorted(row, key=lambda k: shapes[k].middle[0])]


def _rows(order: Sequence[int], sizes: Floats, width: float) -> tuple[Floats, float, float]:
    """Return the lower left corners of pieces in rows of at most ``width``, and width and height of all."""
    rows: list[list[int]] = []
    for k in order:
        if rows and sizes[[*rows[-1], k], 0].sum() <= width + 1e-6:
            rows[-1].append(k)
        else:
            rows.append([k])
    used = max(float(sizes[row, 0].sum()) for row in rows)
    corners, top = np.zeros((len(sizes), 2)), 0.0
    for row in rows:
        x, high = 0.5 * (used - float(sizes[row, 0].sum())), float(sizes[row, 1].max())
        for k in row:
            corners[k] = x, top - 0.5 * (high + sizes[k, 1])
            x += float(sizes[k, 0])
        top -= high
    return corners, used, -top
