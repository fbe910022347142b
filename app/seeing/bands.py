"""Lines drawn as puffed elastic ribbons of real width that lie on the skin and move with it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pyvista as pv
from scipy import sparse
from scipy.interpolate import CubicSpline
from scipy.ndimage import convolve1d
from scipy.spatial import cKDTree

from app.seeing.body import Sight
from app.seeing.stage import rgb
from core.mesh import Faces, Floats, Indices, Mesh, Points, area_vectors, incidence, unit
from core.sections import arc_length, resample

STEP = 4.0
"""Distance between cross-sections along a ribbon [mm]."""

CASING = 7.0
"""How much wider the white casing of the selected ribbon is [mm]."""

_ACROSS = np.array([-1.0, -1.0, -0.86, -0.4, 0.4, 0.86, 1.0, 1.0])
_PUFF = np.array([-1.2, 0.55, 1.0, 1.0, 1.0, 1.0, 0.55, -1.2])
_SHADE = np.array([0.62, 0.62, 0.86, 1.0, 1.0, 0.86, 0.62, 0.62])


@dataclass(frozen=True, eq=False)
class Band:
    """What is drawn of one line: its path over the control points, (k, 3) [mm], colour and width [mm]."""

    name: str
    path: Points
    colour: str
    width: float = 12.0


@dataclass(frozen=True, eq=False)
class Ribbon:
    """A ribbon at rest, rows of eight points across, and the matrix that moves it with the body.

    ``follow`` averages body displacements, shape (r, n), so that points = vertices + follow @ displacement.
    """

    mesh: Mesh
    follow: sparse.csr_array

    @property
    def rows(self) -> int:
        """Number of cross-sections."""
        return len(self.mesh.vertices) // len(_ACROSS)


class Surface:
    """Smooth local planes of a body, on which paths are laid."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self._tree = cKDTree(mesh.vertices)

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

    def follow(self, points: Points) -> sparse.csr_array:
        """Return the matrix that averages vertex displacements at ``points``, shape (k, n)."""
        index, weight = self.near(points)
        start = np.arange(0, index.size + 1, index.shape[1])
        return sparse.csr_array(
            (weight.ravel(), index.ravel(), start), shape=(len(points), len(self.mesh.vertices))
        )


def centre_line(path: Points, surface: Surface) -> tuple[Points, Points]:
    """Return a smooth curve through ``path`` every ``STEP`` on the skin, and its normals, both (k, 3)."""
    apart = np.r_[True, np.linalg.norm(np.diff(path, axis=0), axis=1) > 1e-6]
    s = arc_length(path[apart])
    spline = CubicSpline(s, path[apart])
    fine = spline(np.linspace(0.0, s[-1], max(2, round(s[-1]) + 1)))
    laid, _ = surface.lay(resample(fine, STEP))
    points, normals = surface.lay(resample(_smooth(laid, 4), STEP))
    return points, unit(_smooth(normals, 4))


def build_ribbon(path: Points, surface: Surface, width: float) -> Ribbon:
    """Return the ribbon ``width`` [mm] wide along ``path``, shape (k, 3)."""
    return _puffed(*centre_line(path, surface), surface, width, sink=0.0)


def build_casing(path: Points, surface: Surface, width: float) -> Ribbon:
    """Return the ribbon that looks out all round the one ``width`` [mm] wide along ``path``, shape (k, 3)."""
    centre, _ = centre_line(path, surface)
    first, last = unit(centre[[0, -1]] - centre[[1, -2]]) * CASING
    # Two rows beyond each end: the outer one dips under the skin, the inner one is seen.
    steps = np.array([[1.0], [0.6]])
    longer = np.concatenate([centre[0] + steps * first, centre, centre[-1] + steps[::-1] * last])
    return _puffed(*surface.lay(longer), surface, width + CASING, sink=1.2)


