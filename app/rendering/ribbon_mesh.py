"""Ribbons of real width that lie on the skin, whole bands round the body or parts of one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil
from weakref import WeakKeyDictionary

import numpy as np
from scipy import sparse
from scipy.ndimage import maximum_filter
from scipy.spatial import cKDTree

from app.rendering.render_mesh import RenderMesh, render_mesh
from core.garment.curve_smoothing import CentreLine, centre_line, smooth
from core.garment.curve_smoothing import LocalPlanes as SkinSurface
from core.geometry.mesh import Faces, Floats, Indices, Mesh, Points, unit
from core.geometry.plane_sections import arc_length, interpolate
from core.pipeline.line_routes import LineRoute

CASING = 7.0
"""How much wider the white casing of the selected ribbon is [mm]."""

_FLAT = 0.86  # how far the flat top of a ribbon reaches, in half widths
_APART = 5.0  # about how far apart points lie on it: the skin would stand through a longer chord [mm]
_PUFF = (-1.2, 0.5)  # how the rim of a ribbon is puffed, whose top is 1, from outside
_RIM = len(_PUFF)
_LEAST, _MORE = 0.7, 1.2  # how high a ribbon stands off the skin, and how much more where it is puffed [mm]
_CLOTH, _CROSSING = 0.4, 6.0  # how far a ribbon stands off another, and how near that is to be under it [mm]
_CLIMB = 2.5  # how far it is raised at most: what is selected is drawn over all by a little more [mm]
_ROUND = np.radians([0.0, 18.0, 36.0, 54.0, 72.0, 90.0])  # where the rows of a round end lie
_DASH = (3, 2)  # so many rows of a dashed ribbon are drawn, and so many are left out
_TIP = 0.1  # a ribbon narrower than this, in widths, dips under the skin


@dataclass(frozen=True, eq=False)
class Ribbon:
    """A ribbon at rest, rows of points across, and the matrix that moves it with the body.

    ``follow`` averages body displacements, shape (r, n), so that points = vertices + follow @ displacement.
    ``part`` (rows,) is the segment of the line's path that each row lies on, -1 on the back; ``at`` (rows,)
    how far along the places of its centre line, 0 to 1, and ``lifted`` (rows, 3) how far it is held off the
    skin [mm]. ``up`` (r, 3) are the normals of the skin under its points, ``rise`` (r, 3) how far they are
    raised over other ribbons [mm].
    """

    mesh: Mesh
    follow: sparse.csr_array
    part: Indices
    at: Floats
    lifted: Points
    up: Points
    rise: Points

    @property
    def rows(self) -> int:
        """Return the number of cross-sections."""
        return len(self.part)

    @property
    def columns(self) -> int:
        """Return the number of points of a cross-section, which is even."""
        return len(self.mesh.vertices) // self.rows

    @property
    def top(self) -> Points:
        """Return the points between its rims, shape (rows, columns - 4, 3) [mm]."""
        return self.mesh.vertices.reshape(self.rows, -1, 3)[:, _RIM:-_RIM]

    @property
    def dashes(self) -> Faces:
        """Return the triangles that are left of it where it is dashed, shape (k, 3)."""
        row = self.mesh.faces[:, 0] // self.columns
        return self.mesh.faces[row % sum(_DASH) < _DASH[0]]

    def over(self, lower: Sequence[Ribbon]) -> Ribbon:
        """Return it raised to where it lies on ``lower`` ribbons that it crosses."""
        if not lower:
            return self
        under = np.concatenate([each.top.reshape(-1, 3) for each in lower])
        far, near = map(np.asarray, cKDTree(under).query(self.top, 4, distance_upper_bound=_CROSSING))
        up = self.up.reshape(self.rows, -1, 3)
        above = under[near.clip(max=len(under) - 1)] - self.top[:, :, None]
        high = np.einsum("kcnx,kcx->kcn", above, up[:, _RIM:-_RIM]) + _CLOTH
        high = np.where(np.isfinite(far), high.clip(0.0, _CLIMB), 0.0).max(axis=2)
        raised = smooth(maximum_filter(high, size=3, mode="nearest"), 2, closed=False)
        rise = np.pad(raised, ((0, 0), (_RIM, _RIM)), "edge")[..., None] * up
        return self._raised(rise.reshape(-1, 3))

    def under(self, ribbon: Ribbon) -> Ribbon:
        """Return this casing raised as its ``ribbon`` is, to look out from under it all round."""
        nearest = cKDTree(ribbon.mesh.vertices).query(self.mesh.vertices)[1]
        return self._raised(ribbon.rise[nearest])

    def _raised(self, rise: Points) -> Ribbon:
        return replace(self, mesh=self.mesh.moved(self.mesh.vertices + rise), rise=rise)


_LAID: WeakKeyDictionary[RenderMesh, dict[object, Ribbon]] = WeakKeyDictionary()


class RibbonSurface(SkinSurface):
    """Smooth local planes of a body, on which paths are laid, and what stands up there."""

    def __init__(self, mesh: Mesh) -> None:
        super().__init__(mesh, render_mesh(mesh).tree)
        self._laid = _LAID.setdefault(render_mesh(mesh), {})

    def ribbon(self, route: LineRoute, width: float, cased: bool = False) -> Ribbon:
        """Return what ``build_ribbon`` gives, or ``build_casing`` if it is ``cased``; at once if laid."""
        laid = self._laid.get(_key(route, width, cased))
        return laid or (build_casing if cased else build_ribbon)(route, self, width)

    def lay_ready(self, route: LineRoute, width: float) -> None:
        """Compute ribbon and casing and keep them for all surfaces of the mesh; runs in any thread."""
        for cased in (False, True):
            self._laid[_key(route, width, cased)] = self.ribbon(route, width, cased)

    def bumps(self, rows: Points, up: Points) -> Floats:
        """Return how far skin such as a nipple stands up at each of ``rows`` of places, (k, c, 3) [mm]."""
        index, _ = self.near(rows.reshape(-1, 3), 7)
        above = self.mesh.vertices[index].reshape(*rows.shape[:2], -1, 3) - rows[:, :, None]
        over = np.einsum("kcnx,kcx->kcn", above, up).max(axis=2)
        wide = maximum_filter(np.maximum(over - _LEAST, 0.0), size=(3, 3), mode="nearest")
        return smooth(wide, 2, closed=False)


def rimmed(rim: Sequence[float], columns: int) -> Floats:
    """Return a value for each of ``columns`` points across, (columns,): ``rim`` from either edge, else 1."""
    return np.concatenate([rim, np.ones(columns - 2 * len(rim)), rim[::-1]])


def _across(width: float) -> Floats:
    """Return where the points of a cross-section lie, in half widths, shape (c,)."""
    top = np.linspace(-_FLAT, _FLAT, 2 * max(2, ceil(0.5 * _FLAT * width / _APART)))
    return np.concatenate([[-1.0, -1.0], top, [1.0, 1.0]])


def _key(route: LineRoute, width: float, cased: bool) -> object:
    return route.path.tobytes(), width, route.back.tobytes(), route.drawn, route.sewn, cased


def _middle(route: LineRoute, surface: RibbonSurface, width: float) -> CentreLine:
    return centre_line(route.path, surface, route.back, width, drawn=route.drawn, sewn=route.sewn)


def build_ribbon(route: LineRoute, surface: RibbonSurface, width: float) -> Ribbon:
    """Return the ribbon ``width`` [mm] wide along a ``route``, see ``centre_line``."""
    return _puffed(_middle(route, surface, width), surface, width, sink=0.0)


def build_casing(route: LineRoute, surface: RibbonSurface, width: float) -> Ribbon:
    """Return the ribbon that looks out all round the one ``width`` [mm] wide along a ``route``."""
    line = _middle(route, surface, width)
    if not line.closed:
        beyond = 0.5 * CASING * unit(line.points[[0, -1]] - line.points[[1, -2]])
        ends = line.points[[0, -1]] + beyond
        laid = surface.project(np.concatenate([ends[:1], line.points, ends[1:]]))
        line = CentreLine(*laid, np.pad(line.lift, 1, "edge"), np.pad(line.part, 1, "edge"), False)
    return _puffed(line, surface, width + CASING, sink=0.9)


def _puffed(line: CentreLine, surface: RibbonSurface, width: float, sink: float) -> Ribbon:
    """Return the ribbon about a centre line, pressed ``sink`` [mm] towards the skin; open ends are round."""
    count = len(line.points)
    at, narrow = np.arange(count) / count, np.ones(count)
    if not line.closed:
        line, at, narrow = _rounded(line, 0.5 * width)
    points, closed = line.points, line.closed
    ahead = np.roll(points, -1, 0) - np.roll(points, 1, 0) if closed else np.gradient(points, axis=0)
    side = unit(smooth(unit(np.cross(line.normals, ahead)), 6, closed))
    across = _across(width)
    reach = 0.5 * width * narrow[:, None, None] * across[:, None]
    flat = points[:, None] + reach * side[:, None]
    laid, up = (each.reshape(flat.shape) for each in surface.project(flat.reshape(-1, 3)))
    puff = np.tile(rimmed(_PUFF, len(across)), (len(points), 1))
    puff[narrow < _TIP] = _PUFF[0]
    lift = _LEAST + _MORE * puff - sink
    if closed:
        laid, up = smooth(laid, 3, closed), unit(smooth(up, 3, closed))
    raised = laid + (lift + surface.bumps(laid, up))[..., None] * up
    lifted = line.lift[:, None] * line.normals
    raised += lifted[:, None]
    vertices, faces = raised.reshape(-1, 3), _grid_faces(len(points), len(across), closed)
    follow = surface.displacement_weights(vertices)
    flush = np.zeros_like(vertices)
    return Ribbon(Mesh(vertices, faces), follow, line.part, at, lifted, up.reshape(-1, 3), flush)


def _rounded(line: CentreLine, radius: float) -> tuple[CentreLine, Floats, Floats]:
    """Return an open line with more rows near its ends.

    With it comes where each row lies along the places of ``line``, 0..1, and how wide the ribbon is, 0..1.
    """
    s = arc_length(line.points)
    radius = min(radius, 0.4 * s[-1])
    near = radius * (1.0 - np.cos(_ROUND))
    at = np.concatenate([near, s[(s > radius) & (s < s[-1] - radius)], (s[-1] - near)[::-1]])
    points, normals = (interpolate(at, s, rows) for rows in (line.points, line.normals))
    part = line.part[np.searchsorted(s, at).clip(0, len(s) - 1)]
    inward = np.minimum(np.minimum(at, s[-1] - at) / radius, 1.0)
    narrow = np.maximum(np.sqrt(1.0 - (1.0 - inward) ** 2), 0.5 * _TIP)
    rows = CentreLine(points, unit(normals), np.interp(at, s, line.lift), part, False)
    return rows, np.interp(at, s, np.linspace(0.0, 1.0, len(s))), narrow


def _grid_faces(rows: int, columns: int, closed: bool) -> Faces:
    a = (np.arange(rows if closed else rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    b = (a + columns) % (rows * columns)
    return np.concatenate([np.stack([a, b, b + 1], axis=1), np.stack([a, b + 1, a + 1], axis=1)])
