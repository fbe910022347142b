"""Horizontal sections of the lower trunk: one outline above the crotch, two of the legs below it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.geometry.level_outlines import Outlines, outlines, ring
from core.geometry.mesh import Floats, Indices, Mesh, Points, frozen
from core.geometry.plane_sections import hull_perimeter

REACH = 20.0
"""An outline that reaches so far to both sides of the middle is the trunk's [mm]; ours."""

LEAST_LEG = 60.0
"""The outline of a leg is at least so wide and so deep [mm]; ours."""

STEP = 4.0
"""Distance of the levels that are looked at over the whole height [mm]; ours."""

SURE_LEGS = 3
"""So many levels below the crotch show two legs; fewer are a hole between them; ours."""

_CROTCH_STEPS = 6


@dataclass(frozen=True, eq=False)
class LowerSection:
    """What a level shows: the outline of the trunk, or those of the left (+x) and the right leg, or neither.

    Outlines are closed polygons without the first point repeated, (k, 3) [mm], counterclockwise seen from
    above.
    """

    z: float
    trunk: Points | None = None
    legs: tuple[Points | None, Points | None] = (None, None)

    @property
    def has_legs(self) -> bool:
        """Return whether both legs are shown."""
        return self.legs[0] is not None and self.legs[1] is not None

    @property
    def tape(self) -> float:
        """Return the length of a tape round the trunk or round both legs together [mm]; 0 without any."""
        parts = [each for each in (self.trunk, *self.legs) if each is not None]
        return hull_perimeter(np.concatenate(parts)) if parts else 0.0


class LowerSections:
    """The sections of a body below the height ``top`` [mm], each made once.

    Below a crotch that was ``placed`` by hand [mm] thighs that touch are parted at the middle.
    """

    def __init__(self, mesh: Mesh, top: float, placed: float | None = None) -> None:
        self.mesh, self.top, self.placed = mesh, top, placed
        self.bottom = float(mesh.vertices[:, 2].min())
        self._known: dict[float, LowerSection] = {}

    def at(self, z: float) -> LowerSection:
        """Return the section at a height [mm]."""
        return self.many([z])[0]

    def many(self, heights: Sequence[float] | Floats) -> list[LowerSection]:
        """Return the sections at heights, (k,) [mm]; those that are new are cut in one pass."""
        wanted = [round(float(z), 4) for z in heights]
        new = np.array(sorted(set(wanted) - self._known.keys()))
        if len(new):
            self._known.update({found.z: found for found in self._cut(new)})
        return [self._known[z] for z in wanted]

    @cached_property
    def levels(self) -> Floats:
        """Return heights over the whole of what is looked at, (k,) [mm], from below."""
        return np.arange(self.bottom + 0.5 * STEP, self.top, STEP)

    @cached_property
    def middle(self) -> float:
        """Return x of the middle of the trunk [mm]: the median of three sections below the bust."""
        heights = self.top - np.array([20.0, 60.0, 100.0])
        cuts = outlines(self.mesh, np.sort(heights[heights > self.bottom]))
        centres = [cuts.pieces.centre[rows[np.argmax(cuts.pieces.size[rows])], 0] for rows in _shown(cuts)]
        return float(np.median(centres)) if centres else 0.0

    @cached_property
    def crotch(self) -> float | None:
        """Return the greatest height at which two legs are apart [mm], None if no level shows two."""
        if self.placed is not None:
            return self.placed
        apart = np.array([section.has_legs for section in self.many(self.levels)])
        sure = np.array([apart[max(k - SURE_LEGS + 1, 0) : k + 1].all() for k in range(len(apart))])
        if not sure.any():
            return None
        low = float(self.levels[np.flatnonzero(sure)[-1]])
        high = low + STEP
        for _ in range(_CROTCH_STEPS):
            z = 0.5 * (low + high)
            low, high = (z, high) if self.at(z).has_legs else (low, z)
        return low

    def _cut(self, z: Floats) -> list[LowerSection]:
        cuts = outlines(self.mesh, z)
        return [
            self._section(cuts, float(height), rows, pieces)
            for height, rows, pieces in zip(z, cuts.rows(), cuts.piece_rows(), strict=True)
        ]

    def _section(self, cuts: Outlines, z: float, rows: Indices, pieces: Indices) -> LowerSection:
        low, high, middle = cuts.pieces.low[pieces], cuts.pieces.high[pieces], self.middle
        size = cuts.pieces.size[pieces]
        across = (low[:, 0] < middle - REACH) & (high[:, 0] > middle + REACH)
        if across.any():
            trunk = _outline(cuts, rows, pieces[np.argmax(np.where(across, size, -1.0))], z)
            if self.placed is not None and z < self.placed:
                return LowerSection(z, None, (_half(trunk, middle, 1.0), _half(trunk, middle, -1.0)))
            return LowerSection(z, trunk)
        wide = (high - low > LEAST_LEG).all(axis=1)
        legs = []
        for sign in (1.0, -1.0):
            own = wide & (sign * (0.5 * (low + high)[:, 0] - middle) > 0.0)
            found = pieces[np.argmax(np.where(own, size, -1.0))] if own.any() else None
            legs.append(None if found is None else _outline(cuts, rows, found, z))
        return LowerSection(z, None, (legs[0], legs[1]))


def _shown(cuts: Outlines) -> list[Indices]:
    return [rows for rows in cuts.piece_rows() if len(rows)]


def _outline(cuts: Outlines, rows: Indices, piece: Indices, z: float) -> Points:
    """Return the polygon of one piece of a level, counterclockwise, (k, 3) [mm]."""
    own = rows[cuts.piece[rows] == piece]
    _, corners = ring(cuts.segments[own], cuts.ids[own])
    return _polygon(corners, z)


def _polygon(corners: Points, z: float) -> Points:
    x, y = corners.T
    if float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) < 0.0:
        corners = corners[::-1]
    return frozen(np.column_stack([corners, np.full(len(corners), z)]))


def _half(polygon: Points, middle: float, sign: float) -> Points | None:
    """Return the part of a polygon on one side of the middle, closed along it."""
    a, b = polygon[:, :2], np.roll(polygon[:, :2], -1, axis=0)
    here, there = sign * (a[:, 0] - middle), sign * (b[:, 0] - middle)
    points = []
    for start, end, h, t in zip(a, b, here, there, strict=True):
        if h >= 0.0:
            points.append(start)
        if (h > 0.0) != (t > 0.0) and h != t:
            points.append(start + (end - start) * (h / (h - t)))
    return _polygon(np.array(points), float(polygon[0, 2])) if len(points) > 2 else None


def crossings(outline: Points, x: float) -> Floats:
    """Return y where an outline, (k, 3) [mm], crosses the plane at ``x`` [mm], ascending."""
    a, b = outline[:, :2], np.roll(outline[:, :2], -1, axis=0)
    over = (a[:, 0] < x) != (b[:, 0] < x)
    part = (x - a[over, 0]) / (b[over, 0] - a[over, 0])
    return np.sort(a[over, 1] + part * (b[over, 1] - a[over, 1]))
