"""Chest wall under a skin patch, which no scan shows: a film held under the skin that does not move."""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

from core.geometry.mesh import Indices, Mesh, Points
from core.tissue.skin_patch import SkinPatch

DEPTH = 12.0
"""Depth of the chest wall under skin that does not move [mm]: assumed."""

_ROUNDS = 30
_STILL = 0.05
"""The film is at rest when no place moves further than this [mm] in a round."""


def wall_film(patch: SkinPatch, depth: float = DEPTH) -> Points:
    """Return a place on the chest wall for each vertex of a skin patch, shape (n, 3) [mm].

    Under the rim, and where the skin lies over fixed control points alone, it is ``depth`` [mm] inward;
    between them lies the surface of least area. Source: Pinkall and Polthier 1993.
    """
    skin = patch.mesh
    held = np.union1d(patch.rim, np.flatnonzero(patch.over_fixed))
    inner = np.setdiff1d(np.arange(len(skin.vertices)), held)
    wall = np.array(skin.vertices)
    wall[held] -= depth * skin.vertex_normals[held]
    if not len(inner):
        return wall
    for _ in range(_ROUNDS):
        before = wall[inner]
        wall[inner] = _relaxed(skin.moved(wall), inner, held)
        if np.abs(wall[inner] - before).max() < _STILL:
            break
    return wall


def _relaxed(film: Mesh, inner: Indices, held: Indices) -> Points:
    """Return where ``inner`` vertices rest on springs with the cotangent weights of ``film``, (k, 3) [mm]."""
    laplacian = cotangent_laplacian(film)[inner]
    return np.asarray(spsolve(laplacian[:, inner].tocsc(), -(laplacian[:, held] @ film.vertices[held])))


def cotangent_laplacian(mesh: Mesh) -> sparse.csr_array:
    """Return the Laplacian with cotangent weights, each between 0.01 and 25, shape (n, n) [1]."""
    rows, columns, weights = [], [], []
    for corner in range(3):
        a, b, c = (mesh.faces[:, (corner + step) % 3] for step in range(3))
        one, other = mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]
        across = np.maximum(np.linalg.norm(np.cross(one, other), axis=1), 1e-12)
        weight = np.clip(0.5 * np.einsum("ij,ij->i", one, other) / across, 0.01, 25.0)
        rows += [b, c]
        columns += [c, b]
        weights += [weight, weight]
    where = (np.concatenate(rows), np.concatenate(columns))
    count = len(mesh.vertices)
    joined = sparse.csr_array(sparse.coo_array((np.concatenate(weights), where), shape=(count, count)))
    return sparse.csr_array(sparse.diags_array(joined.sum(axis=1)) - joined)
