"""Where the second derivatives of a model lie: worked out once, so that filling a matrix is one product."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from core.members.band import Band, Entries, Operator, band_of, joined
from core.members.springs import Springs
from core.mesh import Floats, Indices
from core.tensegric import TensegricModel
from core.volume import VolumeMeasure


@dataclass(frozen=True, eq=False)
class Layout:
    """Where the second derivatives of one model lie in band storage; it does not depend on any length.

    ``constant`` is what never changes, ``changing`` the map of the other figures: those of the cables' law,
    the blocks of the line segments, and the places of the corners times both pressures, at ``corners``.
    ``trace`` [1] is a stiffness to the ground in ``constant``, too small to see: it keeps bodies that float
    freely in their place.
    """

    band: Band
    constant: Floats
    changing: Operator
    segments: Springs
    corners: Entries
    trace: float

    @cached_property
    def lines_general(self) -> Operator:
        """The map of the blocks of sliding line segments to a general band: see ``sliding_entries``."""
        return self.band.general(sliding_entries(*self.segments.ends))

    @cached_property
    def nodes(self) -> Indices:
        """The free points of the worn lines, ascending, shape (l,)."""
        ends = np.concatenate(self.segments.ends)
        return np.unique(ends[ends >= 0])

    @cached_property
    def corners_of_lines(self) -> Entries:
        """Those of ``corners`` whose row belongs to a point of a worn line."""
        corners = self.corners
        here = np.isin(corners.row // 3, self.nodes)
        row, column, source = (at[here] for at in (corners.row, corners.column, corners.source))
        return Entries(row, column, source, corners.value[here], corners.width)

    @cached_property
    def turning_general(self) -> Operator:
        """The map to a general band of what ``corners_of_lines`` do to all three axes of their points."""
        corners = self.corners_of_lines
        row = (3 * (corners.row // 3)[:, None] + np.arange(3)).ravel()
        every = np.arange(len(row))
        return self.band.general(
            Entries(row, np.repeat(corners.column, 3), every, np.ones(len(row)), len(row))
        )


def layout_of(tensegric: TensegricModel, segments: Springs, volume: VolumeMeasure) -> Layout:
    """Work out the layout of a model with the ``segments`` of its worn lines."""
    fixed, *parts = tensegric.hessian_entries
    corners = volume.curvature(tensegric.place)
    parts = [*parts, segments.entries, corners]
    coupled = [(part.row // 3, part.column // 3) for part in (fixed, *parts)]
    first, second = (np.concatenate(ends) for ends in zip(*coupled, strict=True))
    band = band_of(len(tensegric.free), first, second)
    maps = [sparse.csr_array(band.lower(part)) for part in parts]
    changing = sparse.csr_array(sparse.hstack(maps, format="csr"))
    trace = 1e-8 * tensegric.mean_stiffness
    diagonal = np.arange(band.size)
    loose = Entries(diagonal, diagonal, np.zeros_like(diagonal), np.full(band.size, trace), 1)
    constant = band.lower(joined([fixed, loose], 1)) @ np.ones(1)
    return Layout(band, constant, changing, segments, corners, trace)


def sliding_entries(first: Indices, second: Indices) -> Entries:
    """Return the entries of the blocks that the two ends of each segment feel, (s, 2, 3, 3) figures.

    The first end feels A (dx_1 - dx_2), the second B (dx_2 - dx_1): the matrix is not symmetric.
    """
    segment = np.arange(len(first))
    a, b = (axis.ravel()[None, :] for axis in np.indices((3, 3)))
    parts = []
    for end, (i, j) in enumerate(((first, second), (second, first))):
        for column, sign in ((i, 1.0), (j, -1.0)):
            both = (i >= 0) & (column >= 0)
            source = 18 * segment[both][:, None] + 9 * end + 3 * a + b
            at = 3 * i[both][:, None] + a, 3 * column[both][:, None] + b
            parts.append(Entries(at[0].ravel(), at[1].ravel(), source.ravel(), np.full(source.size, sign), 0))
    return joined(parts, 18 * len(first))
