"""Seam allowance: the cut line round a piece, as wide as each side needs, with corners that can be sewn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from core.errors import PatternError
from core.geometry.mesh import Floats
from core.geometry.plane_sections import arc_length
from core.messages import Message
from core.pattern.piece import Piece, Points2, Side, signed_area

MITRE = 2.5
"""How far a corner of the cut line is from that of the sew line at most, in allowances [1]; then a bevel."""

BLEND = 15.0
"""Along how much of the narrower side its allowance grows to a wider one [mm]."""

NEARLY_STRAIGHT = float(np.radians(40.0))
"""Where the outline turns by less, two allowances of different width would make a step."""

CLOSED = 0.5
"""Gaps of twice this width between the allowances of two sides are cut as one [mm]."""

_GRID = 1e-6  # of unions [mm]: without one they lose parts of shapes that nearly touch
_SAME = 1e-3  # from the cut line to points of it that are left out at most [mm]
_SLANTED = float(np.radians(70.0))  # beyond it the end of a wide allowance is no step but a corner
_LEAST_MARK = 2.0  # of a notch where there is no allowance [mm]
_DEPTH = 4.0  # from the cut line inward [mm]


@dataclass(frozen=True, eq=False)
class CutPiece:
    """A piece as it is cut: ``cut`` (n, 2) is the cut line, counter-clockwise, its first point not repeated;
    ``notches`` (k, 2, 2) lead from the cut line inward, side by side in their order [mm].
    """

    piece: Piece
    cut: Points2
    notches: Floats

    def shifted(self, by: Floats) -> CutPiece:
        """Return the piece moved by (2,) [mm]."""
        return CutPiece(self.piece.moved(lambda places: places + by), self.cut + by, self.notches + by)


def cut_piece(piece: Piece) -> CutPiece:
    """Return a piece with its cut line and the marks of its notches.

    Raises PatternError where its outline overlaps itself.
    """
    shape = _cut_shape(piece)
    ring = np.asarray(shapely.get_coordinates(shape.exterior))[:-1]
    cut = ring if signed_area(ring) > 0.0 else ring[::-1]
    marks = [_mark(side, share, shape) for side in piece.sides for share in side.notches]
    return CutPiece(piece, cut, np.array(marks).reshape(-1, 2, 2))


def sew_shape(piece: Piece) -> shapely.Polygon:
    """Return the area inside the sew line. Raises PatternError where the outline overlaps itself."""
    shape = shapely.Polygon(piece.outline)
    if not shape.is_valid or signed_area(piece.outline) <= 0.0:
        raise PatternError(
            Message("The outline of the piece '{name}' overlaps itself.", name=piece.key),
            Message("Move the dart or add a seam, so that the piece becomes flatter."),
        )
    return shape


def _cut_shape(piece: Piece) -> shapely.Polygon:
    strips = [shapely.convex_hull(shapely.MultiPoint(each)) for each in _strips(piece)]
    sewn = sew_shape(piece)
    parts = [sewn, *(each for each in strips if shapely.get_dimensions(each) == 2)]
    whole = shapely.union_all(parts, grid_size=_GRID)
    # Strips that only touch leave hair cracks, through which the cut line would come to the sew line.
    style = {"join_style": "mitre", "mitre_limit": 5.0}
    closed = shapely.union(whole.buffer(CLOSED, **style).buffer(-CLOSED, **style), whole, grid_size=_GRID)
    cut = shapely.Polygon(_largest(closed).exterior).simplify(_SAME)
    # Leaving points out cuts corners off, also of a sew line without allowance, where each has to stay.
    whole = shapely.union(cut, sewn, grid_size=_GRID)
    return shapely.Polygon(_largest(whole).exterior).simplify(_GRID)


def _largest(shape: BaseGeometry) -> shapely.Polygon:
    parts = [each for each in shapely.get_parts(shape) if isinstance(each, shapely.Polygon)]
    return max(parts, key=lambda each: each.area)


def _strips(piece: Piece) -> Iterator[Floats]:
    """Yield the corners of convex parts that together are the allowance, each (k, 2) [mm]."""
    sides = [_without_repeats(each) for each in piece.sides]
    widths = _widths(piece, sides)
    starts = np.concatenate([each[:-1] for each in sides])
    ends = np.concatenate([each[1:] for each in sides])
    first = np.concatenate([each[:-1] for each in widths])
    last = np.concatenate([each[1:] for each in widths])
    ways = (ends - starts) / np.linalg.norm(ends - starts, axis=1, keepdims=True)
    out = np.stack([ways[:, 1], -ways[:, 0]], axis=1)
    for k in range(len(starts)):
        before = k - 1
        if max(first[k], last[k]) > 0.0:
            ends_out = starts[k] + out[k] * first[k], ends[k] + out[k] * last[k]
            yield np.array([starts[k], ends[k], ends_out[1], ends_out[0]])
        if max(last[before], first[k]) > 0.0:
            yield from _corner(starts[k], ways[[before, k]], out[[before, k]], (last[before], first[k]))


def _corner(place: Floats, ways: Floats, out: Floats, widths: tuple[float, float]) -> Iterator[Floats]:
    """Yield what fills a corner between two strips: a mitre, or a bevel at ``MITRE`` widths.

    The strips end at ``place`` (2,); ``ways`` and ``out`` (2, 2) are their directions along and outward.
    """
    sine = float(ways[0, 0] * ways[1, 1] - ways[0, 1] * ways[1, 0])
    cosine = float(ways[0] @ ways[1])
    feet = place + out * np.array(widths)[:, None]
    if abs(sine) < 1e-6 and cosine > 0.0:
        return
    reach = MITRE * max(widths)
    beyond = (np.array(widths[::-1]) - np.array(widths) * cosine) / (sine if abs(sine) > 1e-9 else 1e-9)
    tip = feet[0] + beyond[0] * ways[0]
    if sine < 0.0 and beyond.max() <= 0.0 and cosine > -1.0:  # the strips cross each other
        return
    if np.linalg.norm(tip - place) <= reach:
        yield np.array([place, feet[0], feet[1], tip])
    elif sine > 0.0:
        middle = ways[0] - ways[1]
        middle = middle / np.linalg.norm(middle)
        onward = np.array([middle @ ways[0], -(middle @ ways[1])])
        steps = np.maximum((reach - (feet - place) @ middle) / np.maximum(onward, 1e-9), 0.0)
        yield np.array([place, *feet, feet[0] + steps[0] * ways[0], feet[1] - steps[1] * ways[1]])


def _widths(piece: Piece, sides: list[Points2]) -> list[Floats]:
    """Return the allowance at each point of each side, which grows to a wider one where that goes on [mm]."""
    own = [each.allowance for each in piece.sides]
    found = []
    for k, points in enumerate(sides):
        after = (k + 1) % len(sides)
        along = arc_length(points)
        width = np.full(len(points), own[k])
        for other, way, distance in ((k - 1, (k - 1, k), along), (after, (k, after), along[-1] - along)):
            if own[other] > own[k] and _makes_step(sides[way[0]], sides[way[1]], own[k] / own[other]):
                share = np.clip(1.0 - distance / min(BLEND, along[-1]), 0.0, 1.0)
                width = np.maximum(width, own[k] + share * (own[other] - own[k]))
        found.append(width)
    return found


def _makes_step(before: Points2, after: Points2, ratio: float) -> bool:
    """Return whether allowances of a ``ratio`` below 1 would make a step between two sides.

    They would where the outline turns little, and where it turns outward and the wider one ends far beyond
    the line of the other.
    """
    a, b = before[-1] - before[-2], after[1] - after[0]
    turn = float(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b))
    return abs(turn) < NEARLY_STRAIGHT or (0.0 < turn < _SLANTED and ratio < np.cos(turn))


def _without_repeats(side: Side) -> Points2:
    """Return the points of a side without repeated ones, and with one wherever its width begins to blend."""
    along = arc_length(side.points)
    kept = np.concatenate([[True], np.diff(along) > 1e-9])
    points, along = side.points[kept], along[kept]
    more = [each for each in (BLEND, along[-1] - BLEND) if 0.0 < each < along[-1]]
    at = np.union1d(along, more)
    return np.stack([np.interp(at, along, column) for column in points.T], axis=1)


def _mark(side: Side, share: float, shape: shapely.Polygon) -> Floats:
    """Return the mark of a notch, from the cut line inward, (2, 2) [mm]."""
    place, out = side.place(share)
    reach = 3.0 * side.allowance + 1.0
    beam = shapely.LineString([place, place + reach * out]).intersection(shape.exterior)
    hits = (shapely.get_coordinates(beam) - place) @ out
    away = float(hits.min()) if len(hits) else side.allowance
    depth = min(_DEPTH, max(away, _LEAST_MARK))
    return np.array([place + away * out, place + (away - depth) * out])
