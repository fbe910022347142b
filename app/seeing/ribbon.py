"""Ribbons of real width that lie on the skin, whole bands round the body or parts of one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.interpolate import CubicSpline
from scipy.ndimage import convolve1d, maximum_filter
from scipy.spatial import cKDTree

from app.seeing.skin import skin_of
from core.mesh import Faces, Floats, Indices, Mesh, Points, unit
from core.sections import arc_length, resample

STEP = 4.0
"""Distance between cross-sections along a ribbon [mm]."""

CASING = 7.0
"""How much wider the white casing of the selected ribbon is [mm]."""

ACROSS = np.array([-1.0, -1.0, -0.86, -0.4, 0.4, 0.86, 1.0, 1.0])
"""Where the points of a cross-section lie, in half widths."""

_PUFF = np.array([-1.2, 0.5, 1.0, 1.0, 1.0, 1.0, 0.5, -1.2])
_LEAST, _MORE = 0.7, 1.2  # how high a ribbon stands off the skin, and how much more where it is puffed [mm]
_ASIDE = 0.4  # how far the middle of a taut ribbon may leave its path, in widths: it still lies over it
_PULLS = 12  # how often it is pulled straighter at most
_TOUCH = 1.5  # a taut band that stands off the skin by less than this lies on it [mm]
_ROUND = np.radians([0.0, 18.0, 36.0, 54.0, 72.0, 90.0])  # where the rows of a round end lie
_TIP = 0.1  # a ribbon narrower than this, in widths, dips under the skin
NO_BACK = np.empty((0, 3))


@dataclass(frozen=True, eq=False)
class Ribbon:
    """A ribbon at rest, rows of eight points across, and the matrix that moves it with the body.

    ``follow`` averages body displacements, shape (r, n), so that points = vertices + follow @ displacement.
    ``part`` (rows,) is the segment of the line's path that each row lies on, -1 on the back.
    """

    mesh: Mesh
    follow: sparse.csr_array
    part: Indices

    @property
    def rows(self) -> int:
        """Number of cross-sections."""
        return len(self.mesh.vertices) // len(ACROSS)


class Surface:
    """Smooth local planes of a body, on which paths are laid."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self._tree = skin_of(mesh).tree

    def near(self, points: Points, count: int = 5) -> tuple[Indices, Floats]:
        """Return the nearest vertices and their weights, both (k, count); weights sum to 1 and fade out."""
        distance, index = map(np.asarray, self._tree.query(points, count + 1))
        weight = (1.0 - (distance / distance[:, -1:]) ** 2)[:, :count] ** 2 + 1e-9
        return index[:, :count], weight / weight.sum(axis=1, keepdims=True)

    def lay(self, points: Points) -> tuple[Points, Points]:
        """Return ``points`` moved onto the skin and the normals there, both (k, 3)."""
        for _ in range(2):
            index, weight = self.near(points)
            centre = np.einsum("kc,kcx->kx", weight, self.mesh.vertices[index])
            normal = unit(np.einsum("kc,kcx->kx", weight, self.mesh.vertex_normals[index]))
            points = points - np.einsum("kx,kx->k", points - centre, normal)[:, None] * normal
        return points, normal

    def bumps(self, rows: Points, up: Points) -> Floats:
        """Return how far skin such as a nipple stands up at each of ``rows`` of places, (k, c, 3) [mm]."""
        index, _ = self.near(rows.reshape(-1, 3), 7)
        above = self.mesh.vertices[index].reshape(*rows.shape[:2], -1, 3) - rows[:, :, None]
        over = np.einsum("kcnx,kcx->kcn", above, up).max(axis=2)
        wide = maximum_filter(np.maximum(over - _LEAST, 0.0), size=(3, 3), mode="nearest")
        return _smooth(wide, 2, closed=False)

    def follow(self, points: Points) -> sparse.csr_array:
        """Return the matrix that averages vertex displacements at ``points``, shape (k, n)."""
        index, weight = self.near(points)
        start = np.arange(0, index.size + 1, index.shape[1])
        return sparse.csr_array(
            (weight.ravel(), index.ravel(), start), shape=(len(points), len(self.mesh.vertices))
        )


@dataclass(frozen=True, eq=False)
class CentreLine:
    """The middle of a ribbon: places on the skin and normals there, both (k, 3), and ``lift`` (k,) [mm].

    ``lift`` is how far a taut band stands off the skin where it bridges a hollow; ``part`` as in ``Ribbon``.
    """

    points: Points
    normals: Points
    lift: Floats
    part: Indices
    closed: bool


def centre_line(path: Points, surface: Surface, back: Points = NO_BACK, width: float = 0.0) -> CentreLine:
    """Return a smooth curve every ``STEP`` along ``path`` and, if it is given, round the ``back`` of it.

    Both have shape (k, 3) [mm]; the back goes from the end of the path to its beginning. A ribbon of some
    ``width`` [mm] is drawn as straight as it can lie on the skin with the path still under it.
    """
    path = path[np.r_[True, np.linalg.norm(np.diff(path, axis=0), axis=1) > 1e-6]]
    whole = np.concatenate([path, back[1:]])
    closed = len(whole) > 3 and bool(np.linalg.norm(whole[-1] - whole[0]) < 1e-6)
    s = arc_length(whole)
    if closed:
        whole[-1] = whole[0]
    spline = CubicSpline(s, whole, bc_type="periodic" if closed else "not-a-knot")
    at = np.linspace(0.0, s[-1], max(2, round(s[-1]) + 1))
    laid, _ = surface.lay(_evenly(spline(at), closed))
    points, normals = _pulled(laid, surface, closed, _ASIDE * width)
    normals = unit(_smooth(normals, 4, closed))
    taut = np.stack([np.interp(at, s, axis) for axis in whole.T], axis=1)
    _, nearest = cKDTree(taut).query(points)
    off = np.einsum("kx,kx->k", taut[nearest] - points, normals)
    lift = _smooth(np.maximum(off - _TOUCH, 0.0), 6, closed)
    part = np.searchsorted(s, at[nearest], side="right") - 1
    part = np.where(part < len(path) - 1, part, -1 if len(back) else len(path) - 2)
    return CentreLine(points, normals, lift, part, closed)


