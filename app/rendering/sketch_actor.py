"""A line while it is drawn or led elsewhere: its curve, its path of control points, points to hold."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from app.rendering.camera import View
from core.geometry.mesh import Points

CURVE, PATH = 1.3, 2.6
"""Half the thickness of the drawn curve and of the path [mm]."""

POINT = 4.0
"""Radius of a point [mm]."""

INK = "#2459CF"
"""Colour of what is being drawn, in both themes."""

_NEARER = 0.99  # how far from the eye the sketch is drawn, so that no band covers it


class SketchActor:
    """Draws on one plotter; what is given replaces what was there."""

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = plotter
        self._actors: dict[str, pv.Actor] = {}

    def show(self, curve: Points, path: Points, points: Points, colour: str) -> None:
        """Draw a curve (k, 3), a path (p, 3) in its ``colour`` and points (n, 3) [mm]; each may be empty."""
        for name in self._actors:
            self._plotter.remove_actor(name, reset_camera=False, render=False)
        self._actors = {}
        self._tube("sketch path", path, PATH, colour)
        self._tube("sketch curve", curve, CURVE, INK)
        if len(points):
            ball = pv.Icosphere(radius=POINT, nsub=2)
            cloud = pv.PolyData(points.astype(np.float32))
            balls = cloud.glyph(geom=ball, orient=False, scale=False)
            self._add("sketch points", balls, "#FFFFFF")

    def look_from(self, view: View) -> None:
        """Keep before the bands for this eye: it shrinks about the eye, so it looks as large as before."""
        matrix = np.eye(4)
        if view.parallel:
            matrix[:3, 3] = (1.0 - _NEARER) * view.distance * view.axes[2]
        else:
            matrix[:3, :3] *= _NEARER
            matrix[:3, 3] = (1.0 - _NEARER) * view.eye
        for actor in self._actors.values():
            actor.user_matrix = matrix

    def clear(self) -> None:
        """Remove everything."""
        none = np.empty((0, 3))
        self.show(none, none, none, INK)

    def _tube(self, name: str, points: Points, radius: float, colour: str) -> None:
        if len(points) > 1:
            apart = np.r_[True, np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-6]
            points = points[apart]  # VTK's tube needs a direction everywhere
        if len(points) > 1:
            tube = pv.lines_from_points(points.astype(np.float32)).tube(radius=radius, n_sides=8)
            self._add(name, tube, colour)

    def _add(self, name: str, mesh: pv.PolyData, colour: str) -> None:
        self._actors[name] = self._plotter.add_mesh(
            mesh, name=name, color=colour, ambient=0.5, diffuse=0.6, reset_camera=False, render=False
        )
