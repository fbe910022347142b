"""One sweep over the free points: each goes where its forces balance, its neighbours being where they are.

Visiting the points one after the other (Gauss-Seidel, paper section 5) is forward substitution with the lower
triangle of the stiffness. Written for what is unbalanced before the sweep, it needs nothing else: the points
move by the answer of that triangle to the unbalanced forces, whatever law made them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.linalg import blas, solve_triangular
from scipy.sparse import linalg as sparse_linalg

from core.geometry.mesh import Floats, Indices, Points, frozen, unit
from core.mechanics.banded_matrix import DENSE_LIMIT, Operator, Solve, lower_points


@dataclass(frozen=True, eq=False)
class GaussSeidelSweep:
    """The answer of one sweep; ``forward`` solves the lower triangle for forces of shape (f, 3).

    Under sliding lines it is that of the cables alone. There only the part of a line's force across the skin
    acts at the points ``nodes`` (l,) of the lines: ``line_response`` (l, f) is the lower triangle of the
    lines times ``forward``, ``among`` (l, l) the same between the nodes.
    """

    forward: Solve
    nodes: Indices
    line_response: Floats
    among: Floats

    def solve(self, inner: Points, line: Points, outward: Points) -> Points:
        """Return how far the points move for unbalanced forces of the body and of the lines, all (f, 3).

        ``outward`` are vectors across the skin, of any length; glued lines do not ask for them.
        """
        if not len(self.nodes):
            return self.forward(inner + line)
        # The nodes' rows of the system have the lines' part projected on n: a correction of low rank.
        n = unit(outward[self.nodes])
        forces = inner.copy()
        forces[self.nodes] += n * np.einsum("ij,ij->i", n, line[self.nodes])[:, None]
        known = np.einsum("ij,ij->i", n, self.line_response @ forces)
        taken = np.linalg.solve(np.eye(len(n)) + self.among * (n @ n.T), known)
        forces[self.nodes] -= n * taken[:, None]
        return self.forward(forces)


def bonded_sweep(stiffness: Operator, points: int, relaxation: float = 1.0) -> GaussSeidelSweep:
    """Return the sweep of a stiffness of ``points``, (f, f) if it acts alike in all directions or (3 f, 3 f).

    The latter's points go further by ``relaxation`` [1].
    """
    alike = stiffness.shape[0] == points
    return _glued(_forward(stiffness) if alike else forward_of_blocks(stiffness, points, relaxation))


def block_sweep(forward: ForwardOfBlocks, added: Floats) -> GaussSeidelSweep:
    """Return the sweep where ``added`` (f, 3, 3) [N/mm] is added to the blocks of the points."""
    return _glued(forward.with_blocks(added))


def _glued(forward: Solve) -> GaussSeidelSweep:
    return GaussSeidelSweep(forward, np.empty(0, dtype=np.int64), np.empty((0, 0)), np.empty((0, 0)))


@dataclass(frozen=True, eq=False)
class ForwardOfBlocks:
    """The solver of the lower triangle of a stiffness over all coordinates: each point solves its own block.

    ``own`` (f, 3, 3) [N/mm] are those blocks, ``scaled`` (3 f, 3 f) [1] the rows below them over their own.
    """

    own: Floats
    scaled: Floats

    @cached_property
    def _inverse(self) -> Floats:
        return np.asarray(np.linalg.inv(self.own), dtype=np.float64)

    def __call__(self, right: Points) -> Points:
        """Return what forces (f, 3) [N] move the points by, (f, 3) [mm]."""
        forces = np.einsum("pab,pb->pa", self._inverse, right.reshape(-1, 3)).ravel()
        return np.asarray(blas.dtrsv(self.scaled.T, forces, lower=0, trans=1, diag=1)).reshape(-1, 3)

    def with_blocks(self, added: Floats) -> ForwardOfBlocks:
        """Return the solver where ``added`` (f, 3, 3) [N/mm] is added to the points' own blocks."""
        changed = np.flatnonzero(added.any(axis=(1, 2)))
        if not len(changed):
            return self
        own, scaled = self.own.copy(), self.scaled.copy()
        own[changed] += added[changed]
        rows = scaled.reshape(len(own), 3, -1)
        rows[changed] = np.linalg.solve(own[changed], self.own[changed]) @ rows[changed]
        return ForwardOfBlocks(own, scaled)


def forward_of_blocks(stiffness: Operator, points: int, relaxation: float) -> ForwardOfBlocks:
    """Return the solver for a stiffness (3 f, 3 f), whose points go further by ``relaxation`` [1]."""
    triangle = lower_points(stiffness, points, relaxation)
    lower = triangle if isinstance(triangle, np.ndarray) else triangle.toarray()
    by_point = lower.reshape(points, 3, points, 3)
    every = np.arange(points)
    own = by_point[every, :, every]
    by_point[every, :, every] = 0.0
    scaled = (np.linalg.inv(own) @ lower.reshape(points, 3, -1)).reshape(lower.shape)
    return ForwardOfBlocks(own, frozen(scaled))


def sliding_sweep(cables: Operator, lines: Operator, nodes: Indices) -> GaussSeidelSweep:
    """Return the sweep of cables (f, f) and of lines (f, f) that slide over the points ``nodes``, (l,)."""
    forward = _forward(cables)
    lower = sparse.tril(sparse.csr_array(lines), format="csr")[nodes]
    # Row by row: (T^-1)^T would need the other triangle, so the few columns of T^-1 are made instead.
    at_nodes = np.zeros((cables.shape[0], len(nodes)))
    at_nodes[nodes, np.arange(len(nodes))] = 1.0
    among = lower @ forward(at_nodes)
    reach = lower @ forward(np.eye(cables.shape[0]))
    return GaussSeidelSweep(forward, nodes, frozen(reach), frozen(among))


def _forward(stiffness: Operator) -> Solve:
    """Return the solver of the lower triangle of a stiffness: its inverse if it is small."""
    if np.prod(stiffness.shape) <= DENSE_LIMIT:
        lower = np.tril(stiffness if isinstance(stiffness, np.ndarray) else stiffness.toarray())
        inverse = solve_triangular(lower, np.eye(len(lower)), lower=True)
        return lambda right: np.asarray(inverse @ right)
    lower = sparse.tril(sparse.csr_array(stiffness), format="csc")
    factor = sparse_linalg.splu(lower, permc_spec="NATURAL", diag_pivot_thresh=0.0)
    return lambda right: np.asarray(factor.solve(right))
