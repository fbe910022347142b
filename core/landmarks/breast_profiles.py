"""Upright profiles of one breast: from beside the bust point down over the fold, across holes."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.mesh import Flags, Floats, Mesh, Points
from core.geometry.plane_sections import arc_length, curvature, cut, downward, join_segments, resample

OFFSETS = np.arange(-44.0, 45.0, 4.0)
"""The fold is traced over profiles so far beside the bust point [mm]."""

OWN = len(OFFSETS) // 2
"""The profile through the bust point."""

BRIDGE = 100.0
"""A profile goes on behind a hole of up to this length [mm]."""

SHORT, LOOSE = 60.0, 15.0
"""What is shorter than this [mm] may be a marker on the skin: longer pieces count as so much nearer [mm]."""

LONGEST = 1500
"""A profile is followed so far [mm]: on a body it is at most 600 mm long, on a torn skin it may wind."""

MOST_PIECES = 200
"""So many pieces of a cut are looked at, the longest ones; on a body with holes there are at most 20."""

MARGIN = 9.0
"""So near to a hole [mm] a smoothed profile bends as the hole does, not as the body."""

RIM = 18.0
"""The direction of the skin at the rim of a hole is that of its last part of this length [mm]."""

ROUND = 70.0
"""Radius of the underside of a breast where a hole hides it [mm]."""

HIGHEST = 0.3
"""Above the lower rim of a hole a hidden fold lies no higher than this part of the hole's length [1]."""


@dataclass(frozen=True, eq=False)
class Profile:
    """A profile from beside the bust point downwards, a point each mm, shape (k, 3) [mm].

    ``bend`` is its curvature, positive where it is hollow [1/mm]; ``seen`` is False near a hole; ``whole``
    tells that it reaches its lower end, or turns to the back above it, without one.
    """

    points: Points
    bend: Floats
    seen: Flags
    whole: bool


def profiles(mesh: Mesh, bust: Points, bottom: float) -> list[Profile]:
    """Return the profiles at ``OFFSETS`` beside the bust point, down to the height ``bottom`` [mm].

    A profile is empty where there is no surface.
    """
    beside = mesh.vertices[:, 0] - bust[0]
    x = np.stack([beside[corner] for corner in mesh.faces.T])
    crossed = (x.min(axis=0) <= OFFSETS[-1]) & (x.max(axis=0) >= OFFSETS[0])
    used, faces = np.unique(mesh.faces[crossed], return_inverse=True)
    strip = Mesh(mesh.vertices[used], faces.reshape(-1, 3))
    return [_profile(strip, bust, offset, bottom) for offset in OFFSETS]


def _profile(mesh: Mesh, bust: Points, offset: float, bottom: float) -> Profile:
    pieces = join_segments(cut(mesh, bust + np.array([offset, 0.0, 0.0]), (1.0, 0.0, 0.0)))[:MOST_PIECES]
    start = bust + np.array([offset, 0.0, 0.0])
    if not pieces:
        return _measured(start[None], np.empty((0, 2, 3)), bottom)
    distances = [np.linalg.norm(curve - start, axis=1) for curve, _ in pieces]
    lengths = [arc_length(curve)[-1] for curve, _ in pieces]
    away = [d.min() + LOOSE * (length < SHORT) for d, length in zip(distances, lengths, strict=True)]
    nearest = int(np.argmin(away))
    own, closed = pieces.pop(nearest)
    curve, rest = _downward(own, closed, int(np.argmin(distances[nearest])))
    bridges = []
    # Round a body without an opening the skin below the hole is the other end of the same piece.
    ends = [rest, rest] + [piece[::turn] for piece, ring in pieces if not ring for turn in (1, -1)]
    if (
        closed
    ):  # without a hole: where the body is narrower below, the profile ends at the back of what is here
        curve, ends = curve[: int(np.argmax(curve[:, 1])) + 1], []
    starts, parts = np.array([end[0] for end in ends]).reshape(-1, 3), [curve]
    free = np.ones(len(ends), dtype=bool)
    while parts[-1][-1, 2] > bottom and free.any():
        last = parts[-1][-1]
        jumps = np.where(
            free & (starts[:, 2] < last[2] + 25.0), np.linalg.norm(starts - last, axis=1), np.inf
        )
        nearest = int(np.argmin(jumps))
        if jumps[nearest] > BRIDGE:
            break
        fold = _hidden_fold(parts[-1], ends[nearest])
        corners = [last, *fold, starts[nearest]]
        bridges += [list(pair) for pair in pairwise(corners)]
        parts += [fold, ends[nearest]]
        free[nearest - nearest % 2 : nearest - nearest % 2 + 2] = False
    curve = np.concatenate(parts)
    below = np.flatnonzero(curve[:, 2] < bottom)
    curve = curve[: below[0] + 1] if len(below) else curve
    return _measured(curve, np.reshape(bridges, (-1, 2, 3)), np.inf if closed else bottom)


