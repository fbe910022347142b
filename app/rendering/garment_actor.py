"""A garment on the body: panels in the colours of their strain, seams, and what is selected of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyvista as pv

from app.rendering.actors import smooth_actor
from app.rendering.vertex_colors import Colours
from core.geometry.mesh import Faces, Mesh, Points

SEAM = {False: "#1C1B1A", True: "#F4F2EF"}
"""Colour of seams in the light and in the dark theme."""

SELECTED = {False: "#2459CF", True: "#8DB0FF"}
"""Colour of a selected seam and of its places."""

_OFF = 0.8  # how far cloth and seams are drawn off the skin [mm]
_THIN, _THICK = 1.6, 4.0  # a seam and a selected one [px]
_HANDLE, _KNOB = 3.4, 4.0  # radius of the points of a seam, and of the selected one [mm]
_NEARER = -60.0  # about 2 mm: seams are drawn over the cloth that they lie on


@dataclass(frozen=True, eq=False)
class GarmentDrawing:
    """What is drawn: ``points`` (n, 3) [mm], ``faces`` (m, 3) and ``colours`` (n, 3) of all panels together.

    ``seams`` are drawn thin and ``selected`` ones thick, each (k, 3) [mm]; ``handles`` (h, 3) [mm] are places
    that can be dragged, ``knob`` (k, 3) [mm] are the selected one and where a seam is walked.
    """

    points: Points
    faces: Faces
    colours: Colours
    seams: Sequence[Points]
    selected: Sequence[Points]
    handles: Points
    knob: Points


class GarmentActor:
    """A garment on one plotter; nothing is drawn until it is shown."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float = 1.0) -> None:
        self._plotter, self._ratio = plotter, pixel_ratio
        self._dark = False
        self._faces: Faces | None = None
        self._drawn: GarmentDrawing | None = None
        self._sheet: pv.PolyData | None = None
        self._names: list[str] = []

    @property
    def is_shown(self) -> bool:
        """Return whether there is a garment."""
        return bool(self._names)

    def show(self, drawn: GarmentDrawing) -> None:
        """Show a garment in place of the former one; cloth and seams of the same points and colours stay."""
        former, self._drawn = self._drawn, drawn
        same = former and former.points is drawn.points and former.colours is drawn.colours
        for name in self._names[2 if same else 1 :]:
            self._plotter.remove_actor(name, reset_camera=False, render=False)
        if same:
            self._names = self._names[:2]
        else:
            self._lay(drawn, Mesh(drawn.points, drawn.faces).vertex_normals)
            self._names = self._names[:1]
            self._lines("garment seams", drawn.seams, _THIN, SEAM[self._dark])
        self._lines("garment selected", drawn.selected, _THICK, SELECTED[self._dark])
        self._balls("garment handles", drawn.handles, "#FFFFFF", _HANDLE)
        self._balls("garment knob", drawn.knob, SELECTED[self._dark], _KNOB)

    def clear(self) -> None:
        """Remove the garment."""
        for name in self._names:
            self._plotter.remove_actor(name, reset_camera=False, render=False)
        self._names, self._faces, self._sheet, self._drawn = [], None, None, None

    def set_dark(self, dark: bool) -> None:
        """Paint for one theme from the next showing on."""
        self._dark, self._drawn = dark, None

    def _lay(self, drawn: GarmentDrawing, normals: Points) -> None:
        places = drawn.points + _OFF * normals
        if self._faces is not drawn.faces or self._sheet is None:
            look = {"ambient": 0.45, "diffuse": 0.6, "specular": 0.05}
            self._sheet, _ = smooth_actor(
                self._plotter, "garment cloth", places, normals, drawn.faces, **look
            )
            self._faces = drawn.faces
            self._names = ["garment cloth", *self._names[1:]]
        else:
            self._sheet.points[:] = places
            self._sheet.point_data["Normals"][:] = normals
            self._sheet.GetPoints().Modified()
        self._sheet.point_data["Colour"][:] = drawn.colours
        self._sheet.Modified()

    def _lines(self, name: str, curves: Sequence[Points], width: float, colour: str) -> None:
        curves = [curve for curve in curves if len(curve) > 1]
        if not curves:
            return
        starts = np.cumsum([0, *map(len, curves)])
        cells = [np.r_[len(c), np.arange(a, a + len(c))] for c, a in zip(curves, starts, strict=False)]
        data = pv.PolyData(np.concatenate(curves).astype(np.float32), lines=np.concatenate(cells))
        actor = self._add(name, data, color=colour, line_width=width * self._ratio)
        actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, _NEARER)

    def _balls(self, name: str, places: Points, colour: str, radius: float) -> None:
        if len(places):
            cloud = pv.PolyData(places.astype(np.float32))
            balls = cloud.glyph(geom=pv.Icosphere(radius=radius, nsub=2), orient=False, scale=False)
            self._add(name, balls, color=colour, lighting=True, ambient=0.55, smooth_shading=True)

    def _add(self, name: str, data: pv.PolyData, **look: object) -> pv.Actor:
        self._names.append(name)
        actor = self._plotter.add_mesh(
            data, name=name, reset_camera=False, render=False, **{"lighting": False, **look}
        )
        actor.SetPickable(False)
        return actor
