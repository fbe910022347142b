"""The bust points: on the nipple where one stands out of the breast, else where a smooth breast points to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from core.finding.chest import Pole, smoothed
from core.finding.relief import GRID, Nipple, Patch, breast_patch, find_nipples
from core.landmark import SIDES, Landmark
from core.mesh import MIRROR, Floats, Mesh, Points

NIPPLE = "The nipple: the spot that stands out of the smooth breast around it."
SMOOTH = "Between the foremost place and the middle of the breast: no nipple stands out."
MIRRORED = "The middle of the breast, shifted towards where the nipple of the other breast lies."

ACROSS = "Estimated, as no breast stands out there: across from the bust point of the other breast."

OUTWARD = 18.0
"""On a smooth breast the bust point lies so far outside the foremost place, towards the pole [mm]."""

RAISED = 3.0
"""And so far above it [mm]: nipples were found 0 to 6 mm above the foremost place."""

WIDE = 52.0
"""The foremost place is looked for so far from the pole [mm]."""

ALIKE = 4.0
"""Two smooth breasts point alike if one point lies so near to the other's mirror image [mm]."""

SAME = 4.0
"""Nipples lie so near to the same place of both breasts [mm]; so much further off, a third of it is left."""

FLAT, FAR_FLATTER = 4.0, 0.3
"""A side that stands out less than this [mm], or than this part of the other, shows no breast."""


def bust_points(
    mesh: Mesh, poles: Sequence[Pole], middle: float, missing: Sequence[str] = ()
) -> list[Landmark]:
    """Return the bust points of the left and the right breast, each with a ring round it.

    ``middle`` is x of the middle of the body [mm]; on sides ``missing`` there is no breast.
    """
    left, right = patches = [breast_patch(mesh, pole.position) for pole in poles]
    nipples = find_nipples(left, right, middle)
    marks = [
        _bust_point(f"bust_point_{side}", patch, own, other, None if missing else middle)
        for side, patch, own, other in zip(SIDES, patches, nipples, nipples[::-1], strict=True)
    ]
    if all(mark.rule == SMOOTH for mark in marks):
        marks = _evened(marks, patches, middle)
    if len(missing) != 1:
        return marks
    there = marks[1 - SIDES.index(missing[0])]
    across = _across(mesh, there.position, middle)
    marks[SIDES.index(missing[0])] = Landmark(f"bust_point_{missing[0]}", across, 0.3, ACROSS, across[None])
    return marks


def _evened(marks: list[Landmark], patches: Sequence[Patch], middle: float) -> list[Landmark]:
    """Return the points of two smooth breasts that are alike as mirror images: halves what is chance."""
    left, right = (mark.position for mark in marks)
    over = np.array([2.0 * middle - right[0], right[1], right[2]])
    if np.linalg.norm(over - left) > ALIKE:
        return marks
    mean = 0.5 * (left + over)
    places = (mean, np.array([2.0 * middle - mean[0], mean[1], mean[2]]))
    return [
        replace(mark, position=patch.onto(place))
        for mark, patch, place in zip(marks, patches, places, strict=True)
    ]


def _across(mesh: Mesh, there: Points, middle: float) -> Points:
    """Return the skin in front, across from a point of the other side, shape (3,) [mm]."""
    place = np.array([2.0 * middle - there[0], there[1], there[2]])
    away = np.hypot(*(mesh.vertices - place)[:, [0, 2]].T)
    near = mesh.vertices[away < max(10.0, float(away.min()))]
    return np.asarray(near[np.argmin(near[:, 1])] if len(near) else place)


def missing_sides(poles: Sequence[Pole], lone: bool) -> list[str]:
    """Return the sides, of left and right, on which no breast stands out of the chest.

    If one side is ``lone`` over a fold the other has none, however much its ribs stand out.
    """
    out = [pole.prominence for pole in poles]
    least = max(FLAT, FAR_FLATTER * max(out))
    return [side for side, own in zip(SIDES, out, strict=True) if own < least or (lone and own == min(out))]


def _bust_point(
    name: str, patch: Patch, own: Nipple | None, other: Nipple | None, middle: float | None
) -> Landmark:
    """Return the bust point of one breast; without a ``middle`` [mm] it is the only breast."""
    if own is not None and own.sure:
        place, rule = own.position, NIPPLE
        confidence = own.clear if middle is None else borne_out(own, other, middle)
    elif other is not None and other.sure:
        place = patch.nearest(patch.centre + 0.5 * MIRROR * other.way)
        confidence, rule = 0.3, MIRRORED
    else:
        place, confidence = smooth_point(patch)
        rule = SMOOTH
    return Landmark(name, place, confidence, rule, patch.ring(place, 12.0))


def borne_out(own: Nipple, other: Nipple | None, middle: float) -> float:
    """Return how sure it is (0..1) that the spot is the nipple, by that of the other breast. Source: ours.

    Two spots at the same place of both breasts bear each other out, however the breasts differ. Of two that
    do not, one at most is a nipple: rather the clearer one, near the pole.
    """
    # Spots that lie unlike share one nipple: a spot's own certainty, times its part of both squared.
    rival = 0.0 if other is None else other.alone
    alike = 0.0 if other is None else float(np.exp(-max(own.apart(other, middle) - SAME, 0.0) / SAME))
    return alike * own.clear + (1.0 - alike) * own.alone**3 / max(own.alone**2 + rival**2, 1e-9)


def smooth_point(patch: Patch) -> tuple[Points, float]:
    """Return where a breast without a nipple points to, shape (3,) [mm], and how sure that is (0..1).

    The foremost place lies inside the nipple, the pole outside of it: the point lies between. Source: ours.
    """
    foremost, inner = _foremost(patch)
    way = patch.centre - foremost
    apart = float(np.linalg.norm(way))
    if not inner:
        return patch.centre, 0.1
    place = foremost + way * min(OUTWARD / max(apart, 1.0), 0.75) + (0.0, 0.0, RAISED)
    # Where the nipple itself would be stays unknown: never sure, the less so the wider the choice.
    return patch.onto(place), 0.45 * float(np.exp(-max(apart - 24.0, 0.0) / 25.0))


def _foremost(patch: Patch) -> tuple[Points, bool]:
    """Return the foremost surface point near the pole, and whether it is a summit of the breast."""
    forward = np.where(patch.distance < WIDE, -patch.points[..., 1], np.nan)
    calm: Floats = np.where(np.isnan(forward), np.nan, smoothed(_finite(forward), (3.0, 3.0)))
    if np.isnan(calm).all():
        return patch.centre, False
    row, column = np.unravel_index(int(np.nanargmax(calm)), calm.shape)
    return np.asarray(patch.points[row, column]), bool(patch.distance[row, column] < WIDE - 2.0 * GRID)


def _finite(grid: Floats) -> Floats:
    return np.asarray(np.where(np.isnan(grid), -np.inf, grid))
