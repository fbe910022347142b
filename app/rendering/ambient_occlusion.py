"""Ambient occlusion of the body: folds are darker."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy import sparse

from core.geometry.mesh import Floats, Mesh, Points, unit
from core.progress import Progress, quiet

Singles = npt.NDArray[np.float32]


def bake_occlusion(mesh: Mesh, directions: int = 32, cell: float = 7.0, progress: Progress = quiet) -> Floats:
    """Return how open the sky above each vertex is, shape (n,) [1]: 1 free, small in folds.

    Each direction keeps the surface nearest to the sky on a grid of ``cell`` [mm]; a vertex loses its sky
    between 5 and 17 mm under it. Runs in any thread; raises Cancelled.
    """
    sky = _sphere(directions)
    samples = _samples(mesh, cell).astype(np.float32)
    normals = mesh.vertex_normals
    count = len(mesh.vertices)
    seen, possible = np.zeros(count), np.full(count, 1e-6)
    for number, towards in enumerate(sky):
        progress("soft shadows", number / directions)
        facing = normals @ towards
        depth = samples @ towards.astype(np.float32)
        under = _shaded(samples, depth, towards, cell)[:count] - depth[:count]
        weight = np.maximum(facing, 0.0)
        possible += weight
        seen += weight * np.clip((17.0 - under) / 12.0, 0.0, 1.0)
    return _smoothed(seen / possible, mesh, passes=14)


def _sphere(count: int) -> Points:
    """Return ``count`` even directions."""
    turn = np.arange(count) * np.pi * (3.0 - np.sqrt(5.0))
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    radius = np.sqrt(1.0 - z**2)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)


def _samples(mesh: Mesh, cell: float) -> Points:
    """Return the vertices, then the face centres and, on faces too large for the grid, more points."""
    corners = mesh.vertices[mesh.faces]
    points = [mesh.vertices, corners.mean(axis=1)]
    large = corners[mesh.face_areas > cell**2]
    if len(large):
        steps = np.arange(1, 8) / 8.0
        u, v = (grid.ravel() for grid in np.meshgrid(steps, steps))
        u, v = u[u + v < 1.0], v[u + v < 1.0]
        mix = np.stack([1.0 - u - v, u, v], axis=1)
        points.append(np.einsum("sk,mkj->msj", mix, large).reshape(-1, 3))
    return np.concatenate(points)


def _shaded(samples: Singles, depth: Singles, towards: Floats, cell: float) -> Singles:
    """Return for each sample the depth of the surface nearest to the sky in its grid cell."""
    helper = np.eye(3)[np.argmin(np.abs(towards))]
    across = unit(np.cross(towards, helper)[None])[0]
    plane = np.stack([across, np.cross(towards, across)], axis=1).astype(np.float32)
    grid = ((samples @ plane) / np.float32(cell)).astype(np.int32)
    grid -= grid.min(axis=0)
    place = grid[:, 0] * (grid[:, 1].max() + 1) + grid[:, 1]
    nearest = np.full(int(place.max()) + 1, -np.inf, dtype=np.float32)
    np.maximum.at(nearest, place, depth)
    return np.asarray(nearest[place])


def _smoothed(values: Floats, mesh: Mesh, passes: int) -> Floats:
    a, b = mesh.edges.T
    count = len(mesh.vertices)
    links = sparse.csr_array((np.ones(2 * len(a)), (np.r_[a, b], np.r_[b, a])), shape=(count, count))
    degree = np.maximum(links.sum(axis=1), 1.0)
    for _ in range(passes):
        values = 0.5 * values + 0.5 * (links @ values) / degree
    return np.asarray(values)
