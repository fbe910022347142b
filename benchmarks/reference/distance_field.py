"""Signed distance from a surface as a smooth function: cubic splines through its values on a grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from core.geometry.mesh import Floats, Mesh, Points
from reference.skin import barycentric, closest

SPACING = 5.0
"""Distance of the grid's nodes [mm]: edges between triangles are rounded over about as much."""

BAND = 20.0
"""The distance is exact at nodes so near to where it is needed [mm]."""


@dataclass(frozen=True, eq=False)
class DistanceField:
    """Tricubic splines: ``origin`` (3,) [mm] is the first node, ``coefficients`` (a, b, c) [mm] theirs."""

    origin: Points
    coefficients: Floats

    def at(self, places: Points) -> tuple[Floats, Points, Floats]:
        """Return the distance (k,) [mm] at places (k, 3) [mm], its first and its second derivatives."""
        cell = (places - self.origin) / SPACING
        first = np.clip(np.floor(cell).astype(int) - 1, 0, np.array(self.coefficients.shape) - 4)
        weights = np.stack(_basis(cell - first - 1.0))  # order of derivative, place, axis, node
        index = first[:, :, None] + np.arange(4)
        near = self.coefficients[
            index[:, 0, :, None, None], index[:, 1, None, :, None], index[:, 2, None, None, :]
        ]

        def derivative(x: int, y: int, z: int) -> Floats:
            parts = weights[x, :, 0], weights[y, :, 1], weights[z, :, 2]
            total = np.einsum("kabc,ka,kb,kc->k", near, *parts, optimize=True)
            return np.asarray(total / SPACING ** (x + y + z))

        unit = np.eye(3, dtype=int)
        slope = np.stack([derivative(*one) for one in unit], axis=1)
        bend = np.stack([[derivative(*(one + other)) for other in unit] for one in unit])
        return derivative(0, 0, 0), slope, bend.transpose(2, 0, 1)


def distance_field(surface: Mesh, needed: Points) -> DistanceField:
    """Return the distance of places from ``surface``, positive outside, for places near ``needed`` (k, 3)."""
    low, high = needed.min(axis=0) - BAND - 3.0 * SPACING, needed.max(axis=0) + BAND + 3.0 * SPACING
    shape = np.ceil((high - low) / SPACING).astype(int) + 1
    nodes = low + SPACING * np.stack(np.indices(tuple(shape.tolist())), axis=-1).reshape(-1, 3)
    # Far away a plane is near enough: it only keeps the splines from swinging.
    at = cKDTree(surface.vertices).query(nodes)[1]
    values = np.einsum("kx,kx->k", nodes - surface.vertices[at], surface.vertex_normals[at])
    near = cKDTree(needed).query(nodes, distance_upper_bound=BAND)[0] < BAND
    values[near] = signed_distance(surface, nodes[near])
    return DistanceField(low, ndimage.spline_filter(values.reshape(shape), order=3, mode="mirror"))


def signed_distance(surface: Mesh, places: Points) -> Floats:
    """Return the distance of places (k, 3) from the nearest place of ``surface``, (k,) [mm]."""
    face, foot = closest(surface, places)
    corners = surface.faces[face]
    shares = barycentric(surface.vertices[corners], foot)
    normal = np.einsum("kc,kcx->kx", shares, surface.vertex_normals[corners])
    away = places - foot
    return np.asarray(np.copysign(np.linalg.norm(away, axis=1), np.einsum("kx,kx->k", away, normal)))


def _basis(t: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the four cubic B-splines at ``t`` (...) between two nodes [1], (..., 4), and two derivatives."""
    u = 1.0 - t
    value = u**3, 3.0 * t**3 - 6.0 * t**2 + 4.0, 3.0 * u**3 - 6.0 * u**2 + 4.0, t**3
    slope = -3.0 * u**2, 9.0 * t**2 - 12.0 * t, -9.0 * u**2 + 12.0 * u, 3.0 * t**2
    bend = 6.0 * u, 18.0 * t - 12.0, 18.0 * u - 12.0, 6.0 * t
    first, second, third = (np.stack(each, axis=-1) / 6.0 for each in (value, slope, bend))
    return first, second, third
