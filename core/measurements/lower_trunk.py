"""Lower trunk that is measured: its sections, landmarks and seat, original or reshaped."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import numpy as np

from core.control_mesh.fit import ControlMesh
from core.control_mesh.lower_template import BELLY_ROW, FOLD_ROW, SEAT, read_lower_template
from core.deformation.tffd import deform
from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Floats, Indices, Mesh, Points
from core.landmarks.lower_trunk.girths import lower_girths
from core.landmarks.lower_trunk.sections import LowerSections
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.torso.girths import Girth
from core.landmarks.torso.torso_axis import share_axis
from core.landmarks.types import SIDES
from core.measurements.tracked_points import TrackedPoints, smoothed_moves, track_points
from core.pipeline.lower_region import LowerStages

Girths = Mapping[str, tuple[Girth, Girth]]
"""Girths before and after by name, at the same heights."""

HIGH_HIP = "high-hip"
"""The line at whose height the girth of the high hip is measured."""

AROUND_SEAT = 30.0
"""The skin over the seat zones is no further outside the box of their control points [mm]. Ours."""


@dataclass(frozen=True, eq=False)
class LowerSubject:
    """What measures of the lower trunk are taken from.

    ``sections`` are those of the skin, ``landmarks`` those of the original body, at whose heights girths are
    taken; ``places`` are where landmarks have moved with the skin, each of shape (3,) [mm]. ``high_hip`` [mm]
    is the height of the high hip, ``seat`` (2,) [ml] the volumes of the left and the right seat.
    """

    sections: LowerSections
    landmarks: LowerLandmarks
    places: Mapping[str, Points]
    high_hip: float
    seat: Floats


def lower_subjects(stages: LowerStages, control_points: Points) -> tuple[LowerSubject, LowerSubject]:
    """Return the lower trunk as scanned, and as ``control_points``, shape (n, 3) [mm], reshape it."""
    found, control = stages.landmarks, stages.fitted
    sections, moved = found.sections, _moved(stages, control_points)
    followed, seat = _followed(found), seat_faces(sections.mesh, control)
    high_hip = float(control.mesh.vertices[list(control.paths[HIGH_HIP]), 2].mean())
    places = followed.moved(moved.mesh.vertices - sections.mesh.vertices)
    shapes = (sections, followed.places), (moved, places)
    before, after = (
        LowerSubject(
            shape,
            found,
            MappingProxyType(dict(zip(found.points, where, strict=True))),
            high_hip,
            _seat_volumes(shape.mesh, seat, control.mesh),
        )
        for shape, where in shapes
    )
    return before, after


def lower_before_after(stages: LowerStages, control_points: Points) -> Girths:
    """Return the girths of the lower trunk at rest, and reshaped by ``control_points`` (n, 3) [mm].

    Those that the scan does not show are left out.
    """
    before = _at_rest(stages.landmarks)
    after = lower_girths(_moved(stages, control_points), stages.landmarks)
    return MappingProxyType({name: (before[name], after[name]) for name in before if name in after})


def _moved(stages: LowerStages, control_points: Points) -> LowerSections:
    """Return the sections of the smoothed skin as ``control_points`` (n, 3) [mm] reshape it."""
    sections = stages.landmarks.sections
    moves = deform(stages.binding, control_points) - stages.body.mesh.vertices
    moved = sections.mesh.moved(sections.mesh.vertices + smoothed_moves(stages.body, moves))
    share_axis(moved, sections.mesh)
    return LowerSections(moved, sections.top, sections.bottom, sections.middle)


def lower_moves(stages: LowerStages, control_points: Points) -> Mapping[str, float]:
    """Return how far buttock points and gluteal folds rise, and how far the belly goes back [mm], by name.

    ``control_points`` (n, 3) [mm] are those of the reshaped body; the points are those of the control mesh
    that lie there at rest.
    """
    template = read_lower_template()
    moves = control_points - stages.control.mesh.vertices
    found = {"belly_back_mm": float(moves[template.point(BELLY_ROW, 0), 1])}
    for side, column, apex in zip(SIDES, (SEAT, -SEAT), stages.control.apexes, strict=True):
        found[f"buttock_{side}_up_mm"] = float(moves[apex, 2])
        found[f"gluteal_fold_{side}_up_mm"] = float(moves[template.point(FOLD_ROW, column), 2])
    return MappingProxyType(found)


@lru_cache(maxsize=2)
def _at_rest(landmarks: LowerLandmarks) -> Mapping[str, Girth]:
    return lower_girths(landmarks.sections, landmarks)


@lru_cache(maxsize=2)
def _followed(landmarks: LowerLandmarks) -> TrackedPoints:
    """Return the landmarks, in their order, bound to the original skin."""
    places = np.array([mark.position for mark in landmarks.points.values()])
    return track_points(landmarks.sections.mesh, places)


@lru_cache(maxsize=2)
def seat_faces(skin: Mesh, control: ControlMesh) -> tuple[Indices, ...]:
    """Return the faces of the original skin over the movable triangles of the left and right seat zone."""
    assert control.zone is not None
    zones = [control.zone_names.index(f"seat-{side}") for side in SIDES]
    zone = np.where((~control.fixed)[control.mesh.faces].any(axis=1), control.zone, -1)
    seat = control.mesh.vertices[control.mesh.faces[np.isin(zone, zones)]].reshape(-1, 3)
    middles = skin.vertices[skin.faces].mean(axis=1)
    low, high = seat.min(axis=0) - AROUND_SEAT, seat.max(axis=0) + AROUND_SEAT
    near = np.flatnonzero(((middles > low) & (middles < high)).all(axis=1))
    own = zone[nearest_faces(control.mesh, middles[near])[0]]
    return tuple(near[own == each] for each in zones)


def _seat_volumes(skin: Mesh, faces: tuple[Indices, ...], control: Mesh) -> Floats:
    """Return the volumes between seats and the middle of the control mesh, shape (2,) [ml]."""
    middle = control.vertices.mean(axis=0)
    return np.array([Mesh(skin.vertices, skin.faces[own]).enclosed_volume(middle) for own in faces]) / 1000.0
