"""Places on the outline of a section: by parts of the arc of its convex hull, and on rays through them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Floats, Points, unit
from core.geometry.plane_sections import arc_length, hull_corners
from core.landmarks.lower_trunk.outline_profiles import crossings

OUT = 0.35
"""Rays begin so far out from the middle on the way to the hull [1]; ours."""


@dataclass(frozen=True, eq=False)
class SectionArc:
    """One outline of the trunk, (k, 2) [mm], about ``middle`` [mm], with the arcs of its convex hull.

    Parts of an arc [1] go from the front centre (0) to the side (1), or from the side to the back centre.
    """

    outline: Points
    middle: float

    @property
    def depth(self) -> float:
        """Return y of the middle of the depth [mm]."""
        y = self.outline[:, 1]
        return 0.5 * float(y.min() + y.max())

    def front(self, parts: Floats, sign: float) -> Points:
        """Return skin at parts of the front quarter of a side, +1 the left one, (k, 2) [mm]."""
        return self._on_skin(at_parts(self._quarter(sign, -1.0), parts))

    def back(self, parts: Floats, sign: float) -> Points:
        """Return skin at parts of the back quarter of a side, (k, 2) [mm]."""
        return self._on_skin(at_parts(self._quarter(sign, 1.0)[::-1], parts))

    def centre(self, way: float) -> Points:
        """Return skin at the centre of the front (-1) or the back (+1), (2,) [mm]."""
        return np.array([self.middle, crossing_y(self.outline, self.middle, way)])

    def hull_centre(self, way: float) -> Points:
        """Return the convex hull at the centre of the front (-1) or the back (+1), (2,) [mm]."""
        return np.array([self.middle, crossing_y(self._hull, self.middle, way)])

    def part_at(self, place: Points, sign: float) -> float:
        """Return the part of the back quarter of the hull that is nearest to a place, (2,) [mm]."""
        curve = self._quarter(sign, 1.0)[::-1]
        a, b = curve[:-1], curve[1:]
        step = b - a
        share = ((place - a) * step).sum(axis=1) / np.maximum((step**2).sum(axis=1), 1e-12)
        share = np.clip(share, 0.0, 1.0)
        nearest = int(np.argmin(np.linalg.norm(a + share[:, None] * step - place, axis=1)))
        lengths = np.linalg.norm(step, axis=1)
        return float((lengths[:nearest].sum() + share[nearest] * lengths[nearest]) / lengths.sum())

    @property
    def _hull(self) -> Points:
        return self.outline[hull_corners(self.outline)]

    def _quarter(self, sign: float, way: float) -> Points:
        """Return the hull from its centre, front (-1) or back (+1), to the side in the middle depth."""
        hull = self._hull
        side = np.array([crossing_y(hull[:, ::-1], self.depth, sign), self.depth])
        inside = (sign * (hull[:, 0] - self.middle) > 0.0) & (way * (hull[:, 1] - self.depth) > 0.0)
        corners = hull[inside]
        angle = np.arctan2(way * (corners[:, 1] - self.depth), sign * (corners[:, 0] - self.middle))
        return np.concatenate([self.hull_centre(way)[None], corners[np.argsort(-angle)], side[None]])

    def _on_skin(self, places: Points) -> Points:
        """Return the last crossings with the outline of rays through places of the hull, (k, 2) [mm]."""
        start = np.column_stack(
            [self.middle + OUT * (places[:, 0] - self.middle), np.full(len(places), self.depth)]
        )
        return np.array([last_crossing(self.outline, a, b) for a, b in zip(start, places, strict=True)])


def at_parts(curve: Points, parts: Floats) -> Points:
    """Return places at parts of the length of an open curve, (k, 2) [mm]."""
    along = arc_length(curve)
    return np.column_stack([np.interp(parts * along[-1], along, each) for each in curve.T])


def crossing_y(polygon: Points, x: float, way: float) -> float:
    """Return the foremost (-1) or backmost (+1) y at which a closed polygon crosses ``x`` [mm].

    Where it does not reach there, y of its corner nearest to that.
    """
    found = crossings(polygon, x)
    if not len(found):
        return float(polygon[np.argmin(np.abs(polygon[:, 0] - x)), 1])
    return float(found[-1 if way > 0.0 else 0])


def last_crossing(outline: Points, start: Points, through: Points) -> Points:
    """Return where a ray from ``start`` through a place last crosses an outline; that place if nowhere."""
    way = unit(through - start)
    ahead = crossings((outline - start) @ np.array([[-way[1], way[0]], way]).T, 0.0)
    return np.asarray(start + ahead[-1] * way if len(ahead) and ahead[-1] > 0.0 else through)


def leg_arcs(outline: Points, sign: float) -> tuple[Points, Points]:
    """Return the front arc of a leg from its inside to its outside, and the back arc from there, (k, 2) [mm].

    ``outline`` runs counterclockwise seen from above; ``sign`` is +1 for the left leg.
    """
    places = outline[:, :2]
    inside, outside = int(np.argmin(sign * places[:, 0])), int(np.argmax(sign * places[:, 0]))
    # Counterclockwise the left leg goes from its inside (towards -x) by the front (-y) to its outside.
    way = places if sign > 0 else places[::-1]
    if sign < 0:
        inside, outside = len(places) - 1 - inside, len(places) - 1 - outside
    around = np.roll(way, -inside, axis=0)
    turn = (outside - inside) % len(places)
    return around[: turn + 1], np.concatenate([around[turn:], around[:1]])


def half_outline(outline: Points, middle: float, sign: float) -> Points | None:
    """Return the part of a closed outline on one side of ``middle`` [mm], closed along it, (k, 3) [mm]."""
    ahead = np.roll(outline, -1, axis=0)
    here, there = sign * (outline[:, 0] - middle), sign * (ahead[:, 0] - middle)
    over = (here >= 0.0) != (there >= 0.0)
    part = np.where(over, here / np.where(over, here - there, 1.0), 0.0)[:, None]
    crossing = outline + part * (ahead - outline)
    kept = [
        each
        for own, cut, a, b in zip(here >= 0.0, over, outline, crossing, strict=True)
        for each in ([a] if own else []) + ([b] if cut else [])
    ]
    return np.array(kept) if len(kept) > 2 else None