def _puffed(centre: Points, normal: Points, surface: Surface, width: float, sink: float) -> Ribbon:
    """Return the ribbon about a centre line, pressed ``sink`` [mm] towards the skin."""
    side = unit(np.cross(normal, np.gradient(centre, axis=0)))
    reach = (0.5 * width * _ACROSS)[None, :, None]
    flat = centre[:, None] + reach * side[:, None]
    laid, up = (part.reshape(flat.shape) for part in surface.lay(flat.reshape(-1, 3)))
    puff = np.tile(_PUFF, (len(centre), 1))
    puff[[0, -1]] = _PUFF.min()
    puff[[1, -2]] = np.minimum(puff[[1, -2]], 0.55)
    lift = 0.9 + 1.7 * puff - sink
    points = (_smooth(laid, 3) + lift[..., None] * unit(_smooth(up, 3))).reshape(-1, 3)
    return Ribbon(Mesh(points, _grid_faces(len(centre))), surface.follow(points))


def _smooth(rows: Points, passes: int) -> Points:
    """Return ``rows``, shape (k, ..., 3), averaged along the line; both ends stay."""
    for _ in range(passes):
        middle = convolve1d(rows, [0.25, 0.5, 0.25], axis=0, mode="nearest")
        rows = np.concatenate([rows[:1], middle[1:-1], rows[-1:]])
    return rows


def _grid_faces(rows: int) -> Faces:
    width = len(_ACROSS)
    a = (np.arange(rows - 1)[:, None] * width + np.arange(width - 1)).ravel()
    return np.concatenate(
        [np.stack([a, a + width, a + width + 1], axis=1), np.stack([a, a + width + 1, a + 1], axis=1)]
    )


class RibbonActor:
    """One ribbon on a plotter."""

    def __init__(self, plotter: pv.BasePlotter, ribbon: Ribbon, name: str) -> None:
        self.ribbon = ribbon
        self._sum_at_vertices = incidence(ribbon.mesh.faces, len(ribbon.mesh.vertices))
        self.data = pv.PolyData.from_regular_faces(ribbon.mesh.vertices.astype(np.float32), ribbon.mesh.faces)
        self.data.point_data["Normals"] = ribbon.mesh.vertex_normals.astype(np.float32)
        self.data.point_data["Colour"] = np.full(ribbon.mesh.vertices.shape, 255, dtype=np.uint8)
        self.sight = Sight(self.data)
        self.actor = plotter.add_mesh(
            self.data,
            scalars="Colour",
            rgb=True,
            copy_mesh=False,
            name=name,
            reset_camera=False,
            render=False,
            ambient=0.42,
            diffuse=0.8,
            specular=0.14,
            specular_power=20,
        )
        self.actor.prop.interpolation = "Gouraud"
        self.data.point_data.active_normals_name = "Normals"

    def set_rank(self, rank: int) -> None:
        """Draw the ribbon over those of lower rank where they overlap; one is about 0.3 mm."""
        self.actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        self.actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -10.0 * rank)

    def paint(self, colour: str) -> None:
        """Give the ribbon its colour, with darker edges."""
        shade = np.tile(_SHADE, self.ribbon.rows)[:, None]
        self.data.point_data["Colour"][:] = np.round(shade * rgb(colour)).astype(np.uint8)

    def move(self, displacement: Points) -> None:
        """Follow the body: displacement of each body vertex, shape (n, 3) [mm]."""
        mesh = self.ribbon.mesh
        points = mesh.vertices + self.ribbon.follow @ displacement
        self.data.points[:] = points
        self.data.point_data["Normals"][:] = unit(self._sum_at_vertices @ area_vectors(points, mesh.faces))
        self.data.GetPoints().Modified()
        self.data.GetPointData().GetNormals().Modified()
        self.sight.forget()


