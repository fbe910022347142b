"""Hooke's law: members that pull when longer and push when shorter than their natural length.

Source: paper section 3 for the segments of constraining lines; the same law serves for prestressed cables.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from core.members.band import Entries, Operator, compact, pair_entries
from core.mesh import Floats, Indices, Points, frozen

_EYE = np.eye(3)


@dataclass(frozen=True, eq=False)
class Springs:
    """Members between pairs of points, over the displacements of the free points, shape (f, 3) [mm].

    ``pairs`` (s, 2) are the ends; ``rest_spans`` (s, 3) [mm] the vectors from the second to the first at
    rest; ``stiffness`` (s,) [1]; ``signs`` (s, f) are +1 at the first end, -1 at the second.
    """

    pairs: Indices
    rest_spans: Points
    stiffness: Floats
    signs: Operator
    ends: tuple[Indices, Indices]

    @cached_property
    def gather(self) -> Operator:
        """The map that sums what the members do at the free points, shape (f, s)."""
        return (
            np.ascontiguousarray(self.signs.T) if isinstance(self.signs, np.ndarray) else self.signs.T.tocsr()
        )

    @cached_property
    def rest_lengths(self) -> Floats:
        """Lengths at rest, shape (s,) [mm]."""
        return frozen(np.linalg.norm(self.rest_spans, axis=1))

    @cached_property
    def entries(self) -> Entries:
        """Where the blocks of the members lie in a matrix over the free coordinates."""
        return pair_entries(*self.ends)

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
    spans = frozen(rest[pairs[:, 0]] - rest[pairs[:, 1]])
    ends = place[pairs[:, 0]], place[pairs[:, 1]]
    return Springs(pairs, spans, frozen(stiffness), compact(incidence_of(place, pairs)), ends)


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
