"""Lines drawn as puffed elastic ribbons that move with the body, one of them selected."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np
import pyvista as pv
from vtkmodules.util.numpy_support import vtk_to_numpy

from app.rendering.actors import RayPicker, smooth_actor
from app.rendering.appearance import rgb
from app.rendering.band import Band, Rise
from app.rendering.ribbon_mesh import Ribbon, RibbonSurface, rimmed
from core.deformation.incremental_normals import moving_faces
from core.geometry.mesh import Flags, Floats, Points, unit

_SHADE = (0.62, 0.62, 0.86)  # how dark the rim of a band is, from outside
_SEAM = 0.72  # how dark the seam is where front part and back part meet
_FAINT, _FAINT_CASING = 0.3, 0.2  # how much is seen of a faded band and of the casing round it
_QUIET, _CLOTH = 0.45, "#F2ECE6"  # the back part keeps its length: its colour steps back towards plain cloth


class RibbonActor:
    """One ribbon on a plotter, ``dashed`` or not; a sight meets the whole ribbon."""

    def __init__(self, plotter: pv.BasePlotter, ribbon: Ribbon, name: str, dashed: bool = False) -> None:
        self.ribbon = ribbon
        self._raised = np.zeros_like(ribbon.mesh.vertices)
        self._moving = moving_faces(ribbon.mesh, np.empty(0, dtype=np.int64))
        mesh = ribbon.mesh
        self.data, self.actor = smooth_actor(
            plotter,
            name,
            mesh.vertices,
            mesh.vertex_normals,
            ribbon.dashes if dashed else mesh.faces,
            ambient=0.42,
            diffuse=0.8,
            specular=0.14,
            specular_power=20,
        )
        whole = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces) if dashed else self.data
        whole.SetPoints(self.data.GetPoints())
        self.sight = RayPicker(whole)
        # Plain views of what is drawn: pyvista looks its own up by name each time.
        self._places = vtk_to_numpy(self.data.GetPoints().GetData())
        self._normals = vtk_to_numpy(self.data.GetPointData().GetNormals())

    def set_rank(self, rank: int) -> None:
        """Draw the ribbon over those of lower rank where they overlap; one is about 0.3 mm."""
        self.actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        self.actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -10.0 * rank)

    def paint(self, colour: str) -> None:
        """Set the colour of the ribbon, with darker edges; paler on the back, with seams at its ends."""
        back = self.ribbon.part < 0
        seam = back & ~(np.roll(back, 1) & np.roll(back, -1))
        rows = rgb(colour) + _QUIET * back[:, None] * (rgb(_CLOTH) - rgb(colour))
        self.paint_rows(np.where(seam[:, None], _SEAM * rgb(colour), rows))

    def paint_rows(self, rows: Floats) -> None:
        """Set the colour of each row, shape (rows, 3) 0..255."""
        colours = rimmed(_SHADE, self.ribbon.columns)[:, None] * rows[:, None]
        self.data.point_data["Colour"][:] = np.round(colours.reshape(-1, 3))
        self.data.GetPointData().GetArray("Colour").Modified()

    def move(self, displacement: Points) -> None:
        """Move with the body: displacement of each body vertex, shape (n, 3) [mm]."""
        shift = self.ribbon.follow @ displacement + self._raised
        known = self._moving.vertices[: self._moving.count]
        moved: Flags = np.asarray(shift.any(axis=1))
        moved[known] = True
        if np.count_nonzero(moved) > len(known):
            # What has moved once is followed from now on, back to where it rests as well.
            self._moving = moving_faces(self.ribbon.mesh, np.flatnonzero(moved))
        rows = self._moving.vertices
        places = self._moving.rest + shift[rows]
        self._places[rows], self._normals[rows] = places, self._moving.normals(places)
        self.data.GetPoints().Modified()
        self.data.GetPointData().GetNormals().Modified()
        self.sight.clear()

    def raise_to(self, off: Rise | None) -> bool:
        """Raise the ribbon off the skin from its next move on; returns whether that changes it.

        ``off`` gives that for places along the line, 0 to 1; None lets it lie as it was laid.
        """
        rows = np.zeros_like(self.ribbon.lifted) if off is None else off(self.ribbon.at) - self.ribbon.lifted
        raised = np.repeat(rows, self.ribbon.columns, axis=0)
        changed = not np.array_equal(raised, self._raised)
        self._raised = raised
        return changed

    def spine(self) -> tuple[Points, Points]:
        """Return the middle of the top of the ribbon as shown and its normals, both (rows, 3)."""
        middle = self.ribbon.columns // 2
        points, normals = (
            part.reshape(self.ribbon.rows, -1, 3)[:, middle - 1 : middle + 1].mean(axis=1, dtype=np.float64)
            for part in (self._places, self._normals)
        )
        return points, unit(normals)


class Bands:
    """All lines on one plotter, one of them selected and one under the pointer."""

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = plotter
        self._bands: dict[str, Band] = {}
        self._ribbons: dict[str, RibbonActor] = {}
        self._casings: dict[str, RibbonActor] = {}
        self._rises: dict[str, Rise] = {}
        self._surface: RibbonSurface | None = None
        self._displacement: Points = np.zeros((0, 3))
        self._visible = True
        self._faded = False
        self.selected = ""
        self.hovered = ""

    def show(self, bands: Iterable[Band], surface: RibbonSurface) -> None:
        """Replace all ribbons by ``bands``, laid on the body at rest; the old selection stays if it can."""
        self.clear()
        self._surface = surface
        self._displacement = np.zeros(surface.mesh.vertices.shape)
        self._bands = {band.name: band for band in bands}
        for name, band in self._bands.items():
            ribbon = surface.ribbon(band.route, band.width)
            # A wider one under it bulges further round a nipple: it would stand through.
            wider = [
                drawn.ribbon for each, drawn in self._ribbons.items() if self._bands[each].width > band.width
            ]
            over = ribbon.over(wider)
            self._ribbons[name] = RibbonActor(self._plotter, over, f"band {name}", dashed=band.off)
            self._ribbons[name].paint(band.colour)
        self._show_what_is_asked()

    def clear(self) -> None:
        """Remove all ribbons."""
        for drawn in (*self._ribbons.values(), *self._casings.values()):
            self._plotter.remove_actor(drawn.actor, reset_camera=False, render=False)
        self._bands, self._ribbons, self._casings, self._rises = {}, {}, {}, {}

    def paint(self, colours: Mapping[str, Floats] | None, blank: str = "") -> None:
        """Colour each row of the lines' bands, shape (rows, 3) 0..255, and ``blank`` what has no colours.

        None gives the lines their own colours back.
        """
        for name, ribbon in self._ribbons.items():
            if colours is None:
                ribbon.paint(self._bands[name].colour)
            else:
                ribbon.paint_rows(colours.get(name, np.tile(rgb(blank), (ribbon.ribbon.rows, 1))))

    def raise_to(self, off: Mapping[str, Rise]) -> None:
        """Raise bands off the skin, by line: (rows,) places along it, 0 to 1, give (rows, 3) [mm].

        A line that is not named lies as it was laid.
        """
        self._rises = dict(off)
        for name, ribbon in self._ribbons.items():
            if ribbon.raise_to(self._rises.get(name)):
                ribbon.move(self._displacement)
        for name, casing in self._casings.items():
            if casing.raise_to(self._rises.get(name)) and casing.actor.GetVisibility():
                casing.move(self._displacement)

    def move(self, displacement: Points) -> None:
        """Move with the body: displacement of each body vertex, shape (n, 3) [mm]."""
        self._displacement = displacement
        for ribbon in self._ribbons.values():
            ribbon.move(displacement)
        for casing in self._casings.values():
            if casing.actor.GetVisibility():
                casing.move(displacement)

    def mark(self, selected: str, hovered: str) -> None:
        """Draw a white casing round the selected band and a faint one round the band under the pointer."""
        self.selected, self.hovered = selected, hovered
        self._show_what_is_asked()

    def set_visible(self, visible: bool) -> None:
        """Show or hide all ribbons."""
        self._visible = visible
        self._show_what_is_asked()

    def fade(self, faded: bool) -> None:
        """Let the skin under the ribbons be seen through them, or show them as they are."""
        if faded != self._faded:
            self._faded = faded
            self._show_what_is_asked()

    def hit(self, start: Floats, end: Floats) -> tuple[str, Floats] | None:
        """Return the first band on a segment and where it is met, or None."""
        met = {name: ribbon.sight.hit(start, end) for name, ribbon in self._ribbons.items() if self._visible}
        places = [(name, place) for name, place in met.items() if place is not None]
        return min(places, key=lambda each: float(np.linalg.norm(each[1] - start)), default=None)

    @property
    def names(self) -> tuple[str, ...]:
        """Return names of the lines."""
        return tuple(self._bands)

    def colour(self, name: str) -> str:
        """Return the colour of a line, ``"#rrggbb"``."""
        return self._bands[name].colour

    def ribbon(self, name: str) -> Ribbon:
        """Return the ribbon of a line as it was laid."""
        return self._ribbons[name].ribbon

    def spine(self, name: str) -> tuple[Points, Points]:
        """Return the middle of the top of a ribbon as shown and its normals, both (rows, 3)."""
        return self._ribbons[name].spine()

    def _show_what_is_asked(self) -> None:
        for rank, (name, ribbon) in enumerate(self._ribbons.items()):
            ribbon.actor.SetVisibility(self._visible)
            ribbon.actor.prop.opacity = _FAINT if self._faded else 1.0
            ribbon.set_rank(len(self._ribbons) + 5 if name == self.selected else rank)
        for casing in self._casings.values():
            casing.actor.SetVisibility(False)
        for name, opacity in ((self.hovered, 0.4), (self.selected, 1.0)):
            if self._visible and name in self._bands:
                casing = self._casing(name)
                casing.set_rank(len(self._ribbons) + 5)
                casing.actor.prop.opacity = opacity * (_FAINT_CASING if self._faded else 1.0)
                casing.move(self._displacement)
                casing.actor.SetVisibility(True)

    def _casing(self, name: str) -> RibbonActor:
        """Return the casing of a band, built when it is first wanted."""
        if name not in self._casings:
            band = self._bands[name]
            assert self._surface is not None
            ribbon = self._surface.ribbon(band.route, band.width, cased=True)
            casing = RibbonActor(self._plotter, ribbon.under(self.ribbon(name)), f"casing {name}")
            casing.actor.prop.lighting = False
            casing.raise_to(self._rises.get(name))
            self._casings[name] = casing
        return self._casings[name]
