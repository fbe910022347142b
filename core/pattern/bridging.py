"""Cloth over hollows: where the skin is hollow, a taut cloth leaves it, as between the breasts (ours).

The cloth is a membrane that may leave the skin outward and not enter it: least squares of the slopes of its
places, with one distance from the skin at each, none below 0. Garments pull more across than down.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from core.geometry.mesh import Faces, Flags, Floats, Points, boundary_loops, unit

TENSION = (10.0, 1.0)
"""The tension of a cloth across the body and down [1]; ours."""

_ROUNDS = 60  # of finding out where the cloth lies on the skin; most hollows take ten
_SMOOTHED = 12  # passes that smooth the directions in which the cloth may leave the skin


def bridged(places: Points, faces: Faces, normals: Points, bridges: Flags | None = None) -> Points:
    """Return the ``places`` (n, 3) [mm] of a cloth on the skin, moved outward where it is taut over hollows.

    ``normals`` (n, 3) of the skin point outward. Only places that ``bridges`` (n,) may leave the skin, all of
    them if it is None.
    """
    weights = _stiffness(places, faces)
    ways = _smoothed(normals, faces)
    stiff = _along(weights, ways)
    force = np.einsum("nx,nx->n", ways, _without_edges(weights @ places, places, faces, normals))
    may = np.ones(len(places), dtype=bool) if bridges is None else bridges
    return places + _lifted(stiff, force, may)[:, None] * ways


def _lifted(stiff: sparse.csr_array, force: Floats, may: Flags) -> Floats:
    """Return the least distances u >= 0 of u.A.u / 2 + b.u, 0 where it ``may`` not leave the skin.

    By the primal-dual active set method (M. Hintermüller, K. Ito, K. Kunisch, SIAM J. Optim. 13, 2002).
    """
    lifted, off = np.zeros(len(force)), may & (force < 0.0)
    for _ in range(_ROUNDS):
        lifted[:] = 0.0
        free = np.flatnonzero(off)
        if len(free):
            lifted[free] = splu(stiff[free][:, free].tocsc()).solve(-force[free])
        contact = stiff @ lifted + force
        before, off = off, may & np.where(off, lifted > 0.0, contact < 0.0)
        if (before == off).all():
            break
    return np.maximum(lifted, 0.0)


def _stiffness(places: Points, faces: Faces) -> sparse.csr_array:
    """Return the stiffness of a membrane under ``TENSION``, positive semidefinite, (n, n) [1]."""
    corners = places[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    double = np.maximum(np.linalg.norm(normal, axis=1), 1e-12)
    normal /= double[:, None]
    across = unit(np.cross([0.0, 0.0, 1.0], normal) + 1e-12)
    slopes = np.cross(normal[:, None], np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1))
    slopes /= double[:, None, None]
    along, down = (np.einsum("mcx,mx->mc", slopes, way) for way in (across, np.cross(normal, across)))
    parts = (
        pull * np.einsum("mi,mj->mij", way, way) for pull, way in zip(TENSION, (along, down), strict=True)
    )
    values = 0.5 * double[:, None, None] * sum(parts)
    row, column = np.repeat(faces, 3, axis=1), np.tile(faces, 3)
    return sparse.csr_array((values.ravel(), (row.ravel(), column.ravel())), shape=(len(places),) * 2)


def _without_edges(force: Points, places: Points, faces: Faces, normals: Points) -> Points:
    """Return the forces of a membrane, (n, 3), without the pull of the cloth on its own edges.

    An edge is held by what it is sewn to: without that the cloth would draw back from it, and off the skin.
    """
    force = force.copy()
    for loop in boundary_loops(faces):
        along = places[np.roll(loop, -1)] - places[np.roll(loop, 1)]
        aside = unit(np.cross(along, normals[loop]))
        force[loop] -= np.einsum("nx,nx->n", force[loop], aside)[:, None] * aside
    return force


def _along(weights: sparse.csr_array, ways: Points) -> sparse.csr_array:
    """Return the stiffness against distances along ``ways`` (n, 3), (n, n)."""
    entries = weights.tocoo()
    row, column = entries.coords
    turned = entries.data * np.einsum("ex,ex->e", ways[row], ways[column])
    return sparse.csr_array((turned, (row, column)), shape=weights.shape)


def _smoothed(normals: Points, faces: Faces) -> Points:
    """Return directions that change slowly from place to place, (n, 3) [1]."""
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ones = np.ones(len(ends))
    near = sparse.csr_array((ones, (ends[:, 0], ends[:, 1])), shape=(len(normals),) * 2)
    near = sparse.csr_array(near + near.T + sparse.eye_array(len(normals)))
    ways = normals
    for _ in range(_SMOOTHED):
        ways = unit(np.asarray(near @ ways))
    return ways
