"""Co-rotated cells: each point with its neighbours resists a change of shape, but turns freely (ours).

The cell of a point is all edges that meet there. Its energy is half the force densities times the squared
difference to the shape at rest, turned by the rotation that fits best; an edge belongs half to each end.
Rotations are refreshed with every look at the shape, so force and stiffness below are exact derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Floats, Indices, Points
from core.mechanics.banded_matrix import Entries


@dataclass(frozen=True, eq=False)
class Cells:
    """The cells of a model, padded to the same number k of neighbours.

    ``centre`` (c,) and ``around`` (c, k) are points; ``weight`` (c, k) [1] half the force densities, 0 for
    padding; ``rest_spans`` (c, k, 3) [mm] from the neighbour to the centre; ``place`` (n,) the row of each
    point among the ``count`` free ones.
    """

    centre: Indices
    around: Indices
    weight: Floats
    rest_spans: Points
    place: Indices
    count: int

    def spans(self, points: Points) -> Points:
        """Return the vectors from the neighbours to the centres, shape (c, k, 3) [mm]."""
        return np.asarray(points[self.centre][:, None] - points[self.around])

    def rotations(self, spans: Points) -> Points:
        """Return the rotation of each cell that fits best, shape (c, 3, 3)."""
        left, _, right = np.linalg.svd(self._correlation(spans))
        flipped = np.linalg.det(left @ right) < 0.0
        left[flipped, :, 2] *= -1.0
        return np.asarray(left @ right)

    def energy(self, spans: Points, rotations: Points) -> float:
        """Return the energy of all cells."""
        away = spans - self._aims(rotations)
        return 0.5 * float(np.einsum("ck,cki,cki->", self.weight, away, away))

    def gradient(self, spans: Points, rotations: Points) -> Points:
        """Return the derivative of the energy at the free points, shape (f, 3)."""
        force = self.weight[:, :, None] * (spans - self._aims(rotations))
        total = np.zeros((len(self.place), 3))
        np.add.at(total, self.centre, force.sum(axis=1))
        np.subtract.at(total, self.around.ravel(), force.reshape(-1, 3))
        return np.asarray(total[self.place >= 0])

    def rotation_blocks(self, spans: Points, rotations: Points) -> Floats:
        """Return what free turning takes off the stiffness: a block per cell, shape (c, 3 k + 3, 3 k + 3).

        With S = R Y the correlation and b = sum w E x R^T de, a change de costs b . (tr Y - Y)^-1 b less.
        """
        stretch = np.swapaxes(rotations, 1, 2) @ self._correlation(spans)
        stiff = np.trace(stretch, axis1=1, axis2=2)[:, None, None] * np.eye(3) - stretch
        arms = self.weight[:, :, None, None] * _skew(self.rest_spans)
        turned = arms @ np.swapaxes(rotations, 1, 2)[:, None]
        rows = np.concatenate([turned.sum(axis=1)[:, None], -turned], axis=1)
        flat = np.swapaxes(rows, 1, 2).reshape(len(self.centre), 3, -1)
        return np.asarray(np.swapaxes(flat, 1, 2) @ np.linalg.solve(stiff, flat))

    def entries(self) -> Entries:
        """Return where the blocks of ``rotation_blocks`` lie, with the sign that takes them off."""
        members = self.place[np.column_stack([self.centre, self.around])]
        members[:, 1:][self.weight == 0.0] = -1
        coordinate = (3 * members[:, :, None] + np.arange(3)).reshape(len(members), -1)
        coordinate[np.repeat(members < 0, 3, axis=1)] = -1
        wide = coordinate.shape[1]
        row = np.repeat(coordinate, wide, axis=1).ravel()
        column = np.tile(coordinate, (1, wide)).ravel()
        kept = np.flatnonzero((row >= 0) & (column >= 0))
        return Entries(row[kept], column[kept], kept, np.full(len(kept), -1.0), row.size)

    def _aims(self, rotations: Points) -> Points:
        return np.asarray(self.rest_spans @ np.swapaxes(rotations, 1, 2))

    def _correlation(self, spans: Points) -> Points:
        return np.asarray(np.einsum("ck,cki,ckj->cij", self.weight, spans, self.rest_spans))


def _skew(vectors: Points) -> Points:
    """Return the matrices that multiply by the cross product from the left, shape (..., 3, 3)."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = np.zeros_like(x)
    rows = [np.stack(row, axis=-1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))]
    return np.stack(rows, axis=-2)


def cells(rest: Points, edges: Indices, density: Floats, place: Indices) -> Cells:
    """Build the cells of all points that have a moving edge; ``edges`` (e, 2) are all edges of the mesh."""
    moves = (place[edges] >= 0).any(axis=1)
    centre = np.unique(edges[moves])
    start = np.concatenate([edges[:, 0], edges[:, 1]])
    end = np.concatenate([edges[:, 1], edges[:, 0]])
    weight = np.concatenate([density, density]) / 2.0
    kept = np.isin(start, centre)
    order = np.argsort(start[kept], kind="stable")
    start, end, weight = start[kept][order], end[kept][order], weight[kept][order]
    row = np.searchsorted(centre, start)
    slot = np.arange(len(start)) - np.searchsorted(start, start)
    shape = (len(centre), int(slot.max(initial=-1)) + 1)
    around = np.repeat(centre[:, None], shape[1], axis=1)
    weights = np.zeros(shape)
    around[row, slot], weights[row, slot] = end, weight
    spans = rest[centre][:, None] - rest[around]
    return Cells(centre, around, weights, spans, place, int((place >= 0).sum()))
