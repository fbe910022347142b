"""Observables of the reshaped body: bust points, apexes and girths."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from scipy.spatial import cKDTree

from core.control_mesh.fit import ControlMesh
from core.deformation.incremental_normals import MovingFaces
from core.deformation.tffd import Binding
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points
from core.geometry.plane_sections import cut, hull_corners, hull_perimeter, hull_slopes
from core.landmarks.torso.cross_sections import trunk_levels
from core.landmarks.types import Landmarks
from core.mechanics.iteration import Observables

_SHARPNESS = 1.0  # [mm]
_REACH = 30.0
_CANDIDATES = 400

_NEAR_LEVEL = 60.0
"""No vertex of a body under a garment moves so far up or down [mm]."""


class BodyObservables:
    """Follows a few hundred body vertices through t-FFD, so that a turn is measured without moving them all.

    The bust points are the body vertices nearest to the landmarks. The apex of a breast is the mean of its
    vertices, weighted by exp(-d / 1 mm) with their distance d behind the foremost: a single foremost vertex
    jumps about on a flat breast (ours). Protrusion is the distance in front of the centre of the control
    mesh's border. Calling it with control points, shape (n, 3) [mm], gives Marks; apex of both sides.
    """

    def __init__(self, binding: Binding, control: ControlMesh, landmarks: Landmarks) -> None:
        rest = binding.rest_moving
        points = np.stack([landmarks.position(f"bust_point_{side}") for side in ("left", "right")])
        _, nipples = cKDTree(rest).query(points)
        left, right = (_foremost(rest, on_side) for on_side in _sides(rest, control))
        self._left = slice(2, 2 + len(left))
        self._right = slice(2 + len(left), None)
        rows = np.concatenate([nipples, left, right])
        self._followed, self._bust_points = binding.few(rows), binding.few(rows[:2])
        self._away = points - rest[nipples]
        self._back = float(control.mesh.vertices[control.border_points, 1].mean())

    def bust_points(self, control_points: Points) -> Points:
        """Return where the left and the right bust point are, shape (2, 3) [mm]."""
        return np.asarray(self._bust_points.places(control_points) + self._away)

    def bust_point_slopes(self, control_points: Points, weights: Points) -> Points:
        """Return slopes by the control points, (n, 3), of both bust points times ``weights``, summed."""
        return self._bust_points.gradient(control_points, weights)

    def apexes(self, control_points: Points) -> Points:
        """Return y and z of the left and the right apex, shape (2, 2) [mm]."""
        return self.apex_places(control_points)[:, 1:]

    def apex_places(self, control_points: Points) -> Points:
        """Return where the left and the right apex are, shape (2, 3) [mm]."""
        places = self._followed.places(control_points)
        return np.stack([_apex(places[side]) for side in (self._left, self._right)])

    def apex_slopes(self, control_points: Points, weights: Points) -> Points:
        """Return slopes by the control points, (n, 3), of both apexes times ``weights`` (2, 2), summed."""
        places = self._followed.places(control_points)
        slopes = np.zeros_like(places)
        for side, weight in zip((self._left, self._right), weights, strict=True):
            slopes[side, 1:] = _apex_slopes(places[side], weight)
        return self._followed.gradient(control_points, slopes)

    def __call__(self, control_points: Points) -> Observables:
        """Return the marks for control points, shape (n, 3) [mm]."""
        places = self._followed.places(control_points)
        apex = np.mean([_apex(places[self._left])[1:], _apex(places[self._right])[1:]], axis=0)
        (left_y, left_z), (right_y, right_z) = (places[:2] + self._away)[:, 1:].tolist()
        apex_out, outs = self._back - float(apex[0]), (self._back - left_y, self._back - right_y)
        return Observables(left_z, right_z, float(apex[1]), apex_out, *outs)


def _sides(rest: Points, control: ControlMesh) -> tuple[Flags, Flags]:
    """Return which vertices lie on the free part of the left and of the right breast."""
    _, nearest = cKDTree(control.mesh.vertices).query(rest)
    free = ~control.held[nearest]
    return free & (control.column[nearest] > 0), free & (control.column[nearest] < 0)


def _foremost(rest: Points, on_side: Flags) -> Indices:
    """Return rows of vertices that may become the foremost: near the present one, evenly thinned."""
    rows = np.flatnonzero(on_side)
    near = rows[rest[rows, 1] < rest[rows, 1].min() + _REACH]
    return np.asarray(near[:: max(1, len(near) // _CANDIDATES)])


def _apex(places: Points) -> Points:
    """Return the apex, shape (3,) [mm]: a mean that favours what lies foremost."""
    weight = np.exp((places[:, 1].min() - places[:, 1]) / _SHARPNESS)
    return np.asarray(weight @ places / weight.sum())


def _apex_slopes(places: Points, by: Floats) -> Floats:
    """Return slopes by y and z of the places, (k, 2), of the apex' y and z times ``by`` (2,), summed."""
    weight = np.exp((places[:, 1].min() - places[:, 1]) / _SHARPNESS)
    share = weight / weight.sum()
    away = (places[:, 1:] - share @ places[:, 1:]) @ by
    return np.asarray(share[:, None] * (by - away[:, None] / _SHARPNESS * [1.0, 0.0]))


