"""Places of the template of the lower trunk on the sections of a body: the trunk's rows and the legs'."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.control_mesh.hull_arc import SectionArc, at_parts, crossing_y, half_outline, leg_arcs
from core.control_mesh.lower_template import FOLD_ROW, HALF, HIP_ROW, SEAT, SIDE, LowerTemplate
from core.geometry.mesh import SIGNS, Floats, Points
from core.landmarks.lower_trunk.levels import body_scale
from core.landmarks.lower_trunk.sections import LowerSection, LowerSections
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.types import SIDES

HIP_RANGE = (50.0, 110.0)
"""Between these heights over the crotch the hip row runs [mm]; ours, by size."""

SEAT_PART = 0.66
"""The part of the back quarter at which the column of the buttock point runs above the waist [1]; ours ..."""

SEAT_RANGE = (0.55, 0.82)
"""... and between which it may lie at the hips [1]; ours."""

TO_FOLD = (0.0, 0.0, 0.0, 0.0, 0.5, 0.75, 1.0, 1.0, 1.0, 1.0, 0.45, 0.0)
"""How far the fold row goes from its height at the centres to the gluteal fold, by column [1]; ours."""

IN_CREASE, INNER_SEAT = 0.6, 0.5
"""Where column 9 of the fold row lies between the middle of the leg and the buttock point, and column 10
between the middle and column 9 [1]; ours.
"""

CLEFT = 80.0
"""Up to so far over the buttock points the back centre lies half way between cleft and hull [mm]; ours."""

ON_TRUNK = 2.0
"""Points so far over the crotch lie on the outline of the trunk, lower ones on a leg [mm]; ours."""

EDGE = 4.0
"""The lowest row stays so far over the edge of the scan [mm]; ours."""


@dataclass(frozen=True, eq=False)
class LowerPlaces:
    """What the rows of the lower trunk follow on one body; pairs are (left, right), heights in mm.

    ``scale`` [1] is the size of the body; ``belly_height`` [1] where the belly row runs from waist to hip.
    """

    template: LowerTemplate
    landmarks: LowerLandmarks
    underbust: float
    belly_height: float

    @property
    def sections(self) -> LowerSections:
        """Return the sections of the body."""
        return self.landmarks.sections

    @cached_property
    def scale(self) -> float:
        """Return the size of the body against one of the reference size [1]."""
        return body_scale(self.sections)

    @property
    def crotch(self) -> Points:
        """Return the place between the legs, (3,) [mm]."""
        return self.landmarks.position("crotch")

    @property
    def waist(self) -> float:
        """Return the height of the waist row [mm]."""
        return self.landmarks.levels["waist"]

    @cached_property
    def hip(self) -> float:
        """Return the height of the hip row [mm]: that of the buttock points, unless they lie far off."""
        low, high = (float(self.crotch[2]) + each * self.scale for each in HIP_RANGE)
        return float(np.clip(self.landmarks.levels["buttock"], low, high))

    def fold(self, side: int) -> float:
        """Return the height of a gluteal fold [mm]; side 0 is the left one."""
        return self.landmarks.levels[f"gluteal_fold_{SIDES[side]}"]

    def buttock(self, side: int) -> Points:
        """Return a buttock point, (3,) [mm]."""
        return self.landmarks.position(f"buttock_{SIDES[side]}")

    @cached_property
    def heights(self) -> Floats:
        """Return the heights of the trunk's points, (10, 2, 12) [mm]: row, side, column from the front."""
        rows, top, waist, hip = self.template.rows, self.underbust, self.waist, self.hip
        ribs = max(top - rows[1].value * self.scale, waist + 0.45 * (top - waist))
        down = [waist + part * (hip - waist) for part in (rows[4].value, self.belly_height, rows[6].value)]
        levels = [top, ribs, ribs + rows[2].value * (waist - ribs), waist, *down, hip]
        centre = float(self.crotch[2]) + rows[FOLD_ROW].value * self.scale
        folds = centre + np.outer([self.fold(side) - centre for side in (0, 1)], TO_FOLD)
        under = hip + rows[8].value * (folds - hip)
        upper = np.broadcast_to(np.array(levels)[:, None, None], (len(levels), 2, HALF + 1))
        return np.concatenate([upper, [under, folds]])

    def trunk(self) -> Points:
        """Return the points of rows 0 to 9, (220, 3) [mm]."""
        self.sections.many(np.unique(self.heights))  # all in one pass
        result = np.empty((FOLD_ROW + 1, 2 * HALF, 3))
        for side in (1, 0):
            columns = SIGNS[side] * np.arange(HALF + 1)
            columns[-1] = HALF
            at = (columns + HALF - 1).astype(np.int64)
            for row in range(FOLD_ROW):
                result[row, at] = self._row(row, side)
            result[FOLD_ROW, at] = self._fold_row(side)
            if abs(self.hip - self.landmarks.levels["buttock"]) < 1.0:
                result[HIP_ROW, at[SEAT]] = self.buttock(side)
        return result.reshape(-1, 3)

    def _row(self, row: int, side: int) -> Points:
        """Return half a row from front centre to back centre, (12, 3) [mm]."""
        heights = self.heights[row, side]
        known: dict[float, Points] = {}
        for z in np.unique(heights):
            known[float(z)] = self._half_outline(float(z), side)
        return np.array([[*known[float(z)][column], z] for column, z in enumerate(heights)])

    def _half_outline(self, z: float, side: int) -> Points:
        """Return the places of all columns of one side at a height, (12, 2) [mm]."""
        section = self.sections.at(z)
        if section.trunk is None:
            return self._leg_columns(section, side)
        arc = SectionArc(section.trunk[:, :2], float(self.crotch[0]))
        sign, seat = SIGNS[side], self._seat_part(z, side)
        first, second, third, between = self.template.back_parts
        back = np.array([seat * first, seat * second, seat * third, seat + between * (1.0 - seat)])
        front = arc.front(np.array(self.template.front_parts[1:]), sign)
        return np.concatenate([[arc.centre(-1.0)], front, arc.back(back, sign), [self._back_centre(arc, z)]])

    def _seat_part(self, z: float, side: int) -> float:
        """Return at which part of the back quarter column 9 runs at a height [1]."""
        above = float(self.heights[2, 0, 0])
        share = float(np.clip((above - z) / (above - self.hip), 0.0, 1.0))
        return SEAT_PART + share * (self._seat_parts[side] - SEAT_PART)

    @cached_property
    def _seat_parts(self) -> tuple[float, float]:
        trunk = self.sections.at(self.hip).trunk
        if trunk is None:
            return SEAT_PART, SEAT_PART
        arc = SectionArc(trunk[:, :2], float(self.crotch[0]))
        parts = [arc.part_at(self.buttock(side)[:2], SIGNS[side]) for side in (0, 1)]
        left, right = np.clip(parts, *SEAT_RANGE).tolist()
        return left, right

    def _back_centre(self, arc: SectionArc, z: float) -> Points:
        skin = arc.centre(1.0)
        if z >= self.landmarks.levels["buttock"] + CLEFT:
            return skin
        # At the bottom of the cleft lines would follow a crease, on the hull they would float.
        return np.asarray(0.5 * (skin + arc.hull_centre(1.0)))

    def _leg_columns(self, section: LowerSection, side: int) -> Points:
        """Return the places of the columns on a leg's outline, (12, 2) [mm]."""
        outline = self._leg(section, side)
        if outline is None:
            return np.tile(self.crotch[:2], (HALF + 1, 1))
        front, back = leg_arcs(outline, SIGNS[side])
        ahead = at_parts(front, np.array(self.template.leg_front[1:]))
        return np.concatenate([ahead, at_parts(back, np.array(self.template.leg_back))])

    def _fold_row(self, side: int) -> Points:
        """Return half of the fold row, (12, 3) [mm]: its back lies in the crease below the seat."""
        heights, sign, middle = self.heights[FOLD_ROW, side], SIGNS[side], float(self.crotch[0])
        row = self._row(FOLD_ROW, side)
        section = self.sections.at(float(heights[SEAT]))
        leg = self._leg(section, side)
        if leg is None:
            return row
        x = IN_CREASE * self.buttock(side)[0] + (1.0 - IN_CREASE) * _middle_x(leg)
        row[SEAT, :2] = x, crossing_y(leg, x, 1.0)
        _, back = leg_arcs(leg, sign)
        upto = _part_of(back, row[SEAT, :2])
        row[SIDE : SEAT + 1, :2] = at_parts(back, upto * np.linspace(0.0, 1.0, 4))
        inner = self.sections.at(float(heights[SEAT + 1]))
        outline = inner.trunk if inner.trunk is not None else self._leg(inner, side)
        if outline is not None:
            x = middle + INNER_SEAT * (x - middle)
            row[SEAT + 1, :2] = x, crossing_y(outline, x, 1.0)
        return row

    def legs(self) -> tuple[Points, Points]:
        """Return the two rows of each leg, (26, 3) [mm]."""
        left, right = (np.concatenate([self._ring(side, row) for row in (0, 1)]) for side in (0, 1))
        return left, right

    def _ring(self, side: int, row: int) -> Points:
        z = self._ring_heights(side)[row]
        outline = self._leg(self.sections.at(z), side)
        assert outline is not None  # heights are those at which the leg is seen
        front, back = leg_arcs(outline, SIGNS[side])
        parts = self.template.leg_front, self.template.leg_back
        places = np.concatenate([at_parts(front, np.array(parts[0])), at_parts(back, np.array(parts[1]))])
        return np.column_stack([places, np.full(len(places), z)])

    def _ring_heights(self, side: int) -> tuple[float, float]:
        """Return the heights of a leg's rows [mm], over the edge of the scan there."""
        below = min(self.fold(side), float(self.crotch[2]))
        first, second = (below - self.template.rows[row].value * self.scale for row in (-2, -1))
        lowest = self._lowest(side)
        second = max(second, lowest)
        return max(first, 0.5 * (below + second)), second

    def _leg(self, section: LowerSection, side: int) -> Points | None:
        """Return the outline of a leg, (k, 3) [mm]; of thighs that touch the half of theirs."""
        if section.trunk is None or section.z >= self.crotch[2]:
            return section.legs[side]
        return half_outline(section.trunk, float(self.crotch[0]), SIGNS[side])

    def _lowest(self, side: int) -> float:
        """Return the lowest height at which a leg can be cut [mm]."""
        levels = self.sections.levels[self.sections.levels < self.crotch[2]]
        seen = [self._leg(section, side) is not None for section in self.sections.many(levels)]
        gaps = np.flatnonzero(~np.array(seen, dtype=bool))
        first = int(gaps[-1]) + 1 if len(gaps) else 0
        return float(levels[min(first, len(levels) - 1)]) + EDGE


def _middle_x(outline: Points) -> float:
    return 0.5 * float(outline[:, 0].min() + outline[:, 0].max())


def _part_of(curve: Points, place: Points) -> float:
    """Return the part of the length of a curve, (k, 2), at its point nearest to a place [1]."""
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    return float(along[np.argmin(np.linalg.norm(curve - place, axis=1))] / along[-1])
