"""The section plane in the 3D view: a tinted sheet with its outline, and the curve where it cuts the body."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pyvista as pv

from app.rendering.camera import sheet_ends
from core.geometry.mesh import Floats, Points
from core.geometry.planar_curves import Curve, Plane

COLOURS = {False: "#2459CF", True: "#8DB0FF"}
"""Its colour in the light and in the dark theme: that of what is selected."""

SHEET, OUTLINE = 0.055, 0.55
"""How much of the colour sheet and outline have [1]."""

CURVE = 2.2
"""Width of the curve [px]."""

_NEARER = -60.0  # about 2 mm: the curve is drawn over the skin that it lies on


class SectionSheet:
    """The plane on one plotter; nothing is drawn until it is shown."""

    def __init__(self, plotter: pv.BasePlotter, ratio: float) -> None:
        self._sheet, self._rim, self._curve = pv.PolyData(), pv.PolyData(), pv.PolyData()
        options = {"lighting": False, "reset_camera": False, "render": False, "copy_mesh": False}
        for data in (self._sheet, self._rim, self._curve):
            _fill(data, np.zeros((2, 3)), [[0, 1]])
        self._actors = (
            plotter.add_mesh(self._sheet, name="section sheet", opacity=SHEET, **options),
            plotter.add_mesh(self._rim, name="section rim", opacity=OUTLINE, line_width=ratio, **options),
            plotter.add_mesh(self._curve, name="section curve", line_width=CURVE * ratio, **options),
        )
        mapper = self._actors[2].mapper
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, _NEARER)
        for actor in self._actors:
            actor.SetPickable(False)
        self.set_visible(False)

    def show(self, plane: Plane, low: Floats, high: Floats, curves: Sequence[Curve]) -> None:
        """Show a plane through the box from ``low`` to ``high``, each (3,) [mm], and the curves on it."""
        (left, bottom), (right, top) = sheet_ends(plane, low, high)
        quad = plane.in_space(np.array([[left, bottom], [right, bottom], [right, top], [left, top]]))
        _fill(self._sheet, quad, faces=[4, 0, 1, 2, 3])
        _fill(self._rim, quad, [[0, 1, 2, 3, 0]])
        points = [plane.in_space(curve.places) for curve in curves]
        starts = np.cumsum([0, *map(len, points)])
        chains = [np.arange(a, b) for a, b in pairwise(starts)]
        _fill(self._curve, np.concatenate([*points, np.zeros((1, 3))]), chains)
        self.set_visible(True)

    def set_visible(self, visible: bool) -> None:
        """Show or hide it."""
        for actor in self._actors:
            actor.SetVisibility(visible)

    @property
    def curve(self) -> Points:
        """Return the places of the curve that is drawn, shape (k, 3) [mm]."""
        return np.asarray(self._curve.points[:-1], dtype=np.float64)

    def set_dark(self, dark: bool) -> None:
        """Repaint for one theme."""
        for actor in self._actors:
            actor.prop.color = COLOURS[dark]


def _fill(
    data: pv.PolyData, points: Points, lines: Sequence[Sequence[int] | Floats] = (), faces: Sequence[int] = ()
) -> None:
    """Replace all that ``data`` holds."""
    data.points = points.astype(np.float32)
    if faces:
        data.faces = np.asarray(faces)
    else:
        data.lines = np.concatenate(
            [np.empty(0, dtype=np.int64), *([len(line), *line] for line in lines)]
        ).astype(np.int64)
    data.Modified()
