"""The trunk of an upright body: its horizontal sections without the arms, and what a tape reads there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from scipy import sparse
from scipy.ndimage import median_filter
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull

from core.errors import LandmarkError
from core.mesh import Flags, Floats, Indices, Mesh, Points
from core.sections import hull_perimeter

GAP = 12.0
"""An open piece of outline nearer than this to the trunk, along x [mm], belongs to it."""

STABLE_STEP = 5.0
"""Step of the search for the stable under-bust level [mm]."""


@dataclass(frozen=True, eq=False)
class Level:
    """The outline of the trunk at height ``z`` [mm]: ``segments``, shape (s, 2, 3) [mm], in no order."""

    z: float
    segments: Points

    @property
    def points(self) -> Points:
        """End points of the segments, shape (2 s, 3) [mm]."""
        return self.segments.reshape(-1, 3)

    @property
    def tape(self) -> float:
        """Length of a tape round the outline, bridging the hollows [mm]."""
        return hull_perimeter(self.points)

    @property
    def longest_straight(self) -> float:
        """Length of the longest hollow that the tape bridges, or of the longest flat [mm]."""
        if self.tape == 0.0:
            return 0.0
        hull = ConvexHull(self.points[:, :2])
        ring = hull.points[hull.vertices]
        return float(np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1).max())

    @property
    def skin(self) -> float:
        """Length of the outline itself [mm]."""
        return float(np.linalg.norm(self.segments[:, 1] - self.segments[:, 0], axis=1).sum())


def trunk_levels(mesh: Mesh, heights: npt.ArrayLike) -> list[Level]:
    """Cut ``mesh`` at ascending ``heights``, shape (k,) [mm], and take the arms out; a level may be empty.

    Source: ours. The trunk is what crosses the middle of the body; closed outlines beside it are arms.
    """
    z = np.atleast_1d(np.asarray(heights, dtype=np.float64))
    segments, ids, level = _cut_levels(mesh, z)
    if len(segments) == 0:
        return [Level(float(height), segments) for height in z]
    piece, closed = _connected(ids)
    pieces = _describe(segments, piece, level, closed)
    middle = _middle(pieces)
    keep = np.zeros(len(pieces.low), dtype=bool)
    for rows in _rows_by_level(pieces.level, len(z)):
        keep[rows] = _trunk_pieces(pieces, rows, middle)
    kept = keep[piece]
    return [
        Level(float(height), segments[rows][kept[rows]])
        for height, rows in zip(z, _rows_by_level(level, len(z)), strict=True)
    ]


def stable_level(mesh: Mesh, underbust_level: float) -> Level:
    """Return the first outline from ``underbust_level`` [mm] down that no longer nicks the breasts.

    In steps of 5 mm: the first whose tape falls to the next by no more than the taper of the ribs + 4 mm, not
    more than 35 mm down; else the one with the smallest fall. Source: ours.
    """
    down = STABLE_STEP * np.arange(9)
    levels = trunk_levels(mesh, underbust_level - down[::-1])[::-1]
    tape = np.array([level.tape for level in levels])
    fall = tape[:-1] - tape[1:]
    taper = (tape[4] - tape[8]) / 4.0
    calm = np.flatnonzero(fall <= taper + 4.0)
    return levels[int(calm[0]) if len(calm) else int(np.argmin(fall))]


def _cut_levels(mesh: Mesh, z: Floats) -> tuple[Points, Indices, Indices]:
    """Return the segments of all levels, the edges that their ends lie on, shape (s, 2), and their levels."""
    height = mesh.vertices[:, 2][mesh.faces.T]
    first = np.searchsorted(z, height.min(axis=0), side="right")
    count = np.searchsorted(z, height.max(axis=0), side="right") - first
    face = np.repeat(np.arange(len(mesh.faces)), count)
    level = np.arange(len(face)) - np.repeat(np.cumsum(count) - count - first, count)
    above = height[:, face] >= z[level]
    lone = np.argmax(above == (above.sum(axis=0) == 1), axis=0)
    corners = mesh.faces[face]
    rows = np.arange(len(face))
    tip = corners[rows, lone]
    ends, ids = [], []
    for turn in (1, 2):
        other = corners[rows, (lone + turn) % 3]
        low, high = np.minimum(tip, other), np.maximum(tip, other)
        a, b = mesh.vertices[low], mesh.vertices[high]
        ends.append(a + (b - a) * ((z[level] - a[:, 2]) / (b[:, 2] - a[:, 2]))[:, None])
        ids.append((level * len(mesh.vertices) + low) * len(mesh.vertices) + high)
    return np.stack(ends, axis=1), np.stack(ids, axis=1), level


def _connected(ids: Indices) -> tuple[Indices, Flags]:
    """Return the connected piece of each segment, and whether each piece closes."""
    nodes, index = np.unique(ids, return_inverse=True)
    index = index.reshape(ids.shape)
    graph = sparse.coo_array((np.ones(len(ids)), (index[:, 0], index[:, 1])), shape=(len(nodes),) * 2)
    count, label = connected_components(graph, directed=False)
    loose = np.bincount(index.ravel(), minlength=len(nodes)) == 1
    closed = np.bincount(label, weights=loose, minlength=count) == 0
    return np.asarray(label[index[:, 0]], dtype=np.int64), closed


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Connected pieces of outline: their extent along x [mm], level and whether they close."""

    low: Floats
    high: Floats
    level: Indices
    closed: Flags


