"""Underwires: points of the skin held to a rigid curve that moves and turns as a whole, by any angle.

Source: best rigid motion between two sets of points, Kabsch (1976).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from core.geometry.mesh import Floats, Indices, Points

WIRE_N_MM = 10.0
"""How hard a wire holds a point to its form [N/mm]: some hundred times harder than tissue does."""


@dataclass(frozen=True, eq=False)
class Wire:
    """Wires of both cups, each ``width`` [1] times as wide as the root of its breast.

    ``points`` (w,) are those of the halved control mesh that they follow, ``side`` (w,) is 1 for the left and
    -1 for the right, ``shape`` (w, 3) [mm] is where its own form has a point, less where it lies on the scan.
    """

    width: float
    points: Indices
    side: Indices
    shape: Points
    hardness: float = WIRE_N_MM


@dataclass(frozen=True, eq=False)
class Underwire:
    """One wire, worn: an energy of the nodes (n, 3) [mm], with exact derivatives.

    ``rest`` (w, 3) [mm] are its points on the scan, of which ``follow`` (w, n) gives the means of the nodes'
    displacements from ``nodes``, ``shape`` (w, 3) [mm] is its own form less ``rest``, and ``hardness``
    [N/mm] holds each point to that form, which lies where it is nearest to all of them.
    """

    rest: Points
    nodes: Points
    follow: sparse.csr_array
    shape: Points
    hardness: float

    def points(self, nodes: Points) -> Points:
        """Return the points for nodes (n, 3) [mm], shape (w, 3) [mm]."""
        return np.asarray(self.rest + self.follow @ (nodes - self.nodes))

    def _lying(self, nodes: Points, load: float) -> tuple[Points, Points]:
        """Return the points, and the form where it lies, both (w, 3) [mm] from their common middle."""
        points, form = self.points(nodes), self.rest + load * self.shape
        points, form = points - points.mean(axis=0), form - form.mean(axis=0)
        u, _, v = np.linalg.svd(form.T @ points)
        turn = u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v
        return points, form @ turn

    def off(self, nodes: Points, load: float = 1.0) -> Points:
        """Return how far the points are from the form, with the share ``load`` of it [1], (w, 3) [mm]."""
        points, form = self._lying(nodes, load)
        return points - form

    def energy(self, nodes: Points, load: float = 1.0) -> float:
        """Return the stored energy [N mm]."""
        return 0.5 * self.hardness * float((self.off(nodes, load) ** 2).sum())

    def forces(self, nodes: Points, load: float) -> Floats:
        """Return the derivatives of the energy by the nodes, (3 n,) [N]: the form lies where it is least."""
        return np.asarray((self.follow.T @ (self.hardness * self.off(nodes, load))).ravel())

    def stiffness(self, nodes: Points, load: float) -> sparse.csr_array:
        """Return the second derivatives of the energy by the nodes, (3 n, 3 n) [N/mm]."""
        points, form = self._lying(nodes, load)
        turned = np.stack([np.cross(axis, form).ravel() for axis in np.eye(3)], axis=1)
        both = points.T @ form
        against = np.trace(both) * np.eye(3) - both  # a turn of the form against its points
        middle = np.kron(np.eye(len(points)) - 1.0 / len(points), np.eye(3))
        held = self.hardness * (middle - turned @ np.linalg.solve(against, turned.T))
        ends = sparse.kron(self.follow, sparse.eye_array(3), format="csr")
        return sparse.csr_array(ends.T @ sparse.csr_array(held) @ ends)
