"""Rays from the axis of the torso, upright profiles of the body round that axis, and the folds on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Floats, Mesh, Points, unit
from core.geometry.plane_sections import (
    Section,
    arc_length,
    cut,
    downward,
    hull_corners,
    join_segments,
    resample,
)

STEP = 2.0
"""Distance of the points on which a profile is judged [mm]."""

ABOVE = 90.0
"""A profile may rise so far above its start on the way to a fold behind a hanging breast [mm]."""

BEND = 5
"""The turning of a profile is taken between chords of so many steps on both sides."""


def azimuth_direction(azimuth: float) -> Points:
    """Return the level unit vector at ``azimuth`` [rad]: 0 is forward (-y), positive the subject's left."""
    return np.array([np.sin(azimuth), -np.cos(azimuth), 0.0])


def ray_exits(mesh: Mesh, origins: Points, directions: Points) -> list[Floats]:
    """Return where level rays leave the body: for each the distances [mm] from its origin, ascending.

    ``origins`` have shape (k, 3) [mm], ``directions`` (k, 3) [1] are level. A ray leaves through triangles
    whose outward normal points along it; one through an edge counts both its triangles.
    """
    a, b, c = (mesh.vertices[mesh.faces[:, k], 2] for k in range(3))
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    ways = []
    for origin, frame in zip(origins, _ray_frames(unit(directions)), strict=True):
        level = np.flatnonzero((low <= origin[2]) & (high >= origin[2]))
        ways.append(_exits_along_z((mesh.vertices[mesh.faces[level]] - origin) @ frame.T))
    return ways


def _ray_frames(along: Points) -> Points:
    """Return right-handed axes (across, across, along), shape (k, 3, 3) [1], for each ray."""
    across = unit(np.cross(along, (0.0, 0.0, 1.0)))
    return np.stack([across, np.cross(along, across), along], axis=1)


def _exits_along_z(corners: Points) -> Floats:
    """Return the positive z where the z axis leaves triangles with these corners, shape (m, 3, 3)."""
    u, v, depth = corners[:, :, 0], corners[:, :, 1], corners[:, :, 2]
    weight = np.stack([u[:, k - 2] * v[:, k - 1] - u[:, k - 1] * v[:, k - 2] for k in range(3)], axis=1)
    area = weight.sum(axis=1)
    hit = (weight >= 0.0).all(axis=1) & (area > 0.0)
    z = (weight[hit] * depth[hit]).sum(axis=1) / area[hit]
    return np.sort(z[z > 0.0])


@dataclass(frozen=True, eq=False)
class Profile:
    """The body followed downwards in an upright half plane through the axis of the torso.

    ``points``, shape (k, 3) [mm], from the bust row down; ``arc``, shape (k,) [mm], the way to each of them;
    ``reach``, shape (k,) [mm], its distance from the axis.
    """

    points: Points
    arc: Floats
    reach: Floats

    def at(self, arc: float) -> Points:
        """Return the place ``arc`` [mm] down the profile, shape (3,) [mm]."""
        return np.array([np.interp(arc, self.arc, self.points[:, k]) for k in range(3)])

    def next_below(self, arc: float, z: float) -> float:
        """Return the way to the first place beyond ``arc`` lower than ``z``, to the end if none is [mm]."""
        below = (self.points[:, 2] < z) & (self.arc >= arc)
        return float(self.arc[np.argmax(below)] if below.any() else self.arc[-1])


def profile(front: Mesh, axis: Points, start: Points, bottom: float) -> Profile | None:
    """Trace the body from ``start`` [mm] down to the height ``bottom`` [mm]; None if a hole interrupts it.

    ``axis``, shape (3,) [mm], is a point on the axis of the torso.
    """
    along = unit((start - axis) * (1.0, 1.0, 0.0))
    section = cut(front, axis, np.cross(along, (0.0, 0.0, 1.0)))
    middle = section.segments.mean(axis=1)
    near = (
        ((middle - axis) @ along > 0.0) & (middle[:, 2] > bottom - 20.0) & (middle[:, 2] < start[2] + ABOVE)
    )
    pieces = join_segments(Section(section.segments[near], section.edge_ids[near]))
    if not pieces:
        return None
    away = [((curve - start) ** 2).sum(axis=1) for curve, _ in pieces]
    best = int(np.argmin([distance.min() for distance in away]))
    curve = downward(*pieces[best], int(np.argmin(away[best])), start)[0]
    below = np.flatnonzero(curve[:, 2] < bottom)
    if len(below) == 0:
        return None
    curve = curve[: below[0] + 1]
    return Profile(curve, arc_length(curve), (curve - axis) @ along)


@dataclass(frozen=True)
class Fold:
    """A fold on a profile: the way to it [mm], its depth under the convex outline [mm], its height [mm]."""

    arc: float
    depth: float
    z: float


def find_fold(profile: Profile, sharpest: bool) -> Fold | None:
    """Return the fold of a profile: the place deepest under its convex outline, None if it is all convex.

    With ``sharpest`` it is where the profile turns most within the hollow of that place. Source: ours.
    """
    curve = resample(np.column_stack([profile.arc, profile.reach, profile.points[:, 2]]), STEP)
    arc, flat = curve[:, 0], curve[:, 1:]
    outline = _outline(flat)
    if outline is None:
        return None
    number = np.arange(len(flat))
    end = np.clip(np.searchsorted(outline, number), 1, len(outline) - 1)
    start, stop = flat[outline[end - 1]], flat[outline[end]]
    chord = unit(stop - start)
    depth = np.abs((flat - start)[:, 0] * chord[:, 1] - (flat - start)[:, 1] * chord[:, 0])
    depth[(number < outline[0]) | (number > outline[-1])] = 0.0
    at = int(np.argmax(depth))
    deepest = float(depth[at])
    if sharpest:
        hollow = (number > outline[end[at] - 1]) & (number < outline[end[at]])
        at = int(np.argmax(np.where(hollow, _turning(flat), -np.inf)))
    return Fold(float(arc[at]), deepest, float(flat[at, 1]))


def _outline(flat: Points) -> np.ndarray | None:
    """Return the points of a profile, shape (k, 2), that lie on the convex outline seen from outside."""
    inner = flat[:, 0].min() - 1000.0
    closing = [(inner, flat[:, 1].max()), (inner, flat[:, 1].min())]
    corners = hull_corners(np.concatenate([flat, closing]))
    return np.sort(corners[corners < len(flat)]) if len(corners) else None


def _turning(flat: Points) -> Floats:
    """Return how far a profile, shape (k, 2), turns hollow at each point, shape (k,) [rad]."""
    turning = np.full(len(flat), -np.inf)
    if len(flat) > 2 * BEND:
        before, after = flat[BEND:-BEND] - flat[: -2 * BEND], flat[2 * BEND :] - flat[BEND:-BEND]
        hollow = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
        turning[BEND:-BEND] = np.arctan2(hollow, (before * after).sum(axis=1))
    return turning