class Tapes:
    """Tapes laid level round the moved body, arms taken out, at the same heights all the time (ours).

    Only edges of the moving faces are cut anew, those that lie within 60 mm of a level at rest; of the still
    skin the corners of its convex outline are kept. Calling it with ``places`` of ``moving.vertices``, shape
    (r, 3) [mm], gives the length of each tape, shape (k,) [mm], bridging the hollows.
    """

    def __init__(self, moving: MovingFaces, heights: Sequence[float]) -> None:
        edges, middle, still = _apart(moving)
        self._heights = [float(height) for height in heights]
        self._edges = [edges[:, np.abs(middle - z) < _NEAR_LEVEL] for z in self._heights]
        self._still = [_outline(still, moving.body, z) for z in self._heights]

    def __call__(self, places: Points) -> Floats:
        """Return the length of each tape, shape (k,) [mm]."""
        levels = zip(self._heights, self._edges, self._still, strict=True)
        return np.array(
            [hull_perimeter(np.concatenate([still, _cut(places, edges, z)])) for z, edges, still in levels]
        )

    def slopes(self, places: Points) -> Floats:
        """Return the slopes of the tapes by the places, shape (k, r, 3) [1]."""
        found = np.zeros((len(self._heights), *places.shape))
        for slopes, z, edges, still in zip(found, self._heights, self._edges, self._still, strict=True):
            crossing = _crossing(places, edges, z)
            by_point = hull_slopes(np.concatenate([still, _cut(places, edges, z)]))[len(still) :]
            (start, end), (a, b) = crossing, places[crossing]
            part = ((z - a[:, 2]) / (b[:, 2] - a[:, 2]))[:, None]
            steep = np.sum(by_point * (b - a)[:, :2], axis=1, keepdims=True) / (b[:, 2] - a[:, 2])[:, None]
            np.add.at(slopes, start, np.hstack([(1.0 - part) * by_point, (part - 1.0) * steep]))
            np.add.at(slopes, end, np.hstack([part * by_point, -part * steep]))
        return found


@lru_cache(maxsize=1)  # tapes at other heights follow
def _apart(moving: MovingFaces) -> tuple[Indices, Floats, Mesh]:
    """Return the edges that move, shape (2, e), their heights at rest, (e,) [mm], and the still skin."""
    edges = Mesh(moving.rest, moving.corners.T).edges.T
    moves = np.zeros(len(moving.body.vertices), dtype=bool)
    moves[moving.vertices[: moving.count]] = True
    still = Mesh(moving.body.vertices, moving.body.faces[~moves[moving.body.faces].any(axis=1)])
    return edges, moving.rest[edges, 2].mean(axis=0), still


def _outline(still: Mesh, body: Mesh, z: float) -> Points:
    """Return the corners of the convex outline of the trunk's still skin at a height, (h, 2) [mm].

    What bridges holes, or where arms were cut off, counts as still.
    """
    points = cut(still, (0.0, 0.0, z), (0.0, 0.0, 1.0)).points[:, :2]
    level = trunk_levels(body, z)[0]
    if not len(points) or not len(level.segments):
        return np.empty((0, 2))
    away, _ = cKDTree(level.segments.reshape(-1, 3)[:, :2]).query(points)
    kept = np.concatenate([points[away < 1e-6], level.bridges.reshape(-1, 3)[:, :2]])
    corners = hull_corners(kept)
    return np.asarray(kept[corners] if len(corners) else kept)


def _cut(places: Points, edges: Indices, z: float) -> Points:
    """Return where the edges, shape (2, e), cross a height, shape (c, 2) [mm]."""
    a, b = places[_crossing(places, edges, z)]
    part = (z - a[:, 2]) / (b[:, 2] - a[:, 2])
    return np.asarray(a[:, :2] + part[:, None] * (b - a)[:, :2])


def _crossing(places: Points, edges: Indices, z: float) -> Indices:
    """Return those of the edges, shape (2, e), that cross a height, shape (2, c)."""
    above = places[:, 2] >= z
    return edges[:, above.take(edges[0]) != above.take(edges[1])]