def _hidden_fold(above: Points, below: Points) -> Points:
    """Return where the fold lies in the hole between two parts of a profile, shape (1, 3) [mm]; else (0, 3).

    The underside of the breast goes on as an arc to where it meets the straight chest. Source: ours.
    """
    gap = float(np.linalg.norm(below[0] - above[-1]))
    if gap < MARGIN:
        return np.empty((0, 3))
    start, way = _at_rim(above[::-1])
    end, up = _at_rim(below)
    if up[1] < 0.5:  # what lies below the hole is no chest that stands upright
        up = np.array([0.0, 1.0])
    inward = np.array([-way[1], way[0]])
    inward *= 1.0 if inward.sum() > 0.0 else -1.0
    centre = start + ROUND * inward
    along = float((centre - end) @ up)
    apart = ROUND**2 - float((centre - end) @ (centre - end)) + along**2
    height = float(np.clip(along - np.sqrt(max(apart, 0.0)), 0.0, HIGHEST * gap))
    return np.array([[above[-1, 0], *(end + height * up)]])


def _at_rim(curve: Points) -> tuple[Floats, Floats]:
    """Return place and direction, out of the skin, at the first point of ``curve``: y and z, shape (2,)."""
    arc = arc_length(curve)
    part = resample(curve[: max(int(np.searchsorted(arc, RIM)), 2)], 1.0)[:, 1:]
    middle = part.mean(axis=0)
    way = np.linalg.svd(part - middle)[2][0]
    way = way if way @ (part[0] - part[-1]) > 0.0 else -way
    return middle + way * ((part[0] - middle) @ way), way


def _downward(curve: Points, closed: bool, start: int) -> tuple[Points, Points]:
    """Return ``curve`` from ``start`` on in the direction that leads down over the first 18 mm, and the rest.

    The rest runs from its far end towards ``start``.
    """
    ways = [way for way in downward(curve, closed, start) if len(way) > 1] or [curve, curve[:1]]
    return ways[0], ways[-1][::-1]


def _measured(curve: Points, bridges: Points, bottom: float) -> Profile:
    """Smooth ``curve`` by 4 mm, at a step of 1 mm of its smoothed length, and measure how it bends."""
    if len(curve) < 2:
        return Profile(curve, np.zeros(len(curve)), np.zeros(len(curve), dtype=bool), False)
    points = resample(gaussian_filter1d(resample(curve, 1.0), 4.0, axis=0, mode="nearest"), 1.0)[:LONGEST]
    seen = np.ones(len(points), dtype=bool)
    for a, b in bridges:
        length = float(np.linalg.norm(b - a))
        if length > 3.0:
            t = np.clip((points - a) @ (b - a) / length**2, 0.0, 1.0)
            seen &= np.linalg.norm(points - (a + t[:, None] * (b - a)), axis=1) > MARGIN
    whole = bool(seen.all() and points[-1, 2] < bottom + 5.0)
    return Profile(points, curvature(points[:, 2], points[:, 1]), seen, whole)
