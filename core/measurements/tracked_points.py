"""Places that ride on the skin: where they are on a body whose vertices have moved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Faces, Floats, Mesh, Points
from core.landmarks.types import SIDES, Landmark, Landmarks
from core.scan.body import Body

SAME = 1e-6
"""Heights that differ by less are one [mm]."""


@dataclass(frozen=True, eq=False)
class TrackedPoints:
    """Places, shape (k, 3) [mm], that move as the triangles ``corners`` (k, 3) below them, by ``shares``."""

    places: Points
    corners: Faces
    shares: Floats

    def moved(self, moves: Points) -> Points:
        """Return where they are after the vertices made ``moves``, shape (n, 3) [mm]; (k, 3) [mm]."""
        return np.asarray(self.places + np.einsum("kc,kcj->kj", self.shares, moves[self.corners]))


def track_points(mesh: Mesh, places: Points) -> TrackedPoints:
    """Bind ``places``, shape (k, 3) [mm], to the nearest skin of ``mesh``; they keep their distance to it."""
    faces, feet = nearest_faces(mesh, places)
    corners = mesh.faces[faces]
    return TrackedPoints(places, corners, barycentric(mesh.vertices[corners], feet))


def moved_landmarks(landmarks: Landmarks, places: Points) -> Landmarks:
    """Return ``landmarks`` at other ``places``, in their order, shape (k, 3) [mm].

    The levels follow the landmarks that they were taken from.
    """
    marks = landmarks.points.items()
    points = {name: replace(mark, position=place) for (name, mark), place in zip(marks, places, strict=True)}
    bust, under = _levels(landmarks.points, landmarks, points)
    return Landmarks(MappingProxyType(points), bust, under, landmarks.warnings, landmarks.hints)


def _levels(
    before: Mapping[str, Landmark], landmarks: Landmarks, after: Mapping[str, Landmark]
) -> tuple[float, float]:
    """Return the two levels after, of the sides that they were taken from before."""

    def heights(points: Mapping[str, Landmark], names: tuple[str, ...], sides: tuple[str, ...]) -> Floats:
        wanted = [f"{name}_{side}" for name in names for side in sides]
        return np.array([points[name].position[2] for name in wanted if name in points])

    for sides in (SIDES, SIDES[:1], SIDES[1:]):
        bust, under = heights(before, ("bust_point",), sides), heights(before, ("fold", "lowest"), sides)
        if len(bust) and len(under) and abs(bust.mean() - landmarks.bust_level) < SAME:
            shift = landmarks.underbust_level - float(under.min())
            low = float(heights(after, ("fold", "lowest"), sides).min())
            return float(heights(after, ("bust_point",), sides).mean()), low + shift
    return landmarks.bust_level, landmarks.underbust_level


def smoothed_moves(body: Body, moves: Points) -> Points:
    """Return how the vertices of the calm skin move where those of the scan make ``moves``, (n, 3) [mm].

    The calm skin has the vertices of the scan, or, of a giant scan, fewer: these go as the nearest do.
    """
    if len(body.smoothed.vertices) == len(moves):
        return moves
    nearest = cKDTree(body.mesh.vertices).query(body.smoothed.vertices)[1]
    return np.asarray(moves[nearest])
