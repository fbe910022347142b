"""Seams of a block as curves on the skin of a body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from core.document.block import RING, ROOT, Block, Seam
from core.garment.curve_smoothing import smooth
from core.geometry.closest_point import nearest_faces
from core.geometry.geodesic import shortest_path
from core.geometry.mesh import Points
from core.geometry.plane_sections import arc_length, interpolate, resample
from core.pattern.places import BodyPlaces
from core.pattern.surface_trace import SNAP

STEP = 3.0
"""Distance between the places of a curve [mm]."""

CENTRES = (0.0, 1.0)
"""The shares of a half round at the front and the back centre [1]."""

_CLEFT = 25.0  # the places of both halves of a ring in a cleft are no further apart [mm]

_MOST_WAYS = 400  # between two places that are kept

_ROUNDING = 6  # passes of smoothing that round a curve at the places that it goes through


@dataclass(frozen=True, eq=False)
class SeamCurve:
    """A ``seam`` of a block as it is drawn on one ``side`` of the body ("" over the middle), (k, 3) [mm]."""

    seam: Seam
    side: str
    points: Points

    @property
    def name(self) -> str:
        """Return the name of the curve: that of the seam, with its side."""
        return f"{self.seam.name} {self.side}".rstrip()


class SeamDrawing:
    """Draws the seams of blocks on one body.

    A seam that is as it was in the block that was drawn last has the same array of points, not drawn again.
    """

    def __init__(self, places: BodyPlaces) -> None:
        self.places = places
        self._curves: dict[_Key, Points] = {}
        self._ways: dict[bytes, Points] = {}

    def levels(self, block: Block) -> Mapping[str, float]:
        """Return the heights of the levels of a block [mm]. Raises PatternError."""
        return {each.name: self.places.height(each.reference) + each.above for each in block.levels}

    def curves(self, block: Block) -> tuple[SeamCurve, ...]:
        """Return the curves of a block in its order. Raises PatternError, LineError."""
        levels = self.levels(block)
        drawn: dict[str, Points] = {}
        found, former = [], self._curves
        self._curves = {}
        for seam in block.seams:
            for name, side in seam.named():
                key = _key(seam, side, levels, drawn)
                points = former.get(key)
                if points is None:
                    points = self._laid(self._drawn(seam, side, levels, drawn))
                    if seam.kind == RING and side == "right":
                        points = _joined(points, drawn[f"{seam.name} left"], seam.span)
                self._curves[key] = drawn[name] = points
                found.append(SeamCurve(seam, side, points))
        return tuple(found)

    def _drawn(
        self, seam: Seam, side: str, levels: Mapping[str, float], drawn: Mapping[str, Points]
    ) -> Points:
        first, last = seam.span
        if seam.kind == ROOT:
            return self._root(first, last, side, seam.below)
        if seam.kind == RING:
            ring = self.places.ring(levels[seam.level], side)
            along = arc_length(ring)
            ends = np.array([first, last]) * along[-1]
            at = np.concatenate([ends[:1], along[(along > ends[0]) & (along < ends[1])], ends[1:]])
            return interpolate(at, along, ring)
        stops = [self.places.place(word, side, levels, drawn) for word in seam.places_of(side)]
        return self._way(stops)

    def _root(self, first: float, last: float, side: str, below: bool) -> Points:
        """Return the root of a breast from clock to clock, over 180 degrees if it is ``below``."""
        end = last if below else last + 360.0 if last < first else last - 360.0
        clocks = np.linspace(first, end, max(round(abs(end - first) / 2.0), 2))
        breast = self.places.breasts[side]
        return breast.places(clocks % 360.0, breast.root_distance(clocks % 360.0))

    def _way(self, stops: list[Points]) -> Points:
        """Return the shortest ways over the skin between places, rounded where they meet."""
        pieces = [self.path(start, end) for start, end in pairwise(stops)]
        whole = np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
        return smooth(resample(whole, STEP), _ROUNDING, closed=False)

    def path(self, start: Points, end: Points) -> Points:
        """Return the shortest path over the skin between two places (3,), (k, 3) [mm]."""
        key = start.tobytes() + end.tobytes()
        if key not in self._ways:
            if len(self._ways) >= _MOST_WAYS:
                self._ways.clear()
            self._ways[key] = shortest_path(self.places.skin, start, end)
        return self._ways[key]

    def _laid(self, points: Points) -> Points:
        """Return a curve evenly divided, on the skin; its ends stay."""
        even = resample(points, STEP)
        return nearest_faces(self.places.skin, even, self.places.skin.centroid_tree)[1]


def _joined(ring: Points, left: Points, span: tuple[float, float]) -> Points:
    """Return the right half of a ``ring`` with its ends at the centre where the ``left`` half has them.

    In a steep cleft the places of both halves at the centre are on opposite walls.
    """
    for end in (0, -1):
        if span[end] in CENTRES and SNAP <= np.linalg.norm(ring[end] - left[end]) < _CLEFT:
            ring = np.insert(ring, len(ring) if end else 0, left[end], axis=0)
    return ring


_Key = tuple[object, ...]


def _key(seam: Seam, side: str, levels: Mapping[str, float], drawn: Mapping[str, Points]) -> _Key:
    """Return all that a curve is drawn from: its seam, the levels, and the curves that it may end on."""
    onto = {word.partition(">")[2].strip() for word in seam.places_of(side)} - {""}
    met = [id(drawn[name]) for each in sorted(onto) for name in (f"{each} {side}", each) if name in drawn]
    own = (seam.name, seam.kind, seam.places_of(side), seam.level, seam.span, seam.below, side)
    return (*own, *levels.items(), *met)
