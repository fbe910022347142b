"""Mirror planes of a body: even points on its skin, and the planes that map them onto themselves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import distance_transform_edt

from core.mesh import Faces, Floats, Indices, Points, area_vectors, unit

GRAINS = 110
"""Grains along the diagonal of the body: the grain is the spacing of everything here."""

SAMPLES = 30_000
"""Points laid on the skin before they are averaged, one a grain-sized cell."""

FAR = 6.0
"""A mirrored point this many grains off the skin [1] counts as having no partner."""


@dataclass(frozen=True, eq=False)
class Cloud:
    """Even points on a skin, shape (k, 3) [file units], with unit normals, one a cell of size ``grain``.

    ``nearest`` holds for each cell of the box around them the index of the nearest point, -1 if far off; cell
    (0, 0, 0) starts at ``corner``.
    """

    points: Points
    normals: Points
    grain: float
    corner: Floats
    nearest: Indices

    def partner(self, places: Points) -> Indices:
        """Return the index of the point nearest to each place, shape (..., 3), or -1 if far off."""
        cell = np.floor((places - self.corner) / self.grain).astype(np.int64)
        inside = np.all((cell >= 0) & (cell < self.nearest.shape), axis=-1)
        x, y, z = np.moveaxis(np.where(inside[..., None], cell, 0), -1, 0)
        return np.where(inside, self.nearest[x, y, z], -1)


@dataclass(frozen=True, eq=False)
class MirrorPlane:
    """The plane {p: p . side = offset} along the file axis ``up`` (0, 1, 2).

    ``side`` is a unit vector, shape (3,); ``offset`` in file units; ``residual`` is 0 for a perfect mirror.
    """

    up: int
    side: Floats
    offset: float
    residual: float


def even_cloud(vertices: Points, faces: Faces) -> Cloud:
    """Lay even points on a skin, whatever its triangles are like. Any unit. Source: ours."""
    points, normals = _sample(vertices, faces)
    low, high = np.percentile(points, (1, 99), axis=0)
    grain = float(np.linalg.norm(high - low)) / GRAINS
    margin = 0.35 * (high - low) + FAR * grain  # a speck far away must not blow the box up
    near = ((points > low - margin) & (points < high + margin)).all(axis=1)
    points, normals = points[near], normals[near]
    corner = points.min(axis=0) - (FAR + 1.0) * grain
    cells = np.floor((points - corner) / grain).astype(np.int64)
    shape = cells.max(axis=0) + int(FAR) + 2
    key, member, count = np.unique(
        np.ravel_multi_index(tuple(cells.T), tuple(shape)), return_inverse=True, return_counts=True
    )
    centre = np.stack([np.bincount(member, points[:, k]) for k in range(3)], axis=1) / count[:, None]
    normal = unit(np.stack([np.bincount(member, normals[:, k]) for k in range(3)], axis=1))
    empty = np.ones(shape, dtype=bool)
    empty.ravel()[key] = False
    number = np.full(shape, -1)
    number.ravel()[key] = np.arange(len(key))
    distance, where = distance_transform_edt(empty, return_indices=True)
    nearest = np.where(distance <= FAR, number[tuple(where)], -1)
    return Cloud(centre, normal, grain, corner, nearest)


def _sample(vertices: Points, faces: Faces) -> tuple[Points, Points]:
    """Return points spread evenly over the faces, shape (k, 3), and their normals; the same each time."""
    areas = area_vectors(vertices, faces)
    total = np.cumsum(np.linalg.norm(areas, axis=1))
    number = np.arange(SAMPLES)
    face = np.searchsorted(total, (number + 0.5) / SAMPLES * total[-1])
    u, v = (0.7549 * number) % 1.0, (0.5698 * number) % 1.0  # an even sequence in the unit square
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u), np.where(over, 1.0 - v, v)
    a, b, c = (vertices[faces[face, k]] for k in range(3))
    return a + u[:, None] * (b - a) + v[:, None] * (c - a), unit(areas[face])


def mirror_planes(cloud: Cloud, up: int) -> list[MirrorPlane]:
    """Return the two best mirror planes of ``cloud`` along the file axis ``up`` (0, 1 or 2), best first."""
    probes = cloud.points[:: max(1, len(cloud.points) // 700)]
    yaws = np.radians(np.arange(0.0, 180.0, 6.0))
    sides = _side(up, yaws)
    reach = cloud.points @ sides.T
    ends = np.percentile(reach, (2, 98), axis=0).mean(axis=0)
    middle = reach.mean(axis=0)
    offsets = np.stack([ends, middle, 0.5 * (ends + middle)])
    trials = _residual(cloud, probes, np.tile(sides, (3, 1)), offsets.ravel()).reshape(3, -1)
    offset = offsets[np.argmin(trials, axis=0), np.arange(len(yaws))]
    residual = trials.min(axis=0)
    best = int(np.argmin(residual))
    apart = np.abs((yaws - yaws[best] + np.pi / 2) % np.pi - np.pi / 2) > np.radians(20.0)
    second = int(np.argmin(np.where(apart, residual, np.inf)))
    planes = [_refined(cloud, up, float(yaws[k]), float(offset[k])) for k in (best, second)]
    return sorted(planes, key=lambda plane: plane.residual)


def _side(up: int, yaw: Floats | float) -> Floats:
    """Return the unit vector across axis ``up`` at ``yaw`` [rad] from the axis after it, shape (..., 3)."""
    side = np.zeros((*np.shape(yaw), 3))
    side[..., (up + 1) % 3] = np.cos(yaw)
    side[..., (up + 2) % 3] = np.sin(yaw)
    return side


def _residual(cloud: Cloud, probes: Points, sides: Floats, offsets: Floats) -> Floats:
    """Return how far mirrored probes lie off the cloud, 0 .. 1, for q planes of shape (q, 3) and (q,)."""
    height = probes @ sides.T - offsets
    mirrored = probes[:, None] - 2.0 * height[..., None] * sides
    partner = cloud.partner(mirrored)
    distance = np.linalg.norm(mirrored - cloud.points[partner], axis=-1) / cloud.grain
    return np.asarray(np.where(partner < 0, 1.0, np.minimum(distance / FAR, 1.0)).mean(axis=0))


def _refined(cloud: Cloud, up: int, yaw: float, offset: float) -> MirrorPlane:
    """Turn and shift a plane until the mirrored skin lies on the skin (robust Gauss-Newton steps)."""
    probes = cloud.points[:: max(1, len(cloud.points) // 3000)]
    for scale in np.geomspace(3.0, 0.5, 12) * cloud.grain:
        side, along = _side(up, yaw), _side(up, yaw + np.pi / 2)
        height = probes @ side - offset
        mirrored = probes - 2.0 * height[:, None] * side
        partner = cloud.partner(mirrored)
        normal = np.where(partner[:, None] < 0, 0.0, cloud.normals[partner])
        miss = np.einsum("ij,ij->i", normal, mirrored - cloud.points[partner])
        by_yaw = -2.0 * ((probes @ along) * (normal @ side) + height * (normal @ along))
        by_offset = 2.0 * (normal @ side)
        weight = 1.0 / (1.0 + (miss / scale) ** 2)
        slope = np.stack([by_yaw, by_offset], axis=1) * weight[:, None]
        step = np.linalg.lstsq(slope, -miss * weight, rcond=None)[0]
        yaw += float(np.clip(step[0], -0.1, 0.1))
        offset += float(np.clip(step[1], -3.0 * cloud.grain, 3.0 * cloud.grain))
    side = _side(up, yaw)
    return MirrorPlane(up, side, offset, float(_residual(cloud, probes, side[None], np.array([offset]))[0]))