class Bands:
    """All lines on one plotter, one of them selected and one under the pointer."""

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = plotter
        self._bands: dict[str, Band] = {}
        self._ribbons: dict[str, RibbonActor] = {}
        self._casings: dict[str, RibbonActor] = {}
        self._surface: Surface | None = None
        self._displacement: Points = np.zeros((0, 3))
        self._visible = True
        self.selected = ""
        self.hovered = ""

    def show(self, bands: Iterable[Band], surface: Surface) -> None:
        """Replace all ribbons by ``bands``, laid on the body at rest; the old selection stays if it can."""
        self.clear()
        self._surface = surface
        self._displacement = np.zeros_like(surface.mesh.vertices)
        self._bands = {band.name: band for band in bands}
        for name, band in self._bands.items():
            ribbon = build_ribbon(band.path, self._surface, band.width)
            self._ribbons[name] = RibbonActor(self._plotter, ribbon, f"band {name}")
            self._ribbons[name].paint(band.colour)
        self._show_what_is_asked()

    def clear(self) -> None:
        """Take all ribbons away."""
        for drawn in (*self._ribbons.values(), *self._casings.values()):
            self._plotter.remove_actor(drawn.actor, reset_camera=False, render=False)
        self._bands, self._ribbons, self._casings = {}, {}, {}

    def move(self, displacement: Points) -> None:
        """Follow the body: displacement of each body vertex, shape (n, 3) [mm]."""
        self._displacement = displacement
        for ribbon in self._ribbons.values():
            ribbon.move(displacement)
        for casing in self._casings.values():
            if casing.actor.GetVisibility():
                casing.move(displacement)

    def mark(self, selected: str, hovered: str) -> None:
        """Put a white casing round the selected band and a faint one round the band under the pointer."""
        self.selected, self.hovered = selected, hovered
        self._show_what_is_asked()

    def set_visible(self, visible: bool) -> None:
        """Show or hide all ribbons."""
        self._visible = visible
        self._show_what_is_asked()

    def hit(self, start: Floats, end: Floats) -> tuple[str, Floats] | None:
        """Return the first band on a segment and where it is met, or None."""
        met = {name: ribbon.sight.hit(start, end) for name, ribbon in self._ribbons.items() if self._visible}
        places = [(name, place) for name, place in met.items() if place is not None]
        return min(places, key=lambda each: float(np.linalg.norm(each[1] - start)), default=None)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the lines."""
        return tuple(self._bands)

    def colour(self, name: str) -> str:
        """Return the colour of a line, ``"#rrggbb"``."""
        return self._bands[name].colour

    def spine(self, name: str) -> tuple[Points, Points]:
        """Return the middle of the top of a ribbon as shown and its normals, both (rows, 3)."""
        data, width = self._ribbons[name].data, len(_ACROSS)
        grid = (
            np.asarray(part, dtype=np.float64).reshape(-1, width, 3)
            for part in (data.points, data["Normals"])
        )
        points, normals = (part[:, 3:5].mean(axis=1) for part in grid)
        return points, unit(normals)

    def _show_what_is_asked(self) -> None:
        for rank, (name, ribbon) in enumerate(self._ribbons.items()):
            ribbon.actor.SetVisibility(self._visible)
            ribbon.set_rank(len(self._ribbons) + 5 if name == self.selected else rank)
        for casing in self._casings.values():
            casing.actor.SetVisibility(False)
        for name, opacity in ((self.hovered, 0.4), (self.selected, 1.0)):
            if self._visible and name in self._bands:
                casing = self._casing(name)
                casing.set_rank(len(self._ribbons) + 5)
                casing.actor.prop.opacity = opacity
                casing.move(self._displacement)
                casing.actor.SetVisibility(True)

    def _casing(self, name: str) -> RibbonActor:
        """Return the casing of a band, built when it is first wanted."""
        if name not in self._casings:
            band = self._bands[name]
            assert self._surface is not None
            ribbon = build_casing(band.path, self._surface, band.width)
            casing = RibbonActor(self._plotter, ribbon, f"casing {name}")
            casing.actor.prop.lighting = False
            self._casings[name] = casing
        return self._casings[name]
