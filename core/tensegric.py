"""The tensegric model: cables along the control mesh, balanced at rest by prestressed parts.

The paper (section 2) gives no formula. Ours is the force density law: a cable between points i and j pulls
with ``q_ij * (x_i - x_j)``, and a constant pseudo-force at each point balances all its cables at rest. Moving
that force into the member gives a target vector, so that a member is at ease when ``x_i - x_j`` is what it
was at rest.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.mesh import Flags, Floats, Indices, Mesh, Points, frozen


@dataclass(frozen=True, eq=False)
class TensegricModel:
    """Control points at rest, their cables, and which of them are free to move.

    ``rest`` (n, 3) [mm]; ``free`` (f,) indices of the moving points, ascending; ``cables`` (m, 2) the pairs
    that have at least one free end; ``density`` (m,) [1] their force densities, 1/length over the mean of
    1/length.
    """

    rest: Points
    free: Indices
    cables: Indices
    density: Floats

    @cached_property
    def place(self) -> Indices:
        """Row of each control point among the free ones, shape (n,); -1 for a fixed point."""
        place = np.full(len(self.rest), -1, dtype=np.int64)
        place[self.free] = np.arange(len(self.free))
        return place

    @cached_property
    def stiffness(self) -> Floats:
        """The cables' stiffness between free points, shape (f, f) [1]: Laplacian of the force densities."""
        return laplacian(self.place, self.cables, self.density)

    @cached_property
    def mean_stiffness(self) -> float:
        """The mean over the free points of the sum of their force densities [1]."""
        return float(np.mean(np.diag(self.stiffness)))

    def expand(self, moved: Points) -> Points:
        """Return all control points, shape (n, 3) [mm], the free ones displaced by ``moved`` (f, 3)."""
        points = self.rest.copy()
        points[self.free] += moved
        return points


def tensegric_model(mesh: Mesh, fixed: Flags) -> TensegricModel:
    """Build the model on a control mesh; ``fixed``, shape (n,), marks what stays (paper section 4)."""
    lengths = np.linalg.norm(mesh.vertices[mesh.edges[:, 0]] - mesh.vertices[mesh.edges[:, 1]], axis=1)
    density = (1.0 / lengths) / np.mean(1.0 / lengths)
    moving = ~(fixed[mesh.edges[:, 0]] & fixed[mesh.edges[:, 1]])
    free = np.flatnonzero(~fixed)
    return TensegricModel(mesh.vertices, free, mesh.edges[moving], frozen(density[moving]))


def incidence_of(place: Indices, pairs: Indices) -> Floats:
    """Return the signed incidence of ``pairs`` (s, 2) on the free points, shape (s, f).

    It is +1 at the first end and -1 at the second.
    """
    signs = np.zeros((len(pairs), int(place.max(initial=-1)) + 1))
    rows = np.arange(len(pairs))
    for end, sign in ((0, 1.0), (1, -1.0)):
        at = place[pairs[:, end]]
        signs[rows[at >= 0], at[at >= 0]] = sign
    return signs


def laplacian(place: Indices, pairs: Indices, weight: Floats) -> Floats:
    """Return the weighted Laplacian of ``pairs`` restricted to the free points, shape (f, f)."""
    signs = incidence_of(place, pairs)
    return np.asarray(signs.T @ (weight[:, None] * signs))
