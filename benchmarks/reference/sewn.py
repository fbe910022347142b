"""Cloth of sewn cups: strips between neighbours of the halved control mesh, across and upright."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from core.geometry.mesh import Flags, Floats, Indices, Mesh


@dataclass(frozen=True, eq=False)
class Cloth:
    """Cloth of both cups, as long ``across`` and ``upright`` as on the scan times these ratios [1].

    ``strips`` (s, 2) are pairs of points of the halved control mesh, ``level`` (s,) tells which go across;
    ``cloth_n_m`` [N/m] is the force per width and unit of strain, both ways.
    """

    across: float
    upright: float
    cloth_n_m: float
    strips: Indices
    level: Flags

    @property
    def ratio(self) -> Floats:
        """Return the natural length of each strip in parts of that on the scan, (s,) [1]."""
        return np.where(self.level, self.across, self.upright)

    def stiffness_n(self, mesh: Mesh) -> Floats:
        """Return the force of each strip per unit of strain, (s,) [N], on the halved control ``mesh``.

        A strip reaches halfway to its neighbours: it is as wide as both triangles at it, over its length.
        """
        sides = np.sort(np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2), axis=2)
        keys = sides.reshape(-1, 2) @ [len(mesh.vertices), 1]
        areas = np.bincount(keys, np.repeat(mesh.face_areas, 3), len(mesh.vertices) ** 2)
        beside = areas[np.sort(self.strips, axis=1) @ [len(mesh.vertices), 1]]
        ends = mesh.vertices[self.strips]
        return np.asarray(1e-3 * self.cloth_n_m * beside / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))


def strips_of(edges: Indices, row: Floats, column: Floats, side: Indices) -> tuple[Indices, Flags]:
    """Return the ``edges`` (e, 2) along a row or a column between points of one ``side`` (n,) that is not 0.

    Also returns which of them go along a row, (s,).
    """
    one, other = edges.T
    level, steep = row[one] == row[other], column[one] == column[other]
    own = (side[one] == side[other]) & (side[one] != 0) & (level | steep)
    return edges[own], level[own]


def hanging(off: Flags, strips: Indices) -> sparse.csr_array:
    """Return the matrix (n, n) that puts points ``off`` (n,) the skin amid those on it that strips lead to.

    It is the balance of cloth that pulls alike on all sides.
    """
    near = np.zeros((len(off), len(off)))
    near[strips[:, 0], strips[:, 1]] = near[strips[:, 1], strips[:, 0]] = 1.0
    near[:, off] = 0.0
    hung = off & near.any(axis=1)
    near[hung] /= near[hung].sum(axis=1, keepdims=True)
    return sparse.csr_array(np.where(hung[:, None], near, np.eye(len(off))))
