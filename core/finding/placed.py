"""Landmarks that the designer placed by hand: checked, and laid on the skin."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from trimesh.triangles import closest_point

from core.errors import LandmarkError
from core.landmark import NAMES, Landmark
from core.mesh import Mesh, Points

PLACED = "Placed by hand."

REACH = 30.0
"""A placed point may lie so far off the skin [mm]."""


def placed_marks(mesh: Mesh, placed: Mapping[str, Points]) -> dict[str, Landmark]:
    """Return ``placed`` points, each of shape (3,) [mm], as landmarks at the nearest place of the skin.

    Raises LandmarkError for a name that no landmark has, and for a place that is not near the skin.
    """
    return {name: _placed(mesh, name, place) for name, place in placed.items()}


def _placed(mesh: Mesh, name: str, place: Points) -> Landmark:
    if name not in NAMES:
        raise LandmarkError(f"There is no landmark {name}.", f"Choose one of {', '.join(NAMES)}.")
    point = np.asarray(place, dtype=np.float64)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise LandmarkError(f"{name} needs a place with three numbers.", "Give x, y and z in mm.")
    corners = mesh.vertices[mesh.faces]
    near = (corners.min(axis=1) <= point + REACH).all(axis=1) & (corners.max(axis=1) >= point - REACH).all(
        axis=1
    )
    spots = closest_point(corners[near], np.broadcast_to(point, (int(near.sum()), 3)))
    away = np.linalg.norm(spots - point, axis=1)
    if away.min(initial=np.inf) > REACH:
        raise LandmarkError(
            f"{name} was placed more than {REACH:.0f} mm off the skin.", "Place it on the skin of the body."
        )
    return Landmark(name, spots[np.argmin(away)], 1.0, PLACED, by_hand=True)
