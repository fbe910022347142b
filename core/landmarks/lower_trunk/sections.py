"""Horizontal sections of the lower trunk and the legs, without arms and hands, computed once a height."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

from core.geometry.level_outlines import Outlines, outlines, ring
from core.geometry.mesh import SIGNS, Flags, Floats, Indices, Mesh, Points, frozen
from core.landmarks.torso.contour_classification import GAP
from core.landmarks.torso.torso_axis import arm_segments, torso_axis

STEP = 4.0
"""Distance of the levels in which the crotch is sought [mm]. Ours."""

SHIFT = 0.01
"""A level that would run along edges of the mesh is raised by this [mm]. Ours."""

ACROSS = 20.0
"""The outline of a trunk reaches at least so far to both sides of the middle [mm]. Ours."""

OFF_CENTRE = 0.25
"""The middle of a trunk is nearer to the middle of the body than this part of its width [1]. Ours."""

THIN = 50.0
"""An outline less wide and less deep than this is no leg [mm]. Ours."""

HALVINGS = 7
"""The level of the crotch is halved so many times: to 0.03 mm. Ours."""

NARROW = 0.5
"""A trunk less deep in its middle than this part of its sides is two thighs that touch [1]. Ours."""

Search = Literal["found", "ends", "touch"]
"""How the search for two legs ended: found, the scan ends above the crotch, or the thighs touch."""


@dataclass(frozen=True, eq=False)
class LowerSection:
    """The outlines of the body at height ``z`` [mm]: of the ``trunk``, or of both ``legs``, left (+x) first.

    Each outline, shape (k, 3) [mm], is closed (its last point is followed by its first, which is not
    repeated), counterclockwise seen from above, without arms and hands; None where there is none. ``bridged``
    [mm] is how much of the outlines goes over holes of the scan or where an arm was cut off.
    """

    z: float
    trunk: Points | None
    legs: tuple[Points | None, Points | None]
    bridged: float = 0.0

    @property
    def two_legs(self) -> bool:
        """Return whether there are outlines of both legs."""
        return self.legs[0] is not None and self.legs[1] is not None


NO_LEGS = (None, None)


@dataclass(frozen=True, eq=False)
class LowerSections:
    """Sections of ``mesh`` from its lowest level ``bottom`` to ``top`` [mm], about x = ``middle`` [mm]."""

    mesh: Mesh
    top: float
    bottom: float
    middle: float
    _known: dict[float, LowerSection] = field(default_factory=dict, repr=False)

    def at(self, z: float) -> LowerSection:
        """Return the section at height ``z`` [mm]; without any outline where the scan shows none."""
        return self.many([z])[0]

    def many(self, heights: Iterable[float]) -> list[LowerSection]:
        """Return the sections at ``heights`` [mm], in their order; those not known yet in one pass.

        Raises LandmarkError if the mesh is no skin.
        """
        asked = [float(z) for z in heights]
        new = np.unique([z for z in asked if z not in self._known])
        if len(new):
            at = np.where(np.isin(new, self._heights), new + SHIFT, new)
            cuts = outlines(self.mesh, at)
            shares = zip(new.tolist(), cuts.rows(), cuts.piece_rows(), strict=True)
            for z, rows, pieces in shares:
                self._known[z] = self._section(cuts, z, rows, pieces)
        return [self._known[z] for z in asked]

    @cached_property
    def levels(self) -> Floats:
        """Heights every ``STEP`` from the bottom to the top, ascending, shape (k,) [mm]."""
        count = max(int((self.top - self.bottom - 2.0) / STEP), 0)
        return frozen(self.bottom + 1.0 + STEP * np.arange(count + 1))

    @property
    def crotch(self) -> float | None:
        """Return the highest level with two legs [mm]; None without any, ``search`` tells why."""
        return self._searched[1]

    @property
    def search(self) -> Search:
        """Return how the search for the crotch ended."""
        return self._searched[0]

    @cached_property
    def _heights(self) -> Floats:
        return np.unique(self.mesh.vertices[:, 2])

    @cached_property
    def _searched(self) -> tuple[Search, float | None]:
        found = self.many(self.levels.tolist())
        two = np.array([section.two_legs for section in found])
        trunk = np.array([section.trunk is not None for section in found])
        if not two.any():
            lowest = next((section.trunk for section in found if section.trunk is not None), None)
            return ("touch" if lowest is not None and self._is_narrow(lowest) else "ends"), None
        # A hole may look like legs: the border is where most levels below are legs, most above are trunk.
        score = np.cumsum(two) + trunk.sum() - np.cumsum(trunk)
        last = int(np.flatnonzero(two & (score == score[two].max()))[-1])
        low, high = float(self.levels[last]), float(self.levels[min(last + 1, len(found) - 1)])
        for _ in range(HALVINGS):
            z = 0.5 * (low + high)
            low, high = (z, high) if self.at(z).two_legs else (low, z)
        return "found", low

    def _is_narrow(self, trunk: Points) -> bool:
        """Return whether a trunk is hardly joined in its middle."""
        near = np.abs(trunk[:, 0] - self.middle) < 0.05 * float(np.ptp(trunk[:, 0]))
        return not near.any() or float(np.ptp(trunk[near, 1])) < NARROW * float(np.ptp(trunk[:, 1]))

    def _section(self, cuts: Outlines, z: float, rows: Indices, pieces: Indices) -> LowerSection:
        main = self._main(cuts, pieces)
        if main is not None:
            own = rows[_with_loose(cuts, pieces, main)[cuts.piece[rows]]]
            own = self._armless(cuts, own, z)
            outline, bridged = _closed(cuts, own, z)
            return LowerSection(z, outline, NO_LEGS, bridged)
        legs, bridged = [], 0.0
        for side in SIGNS:
            leg = self._leg(cuts, pieces, side)
            own = rows[:0] if leg is None else rows[_with_loose(cuts, leg, int(leg[0]))[cuts.piece[rows]]]
            outline, gap = _closed(cuts, own, z)
            legs.append(outline)
            bridged += gap
        return LowerSection(z, None, (legs[0], legs[1]), bridged)

    def _armless(self, cuts: Outlines, own: Indices, z: float) -> Indices:
        """Return those of the segments ``own`` of a trunk that no hand is, where one joins it by a neck.

        Where the axis only tells that the width jumps, thighs that touch may have begun: nothing is cut.
        """
        guide = torso_axis(self.mesh)
        joined = np.any(guide.necks[list(guide.between(z)[:2])], axis=0)
        if joined.any():
            arms = arm_segments(cuts, own, guide.centre_at(z))
            for arm, joins in zip(arms, joined.tolist(), strict=True):
                own = own[~np.isin(own, arm)] if joins else own
        return own

    def _main(self, cuts: Outlines, rows: Indices) -> int | None:
        """Return the piece of the trunk among those of a level: closed, else open; None without any."""
        low, high = cuts.pieces.low[rows, 0] - self.middle, cuts.pieces.high[rows, 0] - self.middle
        over = (low < -ACROSS) & (high > ACROSS)
        whole = over & cuts.pieces.closed[rows] & (0.5 * np.abs(low + high) < OFF_CENTRE * (high - low))
        for fits in (whole, over & ~cuts.pieces.closed[rows]):
            if fits.any():
                return int(rows[fits][np.argmax(cuts.pieces.size[rows[fits]])])
        return None

    def _leg(self, cuts: Outlines, rows: Indices, side: float) -> Indices | None:
        """Return the pieces on one side, that of the leg first; None without a leg."""
        own = rows[side * (cuts.pieces.centre[rows, 0] - self.middle) > 0.0]
        own = own[np.argsort(-cuts.pieces.size[own], kind="stable")]
        big = len(own) > 0 and (cuts.pieces.high - cuts.pieces.low)[own[0]].max() > THIN
        return own if big else None


def lower_sections(mesh: Mesh, top: float) -> LowerSections:
    """Return the sections of ``mesh`` from its lowest level up to ``top`` [mm], at or below the under-bust.

    Their middle is the median middle of the trunk from ``top`` to 120 mm below it. Raises LandmarkError if
    the mesh is no skin. Source: ours.
    """
    bottom = float(mesh.vertices[:, 2].min())
    first = LowerSections(mesh, top, bottom, torso_axis(mesh).middle)
    high = [section.trunk for section in first.many(top - 20.0 * np.arange(7))]
    middles = [0.5 * (trunk[:, 0].min() + trunk[:, 0].max()) for trunk in high if trunk is not None]
    middle = float(np.median(middles)) if middles else first.middle
    return LowerSections(mesh, top, bottom, middle)


def _with_loose(cuts: Outlines, rows: Indices, main: int) -> Flags:
    """Return which pieces make one outline: ``main``, and if that is open, open ones of ``rows`` near it."""
    pieces = cuts.pieces
    kept = np.zeros(len(pieces.level), dtype=bool)
    kept[main] = True
    if not pieces.closed[main]:
        loose = rows[~pieces.closed[rows]]
        low, high = pieces.low[main, 0] - GAP, pieces.high[main, 0] + GAP
        kept[loose[(pieces.low[loose, 0] < high) & (pieces.high[loose, 0] > low)]] = True
    return kept


def _closed(cuts: Outlines, own: Indices, z: float) -> tuple[Points | None, float]:
    """Return segments as one outline counterclockwise, (k, 3) [mm], and how much of it is no skin [mm]."""
    if len(own) < 3:
        return None, 0.0
    order, start = ring(cuts.segments[own], cuts.ids[own])
    step = np.roll(start, -1, axis=0) - start
    skin = np.linalg.norm(cuts.segments[own[order], 1, :2] - cuts.segments[own[order], 0, :2], axis=1)
    length = np.linalg.norm(step, axis=1)
    bridged = float(np.maximum(length - skin, 0.0).sum())
    start = start[length > 0.0]
    if len(start) < 3:
        return None, 0.0
    x, y = (start - start[0]).T
    if np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) < 0.0:
        start = start[::-1]
    return frozen(np.column_stack([start, np.full(len(start), z)])), bridged
