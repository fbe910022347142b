"""Band storage: symmetric and general matrices over the free coordinates, ordered so that they are narrow.

A matrix is the sum of a few contributions, each linear in a handful of figures (blocks of springs, positions
of corners). Where their entries go is worked out once; filling a matrix is then one sparse product, and its
factors cost little because the free points are ordered to lie near their neighbours (Cuthill and McKee).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.linalg import blas, lapack
from scipy.sparse.csgraph import reverse_cuthill_mckee
from scipy.sparse.linalg import splu

from core.geometry.mesh import Flags, Floats, Indices, frozen

DENSE_LIMIT = 65536
"""Up to this many entries a product with the full matrix is quicker than with its non-zero entries."""

Operator = Floats | sparse.csr_array
Solve = Callable[[Floats], Floats]


def compact(matrix: sparse.csr_array) -> Operator:
    """Return ``matrix`` in the form whose products are quickest: full if it is small."""
    return frozen(matrix.toarray()) if np.prod(matrix.shape) <= DENSE_LIMIT else matrix


def over_axes(matrix: Operator, points: int) -> sparse.csr_array:
    """Return a stiffness of ``points`` over all coordinates, (3 f, 3 f): an (f, f) one acts on each axis."""
    whole = sparse.csr_array(matrix)
    return whole if whole.shape[0] == 3 * points else sparse.csr_array(sparse.kron(whole, np.eye(3)))


def lower_points(matrix: Operator, points: int, relaxation: float = 1.0) -> Operator:
    """Return the lower triangle of a stiffness over all coordinates, (3 f, 3 f), each point's block whole.

    Each block on the diagonal is divided by ``relaxation`` [1]: the points then go so much further. A full
    matrix over the coordinates remains one.
    """
    if isinstance(matrix, np.ndarray) and len(matrix) == 3 * points:
        point = np.arange(3 * points) // 3
        lower = np.where(point[:, None] >= point, matrix, 0.0)
        return np.where(point[:, None] == point, lower / relaxation, lower)
    whole = sparse.coo_array(over_axes(matrix, points))
    row, column = whole.row // 3, whole.col // 3
    below = row >= column
    value = np.where(row == column, whole.data / relaxation, whole.data)
    kept = (value[below], (whole.row[below], whole.col[below]))
    return sparse.csr_array(sparse.coo_array(kept, shape=whole.shape))


@dataclass(frozen=True, eq=False)
class Entries:
    """Matrix entries that are linear in ``width`` figures: ``value`` times figure ``source`` at its place.

    ``row``, ``column`` (e,) are free coordinates, 3 times the free point plus the axis; both halves of a
    symmetric matrix are listed. Entries at the same place add up.
    """

    row: Indices
    column: Indices
    source: Indices
    value: Floats
    width: int


def member_entries(signs: Operator) -> Entries:
    """Return the entries of a block B (3, 3) for each member: what it does between all its points.

    Of a member whose vector is the sum of ``signs`` (s, f) times the free points, B lies between points i and
    j times both signs. The figures are the blocks, (9 s,).
    """
    member, point, sign = nonzero_entries(signs)
    i, j = same_member(member)
    a, b = (axis.ravel()[None, :] for axis in np.indices((3, 3)))
    row, column = 3 * point[i][:, None] + a, 3 * point[j][:, None] + b
    source = 9 * member[i][:, None] + 3 * a + b
    value = np.repeat(sign[i] * sign[j], 9)
    return joined([Entries(row.ravel(), column.ravel(), source.ravel(), value, 0)], 9 * signs.shape[0])


def same_member(member: Indices) -> tuple[Indices, Indices]:
    """Return all pairs of rows, both (p,), that belong to the same ``member`` (e,)."""
    shape = int(member.max(initial=-1)) + 1, len(member)
    belongs = sparse.csr_array((np.ones(len(member)), (member, np.arange(len(member)))), shape=shape)
    first, second, _ = nonzero_entries(sparse.csr_array(belongs.T @ belongs))
    return first, second


def nonzero_entries(matrix: Operator) -> tuple[Indices, Indices, Floats]:
    """Return rows, columns and values of the entries that are not 0, each (e,)."""
    row, column, value = sparse.find(sparse.csr_array(matrix))
    return row.astype(np.int64), column.astype(np.int64), value


def joined(parts: list[Entries], width: int) -> Entries:
    """Return all entries of ``parts`` as one list of ``width`` figures."""
    row, column, source = (
        np.concatenate([getattr(part, name) for part in parts]).astype(np.int64)
        for name in ("row", "column", "source")
    )
    return Entries(row, column, source, np.concatenate([part.value for part in parts]), width)


def weighted_sum(parts: Sequence[Entries], figures: Sequence[Floats], size: int) -> sparse.csr_array:
    """Return the matrix (size, size) that ``figures`` make with the entries of ``parts``."""
    pieces = [
        (part.value * of[part.source], part.row, part.column) for part, of in zip(parts, figures, strict=True)
    ]
    value, row, column = (np.concatenate(column) for column in zip(*pieces, strict=True))
    return sparse.csr_array((value, (row, column)), shape=(size, size))


@dataclass(frozen=True, eq=False)
class Band:
    """An order of the free coordinates, shape (3 f,), in which all matrices of a model are narrow.

    ``place`` tells where each coordinate comes; entries lie at most ``reach`` off the diagonal.
    """

    place: Indices
    reach: int

    @property
    def size(self) -> int:
        """Return the number of coordinates."""
        return len(self.place)

    @cached_property
    def _order(self) -> Indices:
        return np.argsort(self.place)

    def lower(self, entries: Entries) -> sparse.csc_array:
        """Return the map from the entries' figures to the lower band of a symmetric matrix."""
        at, below = self._in_lower(entries)
        return self._map(entries, at, below, self.size * (self.reach + 1))

    def lower_values(self, entries: Entries) -> Floats:
        """Return the lower band of a symmetric matrix all of whose figures are 1."""
        at, below = self._in_lower(entries)
        values = np.bincount(at[below], entries.value[below], self.size * (self.reach + 1))
        return np.asarray(values, dtype=np.float64)

    def _in_lower(self, entries: Entries) -> tuple[Indices, Flags]:
        """Return where entries lie in a lower band, and which of them do."""
        row, column = self.place[entries.row], self.place[entries.column]
        return column * (self.reach + 1) + row - column, row >= column

    def general(self, entries: Entries) -> sparse.csc_array:
        """Return the map from the entries' figures to the band of any matrix, with room for pivoting."""
        row, column = self.place[entries.row], self.place[entries.column]
        at = column * self._tall + 2 * self.reach + row - column
        return self._map(entries, at, np.ones(len(at), dtype=bool), self.size * self._tall)

    @property
    def _tall(self) -> int:
        return 3 * self.reach + 1

    def _map(self, entries: Entries, at: Indices, kept: Flags, size: int) -> sparse.csc_array:
        # By columns: a full band has half a million rows, most of them empty.
        where = (at[kept], entries.source[kept])
        return sparse.csc_array((entries.value[kept], where), shape=(size, entries.width))

    def cholesky(self, lower: Floats) -> Solve | None:
        """Return a solver of the symmetric matrix with this lower band, None unless positive definite.

        One of complex numbers is Hermitian.
        """
        hermitian = np.iscomplexobj(lower)
        factorise = lapack.zpbtrf if hermitian else lapack.dpbtrf
        back = lapack.zpbtrs if hermitian else lapack.dpbtrs
        factor, bad = factorise(lower.reshape(self.size, self.reach + 1).T, lower=1)
        if bad:
            return None

        def solve(right: Floats) -> Floats:
            found, _ = back(factor, right[self._order], lower=1)
            return np.asarray(found[self.place])

        return solve

    def indefinite(self, lower: Floats) -> tuple[Solve, int] | None:
        """Return a solver of the symmetric matrix with this lower band, and how many directions are negative.

        None if it cannot be factored on its diagonal, as one that is singular.
        """
        at = np.flatnonzero(lower)
        column = at // (self.reach + 1)
        row = column + at % (self.reach + 1)
        off = row > column
        both = np.concatenate([row, column[off]]), np.concatenate([column, row[off]])
        values = np.concatenate([lower[at], lower[at][off]])
        matrix = sparse.csc_array((values, both), shape=(self.size, self.size))
        try:
            factor = splu(matrix, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except RuntimeError:
            return None
        if (factor.perm_r != factor.perm_c).any():
            return None
        # By Sylvester's law of inertia: all pivots are on the diagonal.
        negative = int((factor.U.diagonal() < 0.0).sum())
        return lambda right: np.asarray(factor.solve(right[self._order])[self.place]), negative

    def lu(self, general: Floats) -> Solve | None:
        """Return a solver of the matrix with this general band, None if it is singular."""
        matrix = general.reshape(self.size, self._tall).T
        factor, pivots, bad = lapack.dgbtrf(matrix, self.reach, self.reach)
        if bad:
            return None

        def solve(right: Floats) -> Floats:
            found, _ = lapack.dgbtrs(factor, self.reach, self.reach, right[self._order], pivots)
            return np.asarray(found[self.place])

        return solve

    def product(self, general: Floats) -> Solve:
        """Return what multiplies by the matrix with this general band."""
        matrix = general.reshape(self.size, self._tall)[:, self.reach :].T

        def multiply(right: Floats) -> Floats:
            found = blas.dgbmv(self.size, self.size, self.reach, self.reach, 1.0, matrix, right[self._order])
            return np.asarray(found[self.place])

        return multiply

    @cached_property
    def _whole(self) -> tuple[Indices, Indices, Indices, Indices]:
        """Return where the lower band's entries lie in a general band, and in its upper half mirrored."""
        column, off = (at.ravel() for at in np.indices((self.size, self.reach + 1)))
        inside = column + off < self.size
        source = np.flatnonzero(inside)
        column, off = column[inside], off[inside]
        upper = off > 0
        mirror = (column + off) * self._tall + 2 * self.reach - off
        return source, column * self._tall + 2 * self.reach + off, source[upper], mirror[upper]

    def spread(self, lower: Floats) -> Floats:
        """Return the general band of the symmetric matrix with this lower band."""
        source, at, above, mirror = self._whole
        general = np.zeros(self.size * self._tall)
        general[at] = lower[source]
        general[mirror] = lower[above]
        return general

    def full(self, lower: Floats) -> Floats:
        """Return the symmetric matrix with this lower band, shape (3 f, 3 f), in the order of coordinates."""
        column, off = (at.ravel() for at in np.indices((self.size, self.reach + 1)))
        inside = column + off < self.size
        matrix = np.zeros((self.size, self.size))
        row, column = self._order[(column + off)[inside]], self._order[column[inside]]
        matrix[row, column] = matrix[column, row] = lower[inside]
        return matrix


def band_of(count: int, first: Indices, second: Indices) -> Band:
    """Order ``count`` free points so that all pairs ``first``, ``second`` (-1: a fixed point) lie near."""
    both = (first >= 0) & (second >= 0)
    ones = np.ones(int(both.sum()))
    half = sparse.coo_array((ones, (first[both], second[both])), shape=(count, count)).tocsr()
    graph = sparse.csr_array(half + half.T + sparse.eye_array(count))
    place = np.empty(count, dtype=np.int64)
    place[reverse_cuthill_mckee(graph, symmetric_mode=True)] = np.arange(count)
    far = int(np.abs(place[first[both]] - place[second[both]]).max(initial=0))
    coordinates = 3 * place[:, None] + np.arange(3)
    return Band(coordinates.ravel(), 3 * far + 2)
