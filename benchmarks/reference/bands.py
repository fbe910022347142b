"""Lines worn on the skin: tension-only pieces between points that are glued to discs of skin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from core.geometry.mesh import Flags, Floats, Indices, Points


@dataclass(frozen=True, eq=False)
class Bands:
    """Pieces of elastic between points that follow the skin.

    ``rest`` (k, 3) [mm] are the points on the scan, of which ``follow`` (k, n) gives the means of the nodes'
    displacements (an empty row: held in space), ``pieces`` (m, 2) their ends, ``ratio`` (m,) the natural
    lengths in parts of those on the scan, ``stiffness_n`` (m,) the forces per unit of strain [N].
    """

    rest: Points
    nodes: Points
    follow: sparse.csr_array
    pieces: Indices
    ratio: Floats
    stiffness_n: Floats

    def points(self, nodes: Points) -> Points:
        """Return the points for nodes (n, 3) [mm], shape (k, 3) [mm]."""
        return np.asarray(self.rest + self.follow @ (nodes - self.nodes))

    def lengths(self, nodes: Points) -> Floats:
        """Return the lengths of the pieces, shape (m,) [mm]."""
        return np.asarray(np.linalg.norm(_along(self.points(nodes), self.pieces), axis=1))

    def tension(self, nodes: Points, load: float = 1.0) -> Floats:
        """Return the tension of each piece, (m,) [N], with the share ``load`` of the shortening [1]."""
        natural = (1.0 + load * (self.ratio - 1.0)) * self.lengths(self.nodes)
        return self.stiffness_n * np.maximum(self.lengths(nodes) / natural - 1.0, 0.0)

    def energy(self, nodes: Points, load: float = 1.0) -> float:
        """Return the stored energy [N mm]."""
        natural = (1.0 + load * (self.ratio - 1.0)) * self.lengths(self.nodes)
        return float((0.5 / self.stiffness_n * natural * self.tension(nodes, load) ** 2).sum())

    def forces(self, nodes: Points, load: float) -> Floats:
        """Return the derivatives of the energy by the nodes, (3 n,) [N]."""
        along = _along(self.points(nodes), self.pieces)
        pull = (self.tension(nodes, load) / self.lengths(nodes))[:, None] * along
        at_points = np.zeros_like(self.rest)
        np.add.at(at_points, self.pieces[:, 1], pull)
        np.add.at(at_points, self.pieces[:, 0], -pull)
        return np.asarray((self.follow.T @ at_points).ravel())

    def stiffness(self, nodes: Points, load: float) -> sparse.csr_array:
        """Return the second derivatives of the energy by the nodes, (3 n, 3 n) [N/mm]."""
        length, tension = self.lengths(nodes), self.tension(nodes, load)
        natural = (1.0 + load * (self.ratio - 1.0)) * self.lengths(self.nodes)
        along = _along(self.points(nodes), self.pieces) / length[:, None]
        across = np.eye(3) - along[:, :, None] * along[:, None, :]
        stretched = np.where(tension > 0.0, self.stiffness_n / natural, 0.0)[:, None, None]
        blocks = stretched * (np.eye(3) - across) + (tension / length)[:, None, None] * across
        count = len(self.pieces)
        starts = np.arange(count + 1)
        whole = sparse.bsr_array((blocks, np.arange(count), starts), shape=(3 * count, 3 * count))
        ends = sparse.kron(self._differences() @ self.follow, sparse.eye_array(3), format="csr")
        return sparse.csr_array(ends.T @ whole.tocsr() @ ends)

    def _differences(self) -> sparse.csr_array:
        """Return the matrix that takes the first end of each piece from the second, (m, k)."""
        count = len(self.pieces)
        rows = np.repeat(np.arange(count), 2)
        return sparse.csr_array(
            (np.tile([-1.0, 1.0], count), (rows, self.pieces.ravel())), shape=(count, len(self.rest))
        )


def _along(points: Points, pieces: Indices) -> Points:
    return np.asarray(points[pieces[:, 1]] - points[pieces[:, 0]])


def cut(line: Points, held: Flags, count: int) -> tuple[Points, Flags]:
    """Return ``line`` (k, 3) with each segment cut into ``count``, and which of its points are held.

    Segments between two held points are left out: nothing there can move (they are cut off at the ends).
    """
    first, last = _worn_part(held)
    line, held = line[first : last + 1], held[first : last + 1]
    share = np.arange(count * (len(line) - 1) + 1) / count
    return (
        np.stack([np.interp(share, np.arange(len(line)), axis) for axis in line.T], axis=1),
        np.isin(share, np.flatnonzero(held)),
    )


def _worn_part(held: Flags) -> tuple[int, int]:
    """Return the first and the last point of a line beyond which only held points follow."""
    free = np.flatnonzero(~held)
    if not len(free):
        raise ValueError("no point of the line can move")
    return max(int(free[0]) - 1, 0), min(int(free[-1]) + 1, len(held) - 1)
