"""Flat ends of a scan: plates and rims of plane cuts. Their normals tell what was level when it was cut."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from core.geometry.mesh import Floats, Points, unit

TOUCH = 1.3
"""A point nearer to a plane than this [grains] touches it: even points lie up to a grain inside a rim."""

DRIFT, BEYOND = np.cos(np.radians(8.0)), 0.01
"""A flat end lies along the hull, to an angle [cosine]; no more than this share of points is beyond it."""

TRIED = 16
"""Faces of the hull, largest first, that are tried as flat ends."""


@dataclass(frozen=True, eq=False)
class CutPlane:
    """A plane {p: p . normal = offset} that a skin ends at: ``normal`` points out of the body, shape (3,).

    ``area`` is in file units^2; ``filled`` tells a plate from the rim of a hole.
    """

    normal: Floats
    offset: float
    area: float
    filled: bool


def find_cut_planes(
    points: Points, grain: float, towards: Floats | None = None, within: float = 30.0
) -> list[CutPlane]:
    """Return the flat ends of even ``points``, shape (n, 3), largest first. Source: ours.

    With ``towards``, shape (3,), only those that face it ``within`` an angle [degrees]. A hull face is a flat
    end if points touch it all the way round.
    """
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return []
    corners = points[hull.simplices]
    areas = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    normals = hull.equations[:, :3]
    if towards is not None:
        areas = np.where(normals @ towards > np.cos(np.radians(within)), areas, 0.0)
    found: list[CutPlane] = []
    tried: list[Floats] = []
    for face in np.argsort(-areas):
        if areas[face] == 0.0 or len(tried) == TRIED:
            break
        if all(normals[face] @ other < np.cos(np.radians(4.0)) for other in tried):
            tried.append(normals[face])
            end = _flat_end(points, grain, normals[face], float(-hull.equations[face, 3]))
            if end is not None and all(end.normal @ other.normal < 0.98 for other in found):
                found.append(end)
    return sorted(found, key=lambda end: -end.area)


def _flat_end(points: Points, grain: float, normal: Floats, offset: float) -> CutPlane | None:
    """Lay a plane through all points that touch a hull face; None if they do not go all the way round."""
    first_normal = normal
    for _ in range(3):
        depth = offset - points @ normal
        touching = points[np.abs(depth) < TOUCH * grain]
        if len(touching) < 12:
            return None
        centre = touching.mean(axis=0)
        fitted = np.linalg.svd(touching - centre, full_matrices=False)[2][2]
        normal = fitted * np.sign(fitted @ normal)
        offset = float(centre @ normal) + 0.3 * grain
    beyond = (points @ normal - offset > TOUCH * grain).mean()
    if normal @ first_normal < DRIFT or beyond > BEYOND:  # it slid into the body: a round place, no flat one
        return None
    first = unit(np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))]))
    flat = (touching - centre) @ np.stack([first, np.cross(normal, first)], axis=1)
    try:
        outline = ConvexHull(flat)
    except (QhullError, ValueError):
        return None
    angle = np.sort(np.arctan2(flat[:, 1], flat[:, 0]))
    gap = np.diff(angle, append=angle[0] + 2.0 * np.pi).max()
    length, area = float(outline.area), float(outline.volume)  # of a plane hull: its perimeter and its area
    if gap > np.radians(40.0) or len(touching) < 0.7 * length / grain:
        return None
    return CutPlane(normal, offset, area, len(touching) > 0.5 * area / grain**2)
