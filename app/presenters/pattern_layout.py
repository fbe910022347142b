"""Pieces laid beside each other on the screen: in the order of the body, as large as the room allows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from core.document.block import without_side
from core.geometry.mesh import Faces, Floats, Indices
from core.geometry.plane_sections import arc_length

if TYPE_CHECKING:
    from core.pattern.flattening import FlatPanel
    from core.pattern.garment import Pattern

GAP = 14.0
"""Between pieces [mm]."""

NOTCH = 4.0
"""Length of the mark of a notch [mm]."""

_WIDTHS = 24  # of rows that are tried


@dataclass(frozen=True, eq=False)
class PieceShape:
    """A piece as it is drawn: ``points`` (p, 2) [mm] with y up, ``faces`` (m, 3), ``strain`` of each, (m,).

    ``worn`` (m, 2) is the stretch of each when worn, with the ease, across and down [1].

    ``sides`` are name of seam, points (k,), and whether it is walked that way, in order round it. ``middle``
    is where it is on the body: bearing [rad], 0 in front and positive at the subject's left, height [mm].
    ``partners`` are the piece and the number of the side that each side is sewn to, ``notches`` (n, 2, 2)
    marks from the sew line inward [mm].
    """

    name: str
    points: Floats
    faces: Faces
    strain: Floats
    limit: float
    sides: tuple[tuple[str, Indices, bool], ...]
    fits: bool
    middle: tuple[float, float]
    worn: Floats
    partners: tuple[tuple[str, int] | None, ...] = ()
    notches: Floats = field(default_factory=lambda: np.empty((0, 2, 2)))

    @property
    def size(self) -> Floats:
        """Return width and height, (2,) [mm]."""
        return np.asarray(np.ptp(self.points, axis=0))

    @cached_property
    def label_place(self) -> Floats:
        """Return a place for its title, (2,) [mm]: far from its outline, near its middle."""
        outline = np.concatenate([points[:-1] for _, points, _ in self.sides])
        away = np.linalg.norm(self.points[:, None] - self.points[outline][None, ::3], axis=2).min(axis=1)
        off = np.linalg.norm(self.points - self.points.mean(axis=0), axis=1)
        return np.asarray(self.points[int((away - 0.3 * off).argmax())])


def piece_shapes(pattern: Pattern, *, notches: bool) -> tuple[PieceShape, ...]:
    """Return the pieces of a pattern as they are drawn, with or without their notches."""
    marks = pattern.notches if notches else {}
    every = np.concatenate(pattern.places)
    axis = 0.5 * (every[:, :2].min(axis=0) + every[:, :2].max(axis=0))
    back = {(seam.panels[1], seam.sides[1]) for seam in pattern.matched.seams}
    shapes = []
    for k, (flat, places) in enumerate(zip(pattern.flats, pattern.places, strict=True)):
        x, y, z = places.mean(axis=0)
        shapes.append(
            PieceShape(
                flat.panel.name,
                flat.points,
                flat.panel.faces,
                flat.largest,
                pattern.cloths[flat.panel.cloth].limit,
                tuple(
                    (side.name, side.points, (k, at) not in back) for at, side in enumerate(flat.panel.sides)
                ),
                pattern.fits(flat),
                (float(np.arctan2(x - axis[0], axis[1] - y)), float(z)),
                flat.totals,
                tuple(side.partner for side in flat.panel.sides),
                _notch_marks(flat, marks),
            )
        )
    return tuple(shapes)


def _notch_marks(flat: FlatPanel, marks: Mapping[tuple[str, int], tuple[float, ...]]) -> Floats:
    found = []
    for number, side in enumerate(flat.panel.sides):
        for share in marks.get((flat.panel.name, number), ()):
            place, way = _along(flat.points[side.points], share)
            found.append([place, place + NOTCH * np.array([-way[1], way[0]])])
    return np.array(found).reshape(-1, 2, 2)


def joined_at(shapes: Sequence[PieceShape], seam: str, share: float) -> tuple[PieceShape, ...]:
    """Return the two pieces of a seam laid edge to edge at a share of its length [1]; none for an edge.

    The second is moved without stretching: at that place its edge touches that of the first, in line with it.
    Of a seam that joins several pairs of pieces the longest stretch is taken.
    """
    known = {shape.name: shape for shape in shapes}
    pairs = [
        (len(points), shape, points, partner)
        for shape in shapes
        for (name, points, forward), partner in zip(shape.sides, shape.partners, strict=True)
        if name == seam and forward and partner is not None
    ]
    if not pairs:
        return ()
    _, first, points, (name, number) = max(pairs, key=lambda pair: pair[0])
    second = known[name]
    others = second.sides[number][1]
    place, ahead = _along(first.points[points], share)
    other, back = _along(second.points[others], 1.0 - share)
    cos, sin = float(-ahead @ back), float(back[0] * -ahead[1] + back[1] * ahead[0])
    turn = np.array([[cos, sin], [-sin, cos]])
    points, notches = ((each - other) @ turn + place for each in (second.points, second.notches))
    return first, replace(second, points=points, notches=notches)


def _along(points: Floats, share: float) -> tuple[Floats, Floats]:
    """Return the place at a share of the length of a side and the unit direction there, (2,) and (2,)."""
    along = arc_length(points)
    at = int(np.clip(np.searchsorted(along, share * along[-1], side="right") - 1, 0, len(along) - 2))
    step = points[at + 1] - points[at]
    way = step / max(float(np.linalg.norm(step)), 1e-9)
    return points[at] + (share * along[-1] - along[at]) * way, way


def arranged(shapes: Sequence[PieceShape], aspect: float) -> Floats:
    """Return how far each piece is moved, (n, 2) [mm], in a room of an ``aspect`` of width by height.

    Pieces lie in rows from above, left and right beside each other as she is seen from the front. Of all
    widths that is taken in which they are largest.
    """
    if not shapes:
        return np.zeros((0, 2))
    units = _units(shapes)
    sizes = np.array([shape.size for shape in shapes]) + GAP
    low = np.array([shape.points.min(axis=0) for shape in shapes])
    widths = [float(sizes[unit, 0].sum()) for unit in units]
    best, moves = np.inf, -low
    for width in np.linspace(max(widths), sum(widths), _WIDTHS):
        corners, used, high = _rows(units, sizes, float(width))
        scale = max(used / max(aspect, 0.05), high)
        if scale < best - 1e-6:
            best, moves = scale, corners - low
    return np.asarray(moves)


def _units(shapes: Sequence[PieceShape]) -> list[list[int]]:
    """Return what stays beside each other, from above: her right and her left, or a piece over the middle."""
    pairs: dict[str, list[int]] = {}
    for k, shape in enumerate(shapes):
        pairs.setdefault(without_side(shape.name)[0], []).append(k)
    units = [sorted(pair, key=lambda k: shapes[k].middle[0]) for pair in pairs.values()]
    return sorted(units, key=lambda unit: -max(shapes[k].middle[1] for k in unit))


def _rows(units: Sequence[list[int]], sizes: Floats, width: float) -> tuple[Floats, float, float]:
    """Return the lower left corners of pieces in rows of at most ``width``, and width and height of all."""
    rows: list[list[int]] = []
    for unit in units:
        if rows and sizes[[*rows[-1], *unit], 0].sum() <= width + 1e-6:
            rows[-1] += unit
        else:
            rows.append([*unit])
    used = max(float(sizes[row, 0].sum()) for row in rows)
    corners, top = np.zeros((len(sizes), 2)), 0.0
    for row in rows:
        x, high = 0.5 * (used - float(sizes[row, 0].sum())), float(sizes[row, 1].max())
        for k in row:
            corners[k] = x, top - 0.5 * (high + sizes[k, 1])
            x += float(sizes[k, 0])
        top -= high
    return corners, used, -top
