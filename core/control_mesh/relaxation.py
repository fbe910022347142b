"""Easing a laid template: its points slide along the skin until no triangle is too pointed."""

from __future__ import annotations

import numpy as np

from core.control_mesh.skin_projection import SurfaceProjector
from core.control_mesh.validation import corner_angles
from core.geometry.mesh import Flags, Indices, Mesh, Points, unit

WISH = 18.0
"""Angles are eased up to this [deg] ..."""

ENOUGH = 15.2
"""... and left alone from here on."""

ROUNDS = 60
"""So many times points are moved at most ..."""

STEP = 4.0
"""... by so much at most [mm]."""

LOST = 6.0
"""A point further than this from the skin bridges a hole [mm]: it stays where it was moved to."""


def relax(points: Points, faces: Indices, skin: SurfaceProjector, level: Flags, upright: Flags) -> Points:
    """Return ``points``, shape (rows, columns, 3) [mm], moved along the skin so that small angles grow.

    Points ``level`` may slide along their row, points ``upright`` along their column, both of shape
    (rows, columns). Each round makes every angle that is too small as large as it should be, by the least
    movement of its corners. The best that was found is returned. Source: ours.
    """
    shape, best, best_angle = points.shape, points, _smallest(points, faces)
    for _ in range(ROUNDS):
        if best_angle >= ENOUGH:
            break
        ways = _ways(points, level, upright)
        flat = points.reshape(-1, 3)
        move = _least_move(flat, faces, ways)
        moved = np.flatnonzero((move != 0.0).any(axis=1))
        if not len(moved):
            break
        places = flat[moved] + move[moved]
        on_skin = skin.project(places)
        lost = np.linalg.norm(on_skin - places, axis=1) > LOST
        flat = flat.copy()
        flat[moved] = np.where(lost[:, None], places, on_skin)
        points = flat.reshape(shape)
        smallest = _smallest(points, faces)
        if smallest > best_angle:
            best, best_angle = points, smallest
    return best


def _smallest(points: Points, faces: Indices) -> float:
    return float(corner_angles(Mesh(points.reshape(-1, 3), faces)).min())


def _ways(points: Points, level: Flags, upright: Flags) -> Points:
    """Return the one or two ways in which each point may slide, zero where it may not, (n, 2, 3) [1]."""
    along, up = (unit(np.gradient(points, axis=axis)) for axis in (1, 0))
    along = np.where(level[..., None], along, 0.0)
    up = unit(up - (up * along).sum(axis=2, keepdims=True) * along)
    up = np.where(upright[..., None], up, 0.0)
    return np.stack([along, up], axis=2).reshape(-1, 2, 3)


def _least_move(points: Points, faces: Indices, ways: Points) -> Points:
    """Return the mean of the least moves that would put each angle that is too small right, (n, 3) [mm]."""
    angle = corner_angles(Mesh(points, faces))
    face, corner = np.nonzero(angle < WISH)
    tip, after, last = (faces[face, (corner + k) % 3] for k in range(3))
    angle = np.radians(angle[face, corner])
    along = [points[ends] - points[tip] for ends in (after, last)]
    length = [np.linalg.norm(side, axis=1)[:, None] for side in along]
    first, second = (side / size for side, size in zip(along, length, strict=True))
    sine, cosine = np.sin(angle)[:, None], np.cos(angle)[:, None]
    slopes = [(cosine * first - second) / (sine * length[0]), (cosine * second - first) / (sine * length[1])]
    slopes.append(-slopes[0] - slopes[1])
    slopes = [
        np.einsum("kw,kwj->kj", np.einsum("kwj,kj->kw", ways[ends], slope), ways[ends])
        for ends, slope in zip((after, last, tip), slopes, strict=True)
    ]
    size = sum((slope**2).sum(axis=1) for slope in slopes)
    wanted = np.where(size > 1e-12, (np.radians(WISH) - angle) / np.maximum(size, 1e-12), 0.0)
    move, count = np.zeros_like(points), np.zeros(len(points))
    for ends, slope in zip((after, last, tip), slopes, strict=True):
        np.add.at(move, ends, wanted[:, None] * slope)
        np.add.at(count, ends, 1.0)
    move /= np.maximum(count, 1.0)[:, None]
    size = np.linalg.norm(move, axis=1, keepdims=True)
    return np.asarray(move * np.minimum(1.0, STEP / np.maximum(size, 1e-12)))