def _describe(segments: Points, piece: Indices, level: Indices, closed: Flags) -> _Pieces:
    order = np.argsort(piece, kind="stable")
    start = np.searchsorted(piece[order], np.arange(len(closed)))
    x = segments[order, :, 0]
    low = np.minimum.reduceat(x.min(axis=1), start)
    high = np.maximum.reduceat(x.max(axis=1), start)
    return _Pieces(low, high, level[order[start]], closed)


def _middle(pieces: _Pieces) -> float:
    """Return x of the middle of the body: the median middle of the widest piece of each level [mm]."""
    order = np.lexsort((pieces.high - pieces.low, pieces.level))
    widest = order[np.append(np.diff(pieces.level[order]) > 0, True)]
    return float(np.median(0.5 * (pieces.low + pieces.high)[widest]))


def _rows_by_level(level: Indices, count: int) -> Iterator[Indices]:
    order = np.argsort(level, kind="stable")
    bounds = np.searchsorted(level[order], np.arange(count + 1))
    return (order[a:b] for a, b in pairwise(bounds))


def _trunk_pieces(pieces: _Pieces, rows: Indices, middle: float) -> Flags:
    """Tell which pieces ``rows`` of one level are trunk."""
    low, high = pieces.low[rows], pieces.high[rows]
    centre = 0.5 * (low + high)
    trunk = np.asarray((low <= middle) & (middle <= high))
    while trunk.any():
        left, right = low[trunk].min(), high[trunk].max()
        inside = (left <= centre) & (centre <= right)
        near = ~pieces.closed[rows] & (low <= right + GAP) & (high >= left - GAP)
        more = trunk | inside | near
        if np.array_equal(more, trunk):
            break
        trunk = more
    return trunk


@dataclass(frozen=True, eq=False)
class Survey:
    """The trunk level by level, from below: arrays of shape (k,) [mm].

    ``samples`` are points spread evenly over all outlines, shape (n, 3) [mm], ``row`` the level of each.
    """

    z: Floats
    step: float
    middle: float
    half_width: Floats
    front: Floats
    back: Floats
    tape: Floats
    samples: Points
    row: Indices

    def level_at(self, z: float) -> int:
        """Return the row of the level nearest to height ``z`` [mm]."""
        return int(np.argmin(np.abs(self.z - z)))

    def trunk(self) -> tuple[float, Flags]:
        """Return the half width of the trunk [mm] and which levels show it free of arms, head and legs."""
        full = self.tape > 0.0
        if not full.any():
            raise LandmarkError("No body is in the middle of the scan.", "Open a scan of a whole upper body.")
        w = self.half_width
        alone = full & (w < 1.25 * np.median(w[full & (w >= np.median(w[full]))]))
        width, girth = np.percentile(w[alone], 70), np.percentile(self.tape[alone], 70)
        usable = full & (w > 0.7 * width) & (w < 1.3 * width) & (self.tape > 0.7 * girth)
        usable &= (self.z < self.z[full].max() - 60.0) & (self.z > self.z[full].min() + 30.0)
        if not 400.0 < girth < 2000.0:
            raise LandmarkError(
                f"The trunk measures {girth:.0f} mm round, which no adult does.",
                "Say in which unit the scan is.",
            )
        return float(width), usable

    def back_width(self) -> Floats:
        """Return the half width of the back half of the levels, steadied over five, shape (k,) [mm]."""
        behind = self.samples[:, 1] > (0.5 * (self.front + self.back))[self.row]
        width = np.zeros(len(self.z))
        np.maximum.at(width, self.row[behind], np.abs(self.samples[behind, 0] - self.middle))
        return np.asarray(np.maximum(median_filter(width, 5), 1.0))


def survey(mesh: Mesh, step: float = 5.0) -> Survey:
    """Cut the whole ``mesh`` every ``step`` [mm] and measure its trunk.

    Raises LandmarkError if it has not the height of a body.
    """
    low, high = mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()
    if not 100.0 < high - low < 2500.0:
        raise LandmarkError(
            f"The scan is {high - low:.0f} mm high, no upper body is.", "Say in which unit it is."
        )
    z = np.arange(low + 0.5 * step, high, step)
    levels = trunk_levels(mesh, z)
    row = np.repeat(np.arange(len(z)), [len(level.segments) for level in levels])
    segments = np.concatenate([level.segments for level in levels])
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    times = np.maximum(1, np.ceil(length / 4.0).astype(np.int64))
    t = (np.arange(times.sum()) - np.repeat(np.cumsum(times) - times, times) + 0.5) / np.repeat(times, times)
    a, b = (np.repeat(segments[:, k], times, axis=0) for k in (0, 1))
    samples, row = a + (b - a) * t[:, None], np.repeat(row, times)
    # (the levels without trunk keep zeros)
    lo, hi = np.zeros((len(z), 3)), np.zeros((len(z), 3))
    for k, level in enumerate(levels):
        if len(level.segments):
            lo[k], hi[k] = level.points.min(axis=0), level.points.max(axis=0)
    full = hi[:, 0] > lo[:, 0]
    middle = float(np.median(0.5 * (lo + hi)[full, 0])) if full.any() else 0.0
    tape = np.array([hull_perimeter(level.segments.mean(axis=1)) for level in levels])
    return Survey(z, step, middle, 0.5 * (hi - lo)[:, 0], lo[:, 1], hi[:, 1], tape, samples, row)
