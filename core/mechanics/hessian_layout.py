"""Layout of the second derivatives of a model, computed once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from core.geometry.mesh import Floats, Indices
from core.mechanics.banded_matrix import (
    Band,
    Entries,
    Operator,
    band_of,
    joined,
    nonzero_entries,
    same_member,
)
from core.mechanics.springs import Springs
from core.mechanics.tensegrity import TissueModel
from core.mechanics.volume import VolumeMeasure


@dataclass(frozen=True, eq=False)
class HessianLayout:
    """Where the second derivatives of one model lie in band storage; it does not depend on any length.

    ``constant`` is what never changes, ``changing`` the map of the other figures: those of the cables' law,
    the blocks of the line segments, and the places of the corners times both pressures, at ``corners``.
    ``trace`` [1] is a stiffness to the ground in ``constant``, too small to see: it keeps bodies that float
    freely in their place.
    """

    band: Band
    constant: Floats
    changing: sparse.csc_array
    segments: Springs
    corners: Entries
    trace: float

    @cached_property
    def lines_general(self) -> sparse.csc_array:
        """The map of the blocks of sliding line segments to a general band: see ``sliding_entries``."""
        return self.band.general(sliding_entries(self.segments.signs))

    @cached_property
    def acting_pairs(self) -> tuple[Indices, Indices]:
        """Return the worn segments and the free points that they act on, pair by pair, both shape (e,)."""
        segment, point, _ = nonzero_entries(self.segments.signs)
        return segment, point

    @property
    def nodes(self) -> Indices:
        """Return the free points that the worn lines act on, ascending, shape (l,)."""
        return self.segments.nodes

    @cached_property
    def corners_of_lines(self) -> Entries:
        """Return those of ``corners`` whose row belongs to a point of an active line."""
        corners = self.corners
        here = np.isin(corners.row // 3, self.nodes)
        row, column, source = (at[here] for at in (corners.row, corners.column, corners.source))
        return Entries(row, column, source, corners.value[here], corners.width)

    @cached_property
    def rotation_general(self) -> sparse.csc_array:
        """The map to a general band of what ``corners_of_lines`` do to all three axes of their points."""
        corners = self.corners_of_lines
        row = (3 * (corners.row // 3)[:, None] + np.arange(3)).ravel()
        every = np.arange(len(row))
        return self.band.general(
            Entries(row, np.repeat(corners.column, 3), every, np.ones(len(row)), len(row))
        )


def layout_of(tensegric: TissueModel, segments: Springs, volume: VolumeMeasure) -> HessianLayout:
    """Compute the layout of a model with the ``segments`` of its active lines."""
    fixed, *parts = tensegric.hessian_entries
    corners = volume.curvature(tensegric.place)
    parts = [*parts, segments.entries, corners]
    count = len(tensegric.free)
    if len(fixed.row) == (3 * count) ** 2:  # all points are joined: there is no narrow order to look for
        band = Band(np.arange(3 * count), 3 * count - 1)
    else:
        coupled = [(part.row // 3, part.column // 3) for part in (fixed, *parts)]
        first, second = (np.concatenate(ends) for ends in zip(*coupled, strict=True))
        band = band_of(count, first, second)
    changing = sparse.csc_array(sparse.hstack([band.lower(part) for part in parts], format="csc"))
    trace = 1e-8 * tensegric.mean_stiffness
    diagonal = np.arange(band.size)
    loose = Entries(diagonal, diagonal, np.zeros_like(diagonal), np.full(band.size, trace), 1)
    constant = band.lower_values(joined([fixed, loose], 1))
    return HessianLayout(band, constant, changing, segments, corners, trace)


def sliding_entries(signs: Operator) -> Entries:
    """Return the entries of the blocks with which segments act on free points, (e, 3, 3) figures.

    ``signs`` (s, f) see ``Springs``; its entries that are not 0 come in the order of
    ``HessianLayout.acting_pairs``. Each
    point feels the segment's vector through a block of its own: the matrix is not symmetric.
    """
    segment, point, sign = nonzero_entries(signs)
    i, j = same_member(segment)
    a, b = (axis.ravel()[None, :] for axis in np.indices((3, 3)))
    row, column = 3 * point[i][:, None] + a, 3 * point[j][:, None] + b
    source = 9 * i[:, None] + 3 * a + b
    value = np.repeat(sign[i] * sign[j], 9)
    return joined([Entries(row.ravel(), column.ravel(), source.ravel(), value, 0)], 9 * len(segment))