def _pulled(start: Points, surface: Surface, closed: bool, aside: float) -> tuple[Points, Points]:
    """Return a curve on the skin, pulled straight within ``aside`` [mm] of where it was, and normals."""
    best = surface.lay(_evenly(_smooth(start, 4, closed), closed, around=closed))
    for _ in range(_PULLS):
        pulled = surface.lay(_evenly(_smooth(best[0], 32, closed), closed, around=closed))
        far = np.asarray(cKDTree(pulled[0]).query(start)[0])
        if far.max() > np.hypot(aside, 0.5 * STEP):
            break
        best = pulled
    return best


def build_ribbon(path: Points, surface: Surface, width: float, back: Points = NO_BACK) -> Ribbon:
    """Return the ribbon ``width`` [mm] wide along ``path`` and round its ``back``, see ``centre_line``."""
    return _puffed(centre_line(path, surface, back, width), surface, width, sink=0.0)


def build_casing(path: Points, surface: Surface, width: float, back: Points = NO_BACK) -> Ribbon:
    """Return the ribbon that looks out all round the one ``width`` [mm] wide along ``path``."""
    line = centre_line(path, surface, back, width)
    if not line.closed:
        beyond = 0.5 * CASING * unit(line.points[[0, -1]] - line.points[[1, -2]])
        ends = line.points[[0, -1]] + beyond
        laid = surface.lay(np.concatenate([ends[:1], line.points, ends[1:]]))
        line = CentreLine(*laid, np.pad(line.lift, 1, "edge"), np.pad(line.part, 1, "edge"), False)
    return _puffed(line, surface, width + CASING, sink=0.9)


def _puffed(line: CentreLine, surface: Surface, width: float, sink: float) -> Ribbon:
    """Return the ribbon about a centre line, pressed ``sink`` [mm] towards the skin; open ends are round."""
    line, narrow = (line, np.ones(len(line.points))) if line.closed else _rounded(line, 0.5 * width)
    points, closed = line.points, line.closed
    ahead = np.roll(points, -1, 0) - np.roll(points, 1, 0) if closed else np.gradient(points, axis=0)
    side = unit(_smooth(unit(np.cross(line.normals, ahead)), 6, closed))
    reach = 0.5 * width * narrow[:, None, None] * ACROSS[:, None]
    flat = points[:, None] + reach * side[:, None]
    laid, up = (each.reshape(flat.shape) for each in surface.lay(flat.reshape(-1, 3)))
    puff = np.tile(_PUFF, (len(points), 1))
    puff[narrow < _TIP] = _PUFF.min()
    lift = _LEAST + _MORE * puff - sink
    if closed:
        laid, up = _smooth(laid, 3, closed), _smooth(up, 3, closed)
    raised = laid + (lift + surface.bumps(laid, up))[..., None] * unit(up)
    raised += (line.lift[:, None] * line.normals)[:, None]
    vertices = raised.reshape(-1, 3)
    return Ribbon(Mesh(vertices, _grid_faces(len(points), closed)), surface.follow(vertices), line.part)


def _rounded(line: CentreLine, radius: float) -> tuple[CentreLine, Floats]:
    """Return an open line with more rows near its ends, and how wide the ribbon is at each row, 0..1."""
    s = arc_length(line.points)
    radius = min(radius, 0.4 * s[-1])
    near = radius * (1.0 - np.cos(_ROUND))
    at = np.concatenate([near, s[(s > radius) & (s < s[-1] - radius)], (s[-1] - near)[::-1]])
    points, normals = (
        np.stack([np.interp(at, s, axis) for axis in of.T], 1) for of in (line.points, line.normals)
    )
    part = line.part[np.searchsorted(s, at).clip(0, len(s) - 1)]
    inward = np.minimum(np.minimum(at, s[-1] - at) / radius, 1.0)
    narrow = np.maximum(np.sqrt(1.0 - (1.0 - inward) ** 2), 0.5 * _TIP)
    return CentreLine(points, unit(normals), np.interp(at, s, line.lift), part, False), narrow


def _evenly(curve: Points, closed: bool, around: bool = False) -> Points:
    """Return points every ``STEP`` along a curve; of a closed one the last, which is the first, is left out.

    ``around``: the curve is closed and comes without its last point.
    """
    even = resample(np.concatenate([curve, curve[:1]]) if around else curve, STEP)
    return even[:-1] if closed else even


def _smooth(rows: Floats, passes: int, closed: bool) -> Floats:
    """Return ``rows``, shape (k, ...), averaged along the line; the ends of an open line stay."""
    for _ in range(passes):
        middle = convolve1d(rows, [0.25, 0.5, 0.25], axis=0, mode="wrap" if closed else "nearest")
        rows = middle if closed else np.concatenate([rows[:1], middle[1:-1], rows[-1:]])
    return rows


def _grid_faces(rows: int, closed: bool) -> Faces:
    width = len(ACROSS)
    a = (np.arange(rows if closed else rows - 1)[:, None] * width + np.arange(width - 1)).ravel()
    b = (a + width) % (rows * width)
    return np.concatenate([np.stack([a, b, b + 1], axis=1), np.stack([a, b + 1, a + 1], axis=1)])
