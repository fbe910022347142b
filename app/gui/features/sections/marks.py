"""Marks on section curves: bust points, apexes and uncertainty of the skin."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from app.i18n.lengths import length_unit
from app.presenters.bust_shift import bust_shift
from app.presenters.maps import BodyState
from app.presenters.measurements import length_uncertainty
from core.geometry.mesh import Floats
from core.geometry.planar_curves import Curve, Plane, Slicer, apexes
from core.measurements.uncertain_value import OutputUncertainties

AROUND = 12.0
"""What is seen beside the part that can move [mm]."""

NEAR_BUST_POINT = 10.0
"""A plane that far from a bust point still shows it [mm]."""


def side_of(now: BodyState, plane: Plane) -> str:
    """Return on which side of the body an upright plane stands."""
    return "left" if plane.at > now.stages.moving.middle else "right"


def bust_points(now: BodyState, plane: Plane) -> list[tuple[Floats, Floats]]:
    """Return a bust point before and after, each (2,) [mm], if the plane stands upright through it."""
    side = side_of(now, plane)
    mark = now.stages.landmarks.points.get(f"bust_point_{side}")
    if plane.axis != "x" or mark is None or abs(mark.position[0] - plane.at) > NEAR_BUST_POINT:
        return []
    move = bust_shift(now.frame)
    step = move.left if side == "left" else move.right
    former = plane.flat(mark.position)
    return [(former, former + np.array([step.forward, step.up]))]


def home(now: BodyState, plane: Plane) -> Floats:
    """Return the box of what can move, in the plane, (2, 2) [mm]."""
    control = now.stages.control
    free = plane.flat(control.mesh.vertices[~control.fixed])
    return np.stack([free.min(axis=0) - AROUND, free.max(axis=0) + AROUND])


def apex_pairs(
    now: BodyState, plane: Plane, former: Sequence[Curve], present: Sequence[Curve]
) -> list[tuple[Floats, Floats]]:
    """Return the apexes of two kinds of curves, pair by pair, each (2,) [mm]."""
    control = now.stages.control
    free = control.mesh.vertices[~control.fixed]
    box = free.min(axis=0), free.max(axis=0), now.stages.moving.middle
    found = [apexes(plane, curves, *box) for curves in (former, present)]
    return list(zip(*found, strict=True)) if len(found[0]) == len(found[1]) else []


def bands(
    now: BodyState, slicer: Slicer, curves: Mapping[str, Sequence[Curve]], spread: OutputUncertainties | None
) -> dict[str, list[Floats]]:
    """Return outlines of where the skin may lie, before and after, each (k, 2) [mm]; none if not known."""
    if spread is None:
        return {}
    after = slicer.interpolate(now.places, spread.sds * spread.skin)
    before = [np.full(len(curve.places), spread.sds * spread.rest) for curve in curves["before"]]
    return {
        role: [_round(curve, off) for curve, off in zip(curves[role], offs, strict=True)]
        for role, offs in (("before", before), ("after", after))
    }


def most_off(
    now: BodyState, slicer: Slicer, curves: Sequence[Curve], spread: OutputUncertainties | None
) -> tuple[Floats, Floats, str] | None:
    """Return where the skin may be off the most in the box that is seen first: place, way out, and the ±."""
    if spread is None:
        return None
    low, high = home(now, slicer.plane)
    found = []
    for curve, off in zip(curves, slicer.interpolate(now.places, spread.sds * spread.skin), strict=True):
        inside = ((curve.places > low) & (curve.places < high)).all(axis=1)
        if inside.any():
            at = int(np.argmax(np.where(inside, off, -1.0)))
            found.append((curve.places[at], curve.normals[at], float(off[at])))
    if not found:
        return None
    place, way, most = max(found, key=lambda each: each[2])
    return place, way, f"{length_uncertainty(most)} {length_unit()}"


def _round(curve: Curve, off: Floats) -> Floats:
    step = off[:, None] * curve.normals
    return np.concatenate([curve.places + step, (curve.places - step)[::-1]])
