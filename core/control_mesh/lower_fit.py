"""Fit of the template of the lower trunk to a body: rows by landmarks, columns by arcs of its sections."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from core.control_mesh.fit import LOWER, ControlMesh
from core.control_mesh.lower_places import LowerPlaces
from core.control_mesh.lower_template import BELLY_ROW, FOLD_ROW, HALF, HIP_ROW, SEAT, SIDE, LowerTemplate
from core.control_mesh.quality import LOOSE, FitQuality, measure_fit
from core.control_mesh.skin_projection import SurfaceProjector
from core.control_mesh.validation import find_mesh_faults
from core.errors import FitError
from core.geometry.mesh import Flags, Mesh, Points, unit
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.messages import Length, Message
from core.scan.body import Body

ROUNDS, MOST = 3, 4.0
"""Rounds of easing, and the farthest that a point moves in one [mm]; ours."""

OVER_WAIST = 10.0
"""The rows of the bust are joined where they stay so far over the waist row [mm]; ours."""


def fit_lower_mesh(
    template: LowerTemplate,
    body: Body,
    landmarks: LowerLandmarks,
    bust: ControlMesh | None = None,
    *,
    underbust: float,
    belly_height: float = 0.45,
) -> ControlMesh:
    """Fit ``template`` to a body from the under-bust level ``underbust`` [mm] down; the recipe is ours.

    With a ``bust`` the two upper rows take the places of its fold row and its collar below in front.
    ``belly_height`` [1] is where the belly row runs from waist (0) to hip (1). Raises FitError if no sound
    mesh lies on this body.
    """
    places = LowerPlaces(template, landmarks, underbust, belly_height)
    points = np.concatenate([places.trunk(), places.crotch[None], *places.legs()])
    if bust is not None:
        _join(points, template, bust, places.waist)
    skin = SurfaceProjector(body.smoothed)
    control = lower_mesh_at(template, _eased(points, template, skin))
    sharp = (template.row >= FOLD_ROW) | (np.abs(template.column) == HALF)
    folded = int(find_mesh_faults(control.mesh, skin, sharp).folded.sum())
    if folded:
        raise FitError(
            Message("Folded triangles in the control mesh of the lower trunk: {count}.", count=folded),
            Message("Correct the landmarks of waist, buttocks, gluteal folds and crotch."),
        )
    quality = measure_fit(control.mesh, skin, sharp, 0.0, 0.0)
    return replace(control, quality=quality, warnings=_warnings(quality))


def lower_mesh_at(template: LowerTemplate, points: Points) -> ControlMesh:
    """Return the control mesh of a template with its control points at ``points``, (n, 3) [mm]."""
    top = [template.point(0, column) for column in range(1 - HALF, HALF + 1)]
    loops = top, *(template.loop(side, FOLD_ROW + 2) for side in (0, 1))
    return ControlMesh(
        Mesh(points, template.faces),
        template.fixed,
        template.row,
        template.column,
        template.paths,
        (template.point(HIP_ROW, SEAT), template.point(HIP_ROW, -SEAT)),
        tuple(np.array(loop, dtype=np.int64) for loop in loops),
        (),
        region=LOWER,
        zone=template.zone,
        zone_names=template.zone_names,
        kept=template.kept,
        depth=template.depth,
        inner_points=(template.point(3, 0), template.point(BELLY_ROW, 0), template.point(3, HALF)),
    )


def _join(points: Points, template: LowerTemplate, bust: ControlMesh, waist: float) -> None:
    """Put the front of the two upper rows where the bust's fold row and collar below are, if that fits."""
    rows = []
    for lower, upper in ((0, 1), (1, 0)):
        for column in range(-SIDE, SIDE + 1):
            (there,) = np.flatnonzero((bust.row == upper) & (bust.column == column))
            rows.append((template.point(lower, column), int(there)))
    own, others = np.array(rows).T
    if bust.mesh.vertices[others, 2].min() > waist + OVER_WAIST:
        points[own] = bust.mesh.vertices[others]


def _eased(points: Points, template: LowerTemplate, skin: SurfaceProjector) -> Points:
    """Return points that slide along their rows towards the middle of their neighbours, on the skin."""
    slides = _sliding(template)
    own = np.flatnonzero(slides)
    ring = np.arange(2 * HALF)
    before, after = (
        template.row[own] * 2 * HALF + np.roll(ring, turn)[template.column[own] + HALF - 1]
        for turn in (1, -1)
    )
    points = points.copy()
    for _ in range(ROUNDS):
        along = unit(points[after] - points[before])
        step = 0.25 * (points[after] + points[before]) - 0.5 * points[own]
        far = np.clip((step * along).sum(axis=1), -MOST, MOST)
        points[own] = skin.project(points[own] + far[:, None] * along)
    return points


def _sliding(template: LowerTemplate) -> Flags:
    """Return which points may slide along their row, (n,): none on centres, landmarks and in the crease."""
    column = np.abs(template.column)
    stays = template.fixed | (column == 0) | (column == HALF)
    stays |= (template.row == HIP_ROW) & (column == SEAT)
    stays |= (template.row == FOLD_ROW) & ((column == 1) | (column == SEAT + 1))
    return np.asarray(~stays)


def _warnings(quality: FitQuality) -> tuple[Message, ...]:
    if quality.deviation_mean <= LOOSE:
        return ()
    off = Length(quality.deviation_mean, 1)
    return (
        Message("The control mesh of the lower trunk is coarse: {mean} off the skin on average.", mean=off),
    )
