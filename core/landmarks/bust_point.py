"""The bust points: on the nipple where one stands out of the breast, else where a smooth breast points to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from core.geometry.mesh import Floats, Mesh, Points
from core.geometry.mirror_plane import MIRROR, mirror
from core.landmarks.anchor import smoothed
from core.landmarks.chest import Pole
from core.landmarks.nipple import GRID, BreastPatch, breast_patch
from core.landmarks.nipple_pair import ALONE, BORNE, Nipple, find_nipples
from core.landmarks.types import SIDES, Landmark
from core.messages import Message

NIPPLE = Message("Nipple: local protrusion on the smooth breast surface.")
SMOOTH = Message("No nipple detected: estimated between the foremost point and the centre of the breast.")
MIRRORED = Message("Centre of the breast, shifted to mirror the nipple of the other breast.")

ACROSS = Message("Estimated by mirroring the other bust point: no breast protrusion on this side.")

OUTWARD = 18.0
"""On a smooth breast the bust point lies so far outside the foremost place, towards the pole [mm]."""

RAISED = 3.0
"""And so far above it [mm]: nipples were found 0 to 6 mm above the foremost place."""

FAR_OUT, FARTHER_OUT = 24.0, 8.0
"""A pole so far outside of where the breast reaches forward [mm] is the side of a broad bust, no word
of the nipple; from the second [mm] less on it tells all."""

WIDE = 52.0
"""The foremost place is looked for so far from the pole [mm]."""

ALIKE = 4.0
"""Two smooth breasts point alike if one point lies so near to the other's mirror image [mm]."""

SAME, OTHER = 4.0, 3.0
"""Nipples lie so near to the same place of both breasts [mm]; each second [mm] more leaves a third of it."""

LIKE, UNLIKE = 8.0, 16.0
"""Bust points may lie so far from each other's mirror image [mm]; each second [mm] more divides by e."""

BROAD, BROADER = 26.0, 12.0
"""A pole may lie so far outside of where the breast reaches forward [mm]; each second more divides by e."""

FLAT, FAR_FLATTER = 4.0, 0.3
"""A side that stands out less than this [mm], or than this part of the other, shows no breast."""


def bust_points(
    mesh: Mesh, poles: Sequence[Pole], middle: float, missing: Sequence[str] = ()
) -> list[Landmark]:
    """Return the bust points of the left and the right breast, each with a ring round it.

    ``middle`` is x of the middle of the body [mm]; on sides ``missing`` there is no breast.
    """
    left, right = patches = [breast_patch(mesh, pole) for pole in poles]
    shown = (left if SIDES[0] not in missing else None, right if SIDES[1] not in missing else None)
    nipples = find_nipples(*shown, middle)
    marks = [
        _bust_point(f"bust_point_{side}", patch, own, other, None if missing else middle)
        for side, patch, own, other in zip(SIDES, patches, nipples, nipples[::-1], strict=True)
    ]
    if all(mark.rule == SMOOTH for mark in marks):
        marks = _evened(marks, patches, middle)
        apart = _unlike(marks, middle) if not missing else 0.0
        marks = [
            replace(mark, confidence=shape_confidence(patch, apart))
            for mark, patch in zip(marks, patches, strict=True)
        ]
    if len(missing) != 1:
        return marks
    there = marks[1 - SIDES.index(missing[0])]
    across = _across(mesh, there.position, middle)
    marks[SIDES.index(missing[0])] = Landmark(f"bust_point_{missing[0]}", across, 0.3, ACROSS, across[None])
    return marks


def _evened(marks: list[Landmark], patches: Sequence[BreastPatch], middle: float) -> list[Landmark]:
    """Return the points of two smooth breasts that are alike as mirror images: halves what is chance."""
    if _unlike(marks, middle) > ALIKE:
        return marks
    left, right = (mark.position for mark in marks)
    mean = 0.5 * (left + mirror(right, middle))
    places = (mean, mirror(mean, middle))
    return [
        replace(mark, position=patch.project(place))
        for mark, patch, place in zip(marks, patches, places, strict=True)
    ]


def _unlike(marks: Sequence[Landmark], middle: float) -> float:
    """Return how far a point of the left side lies from the mirror image of that of the right one [mm]."""
    left, right = (mark.position for mark in marks)
    return float(np.linalg.norm(mirror(right, middle) - left))


