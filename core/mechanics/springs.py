"""Hooke's law: members that pull when longer and push when shorter than their natural length.

Source: paper section 3 for the segments of constraining lines; the same law serves for prestressed cables.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from core.geometry.mesh import Floats, Indices, Points, frozen
from core.mechanics.banded_matrix import (
    Entries,
    Operator,
    compact,
    member_entries,
    nonzero_entries,
    weighted_sum,
)

_EYE = np.eye(3)


@dataclass(frozen=True, eq=False)
class Springs:
    """Members between two places each, over the displacements of the free points, shape (f, 3) [mm].

    ``across`` (s, n) makes their vectors, from the second place to the first, of all points: +1 at the first
    and -1 at the second, or the weights of the points that a place lies between. ``signs`` (s, f) are its
    columns of the free points. ``rest_spans`` (s, 3) [mm] are the vectors at rest; ``stiffness`` (s,) [1];
    ``still`` (s, 3) [mm] is the part of the vectors that no point moves.
    """

    across: sparse.csr_array
    rest_spans: Points
    stiffness: Floats
    signs: Operator
    still: Points | float = 0.0

    @cached_property
    def gather(self) -> Operator:
        """Return the map that sums what the members do at the free points, shape (f, s)."""
        return (
            np.ascontiguousarray(self.signs.T) if isinstance(self.signs, np.ndarray) else self.signs.T.tocsr()
        )

    @cached_property
    def rest_lengths(self) -> Floats:
        """Lengths at rest, shape (s,) [mm]; worked out as in ``spans``, so that nothing pulls there."""
        return frozen(np.sqrt(np.einsum("ij,ij->i", self.rest_spans, self.rest_spans)))

    @cached_property
    def entries(self) -> Entries:
        """Return where the blocks of the members are in a matrix over the free coordinates."""
        return member_entries(self.signs)

    @cached_property
    def nodes(self) -> Indices:
        """Return the free points that the members act on, ascending, shape (l,)."""
        return np.unique(nonzero_entries(self.signs)[1])

    def weighted(self, weight: Floats) -> sparse.csr_array:
        """Return the stiffness (f, f) of members that have ``weight`` (s,) in all directions."""
        signs = sparse.csr_array(self.signs)
        return sparse.csr_array(signs.T @ sparse.diags_array(weight) @ signs)

    def stretched(self, along: Floats, across: Floats) -> sparse.csr_array:
        """Return the stiffness (3 f, 3 f) of members at rest, (s,) each ``along`` and ``across`` them."""
        blocks = stretch_blocks(self.rest_spans / self.rest_lengths[:, None], along, across)
        return weighted_sum([self.entries], [blocks.ravel()], 3 * self.signs.shape[1])

    def lengths(self, points: Points) -> Floats:
        """Return the lengths of the members at all points, shapes (s,) and (n, 3) [mm]."""
        return np.asarray(np.linalg.norm(self.across @ points + self.still, axis=1))

    def spans(self, moved: Points) -> tuple[Points, Floats]:
        """Return vectors and lengths of the members, shapes (s, 3) and (s,) [mm]."""
        spans = self.rest_spans + self.signs @ moved
        return spans, np.sqrt(np.einsum("ij,ij->i", spans, spans))

    def energy(self, lengths: Floats, natural: Floats) -> float:
        """Return half the stiffness times the square of what each is longer than ``natural`` (s,) [mm]."""
        longer = lengths - natural
        return 0.5 * float(self.stiffness @ (longer * longer))

    def gradient(self, spans: Points, lengths: Floats, natural: Floats) -> Points:
        """Return the derivative of the energy at the free points, shape (f, 3)."""
        return self.sum((self.stiffness * (1.0 - natural / lengths))[:, None] * spans)

    def sum(self, forces: Points) -> Points:
        """Return what forces along the members, shape (s, 3), do at the free points, shape (f, 3)."""
        return np.asarray(self.gather @ forces)

    def blocks(self, spans: Points, lengths: Floats, natural: Floats, clip: bool) -> Floats:
        """Return the second derivative as a block for each member, shape (s, 3, 3).

        ``clip`` leaves out what compressed members take from it.
        """
        across = 1.0 - natural / lengths
        if clip:
            across = np.maximum(across, 0.0)
        return stretch_blocks(spans / lengths[:, None], self.stiffness, self.stiffness * across)


def stretch_blocks(directions: Points, along: Floats, across: Floats) -> Floats:
    """Return ``along`` u u^T + ``across`` (1 - u u^T) for unit vectors u, shape (s, 3, 3)."""
    outer = directions[:, :, None] * directions[:, None, :]
    return np.asarray((along - across)[:, None, None] * outer + across[:, None, None] * _EYE)


def springs(rest: Points, place: Indices, pairs: Indices, stiffness: Floats) -> Springs:
    """Build members between ``pairs`` (s, 2) of points at ``rest`` (n, 3) [mm].

    ``place`` (n,) is the row of each point among the free ones, -1 for a fixed one.
    """
    return members(rest, place, incidence_of(np.arange(len(rest)), pairs), stiffness)


def members(
    rest: Points, place: Indices, across: sparse.csr_array, stiffness: Floats, still: Points | float = 0.0
) -> Springs:
    """Build members whose vectors are ``across`` (s, n) times the points and ``still`` (s, 3) [mm].

    See ``springs`` for the others.
    """
    free = np.flatnonzero(place >= 0)
    signs = sparse.csr_array(across[:, free[np.argsort(place[free])]])
    return Springs(across, frozen(across @ rest + still), frozen(stiffness), compact(signs), still)


def incidence_of(place: Indices, pairs: Indices) -> sparse.csr_array:
    """Return the signed incidence of ``pairs`` (s, 2) on the free points, shape (s, f).

    It is +1 at the first end and -1 at the second; ``place`` (n,) is -1 for a fixed point.
    """
    at = place[pairs]
    row = np.repeat(np.arange(len(pairs)), 2).reshape(-1, 2)
    value = np.broadcast_to([1.0, -1.0], at.shape)
    shape = (len(pairs), int(place.max(initial=-1)) + 1)
    return sparse.csr_array((value[at >= 0], (row[at >= 0], at[at >= 0])), shape=shape)


def laplacian(place: Indices, pairs: Indices, weight: Floats) -> sparse.csr_array:
    """Return the weighted Laplacian of ``pairs`` restricted to the free points, shape (f, f)."""
    signs = incidence_of(place, pairs)
    return sparse.csr_array(signs.T @ sparse.diags_array(weight) @ signs)
