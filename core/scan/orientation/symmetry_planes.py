"""Mirror planes of a body: even points on its skin, and the planes that map them onto themselves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import distance_transform_edt

from core.geometry.mesh import Faces, Flags, Floats, Indices, Points, area_vectors, sample_surface, unit

CELLS = 11_000
"""Grain-sized squares that the skin is divided into: the grain is the spacing of everything here."""

FINEST = 180.0
"""Grains along the diagonal of the body, at most: a skin almost without area must not become a fine grid."""

SAMPLES = 30_000
"""Points laid on the skin before they are averaged, one a grain-sized cell."""

FAR = 6.0
"""A mirrored point this many grains off the skin [1] counts as having no partner."""

DIRECTIONS = 500
"""Normals of planes that are tried, evenly over half a sphere: one in six degrees."""

APART = np.cos(np.radians(15.0))
"""Planes whose normals differ by less than this are one [cosine]."""


@dataclass(frozen=True, eq=False)
class Cloud:
    """Even points on a skin, shape (k, 3) [file units], with unit normals, one a cell of size ``grain``.

    ``nearest`` holds for each cell of the box around them the index of the nearest point, -1 if far off, and
    ``gap`` how far off it lies, 0 .. 1; cell (0, 0, 0) starts at ``corner``.
    """

    points: Points
    normals: Points
    grain: float
    corner: Floats
    nearest: Indices
    gap: Floats

    def partner(self, places: Points) -> Indices:
        """Return the index of the point nearest to each place, shape (..., 3), or -1 if far off."""
        inside, cell = self._cell(places)
        return np.where(inside, self.nearest.ravel()[cell], -1)

    def miss(self, places: Points) -> Floats:
        """Return how far each place, shape (..., 3), lies off the skin, in cells: 0 on it, 1 if far off."""
        inside, cell = self._cell(places)
        return np.where(inside, self.gap.ravel()[cell], 1.0)

    def _cell(self, places: Points) -> tuple[Flags, Indices]:
        cell = np.floor((places - self.corner) / self.grain).astype(np.int64)
        inside = np.all((cell >= 0) & (cell < self.nearest.shape), axis=-1)
        _, wide, deep = self.nearest.shape
        number = (cell[..., 0] * wide + cell[..., 1]) * deep + cell[..., 2]
        return inside, np.where(inside, number, 0)


@dataclass(frozen=True, eq=False)
class MirrorPlane:
    """The plane {p: p . side = offset}.

    ``side`` is a unit vector, shape (3,); ``offset`` in file units; ``residual`` is 0 for a perfect mirror.
    """

    side: Floats
    offset: float
    residual: float


def sample_uniformly(vertices: Points, faces: Faces) -> Cloud:
    """Sample even points on a skin, independent of its triangles. Any unit. Source: ours."""
    vectors = area_vectors(vertices, faces)
    areas = np.linalg.norm(vectors, axis=1)
    points, face = sample_surface(vertices, faces, areas, SAMPLES)
    normals, area = unit(vectors[face]), float(areas.sum())
    low, high = np.percentile(points, (1, 99), axis=0)
    grain = max(np.sqrt(area / CELLS), float(np.linalg.norm(high - low)) / FINEST)
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
    return Cloud(centre, normal, float(grain), corner, nearest, np.minimum(distance / FAR, 1.0))


def mirror_planes(cloud: Cloud, across: Floats | None = None, slant: float = 0.0) -> list[MirrorPlane]:
    """Return the best mirror planes of ``cloud``, at most four, best first.

    If ``across`` is given, a unit vector, shape (3,), the plane must hold it up to ``slant`` [1], the sine of
    an angle. Source: ours.
    """
    centre = cloud.points.mean(axis=0)
    sides = half_sphere(DIRECTIONS)
    if across is not None:
        sides = unit(sides - np.outer(sides @ across, across)) if slant == 0.0 else sides
        sides = sides[np.abs(sides @ across) <= slant + 1e-9]
    reach = (cloud.points[::15] - centre) @ sides.T
    ends = np.percentile(reach, (2, 98), axis=0).mean(axis=0)
    offsets = np.stack([ends, 0.5 * (ends + reach.mean(axis=0)), np.median(reach, axis=0)])
    probes = cloud.points[:: max(1, len(cloud.points) // 220)] - centre
    miss = np.stack([_coarse_residual(cloud, probes, centre, sides, each) for each in offsets])
    offset = offsets[np.argmin(miss, axis=0), np.arange(len(sides))]
    residual = miss.min(axis=0)
    chosen: list[int] = []
    for k in np.argsort(residual):
        if all(abs(sides[k] @ sides[other]) < APART for other in chosen):
            chosen.append(int(k))
        if len(chosen) == 5:
            break
    hold = across if slant == 0.0 else None
    rough = [_refined(cloud, centre, sides[k], float(offset[k]), hold, 600, 5) for k in chosen]
    planes: list[MirrorPlane] = []
    for plane in sorted(rough, key=lambda plane: plane.residual):
        if all(abs(plane.side @ other.side) < APART for other in planes) and len(planes) < 4:
            planes.append(plane)
    planes = [
        _refined(cloud, centre, p.side, p.offset - float(p.side @ centre), hold, 2500, 7) for p in planes
    ]
    return sorted(planes, key=lambda plane: plane.residual)


def middle_of(cloud: Cloud, side: Floats) -> float:
    """Return the offset of the mirror plane across ``side``, a unit vector, shape (3,).

    A bad part of one side does not draw it. Source: ours.
    """
    reach = cloud.points @ side
    low, high = np.percentile(reach, (2, 98))
    offsets = np.linspace(low + 0.25 * (high - low), high - 0.25 * (high - low), 81)
    probes, height = cloud.points[::7], reach[::7]
    miss = [cloud.miss(probes - 2.0 * (height - each)[:, None] * side).mean() for each in offsets]
    offset = float(offsets[np.argmin(miss)])
    for scale in np.geomspace(3.0, 0.3, 10) * cloud.grain:
        mirrored = cloud.points - 2.0 * (reach - offset)[:, None] * side
        partner = cloud.partner(mirrored)
        normal = np.where(partner[:, None] < 0, 0.0, cloud.normals[partner])
        off = np.einsum("ij,ij->i", normal, mirrored - cloud.points[partner])
        slope, weight = 2.0 * normal @ side, 1.0 / (1.0 + (off / scale) ** 2) ** 2
        step = -float((weight * slope * off).sum() / max(float((weight * slope**2).sum()), 1e-12))
        offset += float(np.clip(step, -cloud.grain, cloud.grain))
    return offset


def half_sphere(count: int) -> Points:
    """Return ``count`` unit vectors spread evenly over half a sphere, shape (count, 3). Source: Fibonacci."""
    z = (np.arange(count) + 0.5) / count
    turn = np.pi * (1.0 + np.sqrt(5.0)) * np.arange(count)
    return np.stack([np.sqrt(1.0 - z**2) * np.cos(turn), np.sqrt(1.0 - z**2) * np.sin(turn), z], axis=1)


def _coarse_residual(cloud: Cloud, probes: Points, centre: Floats, sides: Floats, offsets: Floats) -> Floats:
    """Return how far mirrored probes lie off the cloud, 0 .. 1, for q planes of shape (q, 3) and (q,)."""
    height = probes @ sides.T - offsets
    return np.asarray(cloud.miss(probes[:, None] - 2.0 * height[..., None] * sides + centre).mean(axis=0))


def _refined(
    cloud: Cloud, centre: Floats, side: Floats, offset: float, hold: Floats | None, count: int, steps: int
) -> MirrorPlane:
    """Turn and shift a plane until the mirrored skin lies on the skin (robust Gauss-Newton steps).

    ``offset`` counts from ``centre``; the plane keeps the direction ``hold`` in it, if there is one.
    """
    probes = cloud.points[:: max(1, len(cloud.points) // count)] - centre
    for scale in np.geomspace(3.0, 0.5, steps) * cloud.grain:
        first = hold if hold is not None else np.eye(3)[np.argmin(np.abs(side))]
        second = unit(np.cross(side, first))
        turns = [second] if hold is not None else [second, np.cross(side, second)]
        height = probes @ side - offset
        mirrored = probes - 2.0 * height[:, None] * side + centre
        partner = cloud.partner(mirrored)
        normal = np.where(partner[:, None] < 0, 0.0, cloud.normals[partner])
        miss = np.einsum("ij,ij->i", normal, mirrored - cloud.points[partner])
        facing = normal @ side
        slopes = [-2.0 * ((probes @ turn) * facing + height * (normal @ turn)) for turn in turns]
        weight = 1.0 / (1.0 + (miss / scale) ** 2)
        slope = np.stack([*slopes, 2.0 * facing], axis=1) * weight[:, None]
        step = np.linalg.lstsq(slope, -miss * weight, rcond=None)[0]
        side = unit(side + np.clip(step[:-1], -0.1, 0.1) @ np.stack(turns))
        offset += float(np.clip(step[-1], -3.0 * cloud.grain, 3.0 * cloud.grain))
    mirrored = probes - 2.0 * (probes @ side - offset)[:, None] * side + centre
    partner = cloud.partner(mirrored)
    distance = np.linalg.norm(mirrored - cloud.points[partner], axis=-1) / (FAR * cloud.grain)
    residual = np.where(partner < 0, 1.0, np.minimum(distance, 1.0)).mean()
    return MirrorPlane(side, offset + float(side @ centre), float(residual))