def _across(mesh: Mesh, there: Points, middle: float) -> Points:
    """Return the skin in front, across from a point of the other side, shape (3,) [mm]."""
    place = mirror(there, middle)
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
    name: str, patch: BreastPatch, own: Nipple | None, other: Nipple | None, middle: float | None
) -> Landmark:
    """Return the bust point of one breast; without a ``middle`` [mm] it is the only breast."""
    if own is not None:
        place, rule = own.position, NIPPLE
        confidence = likelihood(own) if middle is None else mutual_confidence(own, other, middle)
    elif other is not None:
        place, rule = patch.nearest(patch.forward + MIRROR * other.out), MIRRORED
        confidence = 0.4
    else:
        place, rule = shape_bust_point(patch), SMOOTH
        confidence = shape_confidence(patch, 0.0)
    return Landmark(name, place, confidence, rule, patch.ring(place, 12.0))


def likelihood(spot: Nipple) -> float:
    """Return how likely (0..1) a spot is a nipple, whatever the other breast shows."""
    return float(1.0 / (1.0 + np.exp(-spot.log_odds)))


def mutual_confidence(own: Nipple, other: Nipple | None, middle: float) -> float:
    """Return how sure it is (0..1) that the spot is the nipple, by that of the other breast. Source: ours.

    Two spots at the same place of both breasts bear each other out, however the breasts differ. Of two that
    do not, one at most is a nipple: rather the likelier one.
    """
    if other is None:
        return float(1.0 / (1.0 + np.exp(ALONE - own.log_odds)))
    alike = float(np.exp(-max(own.apart(other, middle) - SAME, 0.0) / OTHER))
    both = float(1.0 / (1.0 + np.exp(BORNE - 0.5 * (own.log_odds + other.log_odds))))
    rivals = np.exp([0.0, own.log_odds, other.log_odds])
    return alike * both + (1.0 - alike) * float(rivals[1] / rivals.sum())


def shape_confidence(patch: BreastPatch, apart: float) -> float:
    """Return how sure (0..1) the bust point of a breast without a nipple is.

    Breasts whose points lie ``apart`` [mm] from each other's mirror images are less sure, and so are those
    whose pole says something else than where they reach forward. Measured on 250 such points of made bodies:
    one lay more than 8 mm off.
    """
    gap = _gap(patch)
    doubt = max(apart - LIKE, 0.0) / UNLIKE + max(-gap, gap - BROAD, 0.0) / BROADER
    return 0.6 * float(np.exp(-doubt))


def _gap(patch: BreastPatch) -> float:
    """Return how far outside of the place that reaches furthest forward the pole lies [mm]."""
    return patch.side * float((patch.centre - patch.forward)[0])


def shape_bust_point(patch: BreastPatch) -> Points:
    """Return where a breast without a nipple points to, shape (3,) [mm].

    The foremost place lies inside the nipple, the pole outside of it: the point lies between, unless the pole
    is the side of a broad bust. Source: ours.
    """
    gap = _gap(patch)
    near = float(np.clip((FAR_OUT - gap) / FARTHER_OUT, 0.0, 1.0))
    foremost, inner = _foremost(patch)
    if near == 0.0 or not inner:
        return patch.forward
    way = patch.centre - foremost
    apart = float(np.linalg.norm(way))
    outside = foremost + way * min(OUTWARD / max(apart, 1.0), 0.75) + (0.0, 0.0, RAISED)
    return patch.project(patch.forward + near * (outside - patch.forward))


def _foremost(patch: BreastPatch) -> tuple[Points, bool]:
    """Return the foremost surface point near the pole, and whether it is a summit of the breast."""
    forward = np.where(patch.distance < WIDE, -patch.points[..., 1], np.nan)
    calm: Floats = np.where(np.isnan(forward), np.nan, smoothed(_finite(forward), (3.0, 3.0)))
    if np.isnan(calm).all():
        return patch.centre, False
    row, column = np.unravel_index(int(np.nanargmax(calm)), calm.shape)
    return np.asarray(patch.points[row, column]), bool(patch.distance[row, column] < WIDE - 2.0 * GRID)


def _finite(grid: Floats) -> Floats:
    return np.asarray(np.where(np.isnan(grid), -np.inf, grid))
