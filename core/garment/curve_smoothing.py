"""The centre line of a band: a line as it is worn, smooth on the skin, round the back where it has one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.ndimage import convolve1d
from scipy.spatial import cKDTree

from core.geometry.mesh import Floats, Indices, Mesh, Points, unit
from core.geometry.plane_sections import arc_length, interpolate, resample
from core.pipeline.line_routes import NO_BACK

STEP = 4.0
"""Distance between places along a centre line [mm]."""

USUAL_WIDTH = 12.0
"""Width of a band of which nothing else is said [mm]."""

_ASIDE = 0.4  # how far the middle of a taut band may leave its path, in widths: it still lies over it
_PULLS = 12  # how often it is pulled straighter at most
_TOUCH = 1.5  # a taut band that stands off the skin by less than this lies on it [mm]


class LocalPlanes:
    """Smooth local planes of a body, on which paths are laid; a ``tree`` that is there finds its vertices."""

    def __init__(self, mesh: Mesh, tree: cKDTree | None = None) -> None:
        self.mesh = mesh
        self._tree = cKDTree(mesh.vertices) if tree is None else tree

    def near(self, points: Points, count: int = 5) -> tuple[Indices, Floats]:
        """Return the nearest vertices and their weights, both (k, count); weights sum to 1 and fade out."""
        distance, index = map(np.asarray, self._tree.query(points, count + 1))
        weight = (1.0 - (distance / distance[:, -1:]) ** 2)[:, :count] ** 2 + 1e-9
        return index[:, :count], weight / weight.sum(axis=1, keepdims=True)

    def project(self, points: Points) -> tuple[Points, Points]:
        """Return ``points`` moved onto the skin and the normals there, both (k, 3)."""
        for _ in range(2):
            index, weight = self.near(points)
            centre = np.einsum("kc,kcx->kx", weight, self.mesh.vertices[index])
            normal = unit(np.einsum("kc,kcx->kx", weight, self.mesh.vertex_normals[index]))
            points = points - np.einsum("kx,kx->k", points - centre, normal)[:, None] * normal
        return points, normal

    def displacement_weights(self, points: Points) -> sparse.csr_array:
        """Return the matrix that averages vertex displacements at ``points``, shape (k, n)."""
        index, weight = self.near(points)
        start = np.arange(0, index.size + 1, index.shape[1])
        return sparse.csr_array(
            (weight.ravel(), index.ravel(), start), shape=(len(points), len(self.mesh.vertices))
        )


@dataclass(frozen=True, eq=False)
class CentreLine:
    """The middle of a band: places on the skin and normals there, both (k, 3), and ``lift`` (k,) [mm].

    ``lift`` is how far a taut band stands off the skin where it bridges a hollow; ``part`` (k,) the segment
    of the path that a place lies on, -1 on the back. A ``closed`` one ends beside the place it begins with.
    """

    points: Points
    normals: Points
    lift: Floats
    part: Indices
    closed: bool


def centre_line(
    path: Points,
    surface: LocalPlanes,
    back: Points = NO_BACK,
    width: float = 0.0,
    *,
    drawn: bool = False,
    sewn: bool = False,
) -> CentreLine:
    """Return a smooth curve every ``STEP`` along ``path`` and, if it is given, round the ``back`` of it.

    Both have shape (k, 3) [mm]; the back goes on from the end of the path, to its beginning or elsewhere. A
    band of some ``width`` [mm] is laid as straight as it can lie on the skin with the path still under it;
    one that was ``drawn`` there is kept where it is. The ends of a ``sewn`` one stay, if it is open, even
    where there is no skin, as at the back centre over the cleft.
    """
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (a fifth of a second that no start needs)

    path = path[np.r_[True, np.linalg.norm(np.diff(path, axis=0), axis=1) > 1e-6]]
    whole = np.concatenate([path, back[1:]])
    closed = len(whole) > 3 and bool(np.linalg.norm(whole[-1] - whole[0]) < 1e-6)
    s = arc_length(whole)
    if closed:
        whole[-1] = whole[0]
    at = np.linspace(0.0, s[-1], max(2, round(s[-1]) + 1))
    taut = interpolate(at, s, whole)
    if drawn:
        points, normals = surface.project(evenly(taut, closed))
    else:
        ends = whole[[0, -1]] if sewn and not closed else None
        bent = CubicSpline(s, whole, bc_type="periodic" if closed else "not-a-knot")(at)
        points, normals = _pulled(_laid(surface, evenly(bent, closed), ends)[0], surface, width, ends, closed)
    normals = unit(smooth(normals, 4, closed))
    nearest = np.asarray(cKDTree(taut).query(points)[1])
    off = np.einsum("kx,kx->k", taut[nearest] - points, normals)
    lift = smooth(np.maximum(off - _TOUCH, 0.0), 6, closed)
    part = np.searchsorted(s, at[nearest], side="right") - 1
    # A strap pulls over the shoulder as its last segment does; a back has a pull of its own.
    part = np.where(part < len(path) - 1, part, -1 if len(back) and closed else len(path) - 2)
    return CentreLine(points, normals, lift, part, closed)


def _laid(surface: LocalPlanes, points: Points, ends: Points | None) -> tuple[Points, Points]:
    """Return ``points`` on the skin and the normals there, both (k, 3); ``ends`` (2, 3) stay in place."""
    laid, normals = surface.project(points)
    if ends is not None:
        laid[[0, -1]] = ends
    return laid, normals


def _pulled(
    start: Points, surface: LocalPlanes, width: float, ends: Points | None, closed: bool
) -> tuple[Points, Points]:
    """Return a curve on the skin, pulled straight as far as a band ``width`` [mm] may go, and normals."""
    best = _laid(surface, evenly(smooth(start, 4, closed), closed, around=closed), ends)
    for _ in range(_PULLS):
        pulled = _laid(surface, evenly(smooth(best[0], 32, closed), closed, around=closed), ends)
        far = np.asarray(cKDTree(pulled[0]).query(start)[0])
        if far.max() > np.hypot(_ASIDE * width, 0.5 * STEP):
            break
        best = pulled
    return best


def evenly(curve: Points, closed: bool, around: bool = False) -> Points:
    """Return points every ``STEP`` along a curve; of a closed one the last, which is the first, is left out.

    ``around``: the curve is closed and comes without its last point.
    """
    even = resample(np.concatenate([curve, curve[:1]]) if around else curve, STEP)
    return even[:-1] if closed else even


def smooth(rows: Floats, passes: int, closed: bool) -> Floats:
    """Return ``rows``, shape (k, ...), averaged along the line; the ends of an open line stay."""
    for _ in range(passes):
        middle = convolve1d(rows, [0.25, 0.5, 0.25], axis=0, mode="wrap" if closed else "nearest")
        rows = middle if closed else np.concatenate([rows[:1], middle[1:-1], rows[-1:]])
    return rows
