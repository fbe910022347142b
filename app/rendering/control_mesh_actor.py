"""The control mesh in the 3D view: thin edges on the skin and dots at the control points."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from app.rendering.appearance import Appearance
from app.rendering.ribbon_mesh import RibbonSurface
from core.geometry.mesh import Flags, Floats, Mesh, Points

LIFT = 1.3
"""How far edges lie above the skin [mm]."""

PIECES = 8
"""Pieces that an edge is laid on the skin with."""

_RADIUS = {True: 1.6, False: 2.3}  # of fixed and free control points [mm]


class ControlActor:
    """The control mesh on one plotter: shown once, then moved in place."""

    def __init__(
        self, plotter: pv.BasePlotter, control: Mesh, fixed: Flags, surface: RibbonSurface, ratio: float
    ) -> None:
        self._plotter = plotter
        self._edges = control.edges
        samples = self._straight(control.vertices).reshape(-1, 3)
        laid, up = surface.project(samples)
        self._lift = laid + LIFT * up - samples
        self._lines = pv.PolyData(samples.astype(np.float32), lines=self._chains())
        options = {"lighting": False, "copy_mesh": False, "reset_camera": False, "render": False}
        self._wire = plotter.add_mesh(
            self._lines, name="control edges", line_width=1.1 * ratio, opacity=0.45, **options
        )
        self._dots = {}
        ball = pv.Icosphere(radius=1.0, nsub=1)
        for kind, radius in _RADIUS.items():
            nodes = np.flatnonzero(fixed == kind)
            if len(nodes):
                shape = radius * np.asarray(ball.points)
                faces = ball.regular_faces[None] + len(shape) * np.arange(len(nodes))[:, None, None]
                points = np.zeros((len(nodes) * len(shape), 3), dtype=np.float32)
                data = pv.PolyData.from_regular_faces(points, faces.reshape(-1, 3))
                name = f"control points {'fixed' if kind else 'free'}"
                self._dots[kind] = (nodes, shape, data, plotter.add_mesh(data, name=name, **options))
        self._node_lift = LIFT * surface.project(control.vertices)[1]
        self.move(control.vertices)

    def set_appearance(self, look: Appearance) -> None:
        """Repaint for one theme."""
        self._wire.prop.color = look.wire
        for kind, (_, _, _, actor) in self._dots.items():
            actor.prop.color = look.wire if kind else "#FFFFFF"

    def move(self, points: Points) -> None:
        """Set the control points, shape (n, 3) [mm]; while hidden, only record them."""
        self._points = points
        if self._wire.GetVisibility():
            self._write(points)

    def set_visible(self, visible: bool) -> None:
        """Show or hide edges and dots."""
        for actor in self._actors:
            actor.SetVisibility(visible)
        if visible:
            self._write(self._points)

    def remove(self) -> None:
        """Remove the control mesh."""
        for actor in self._actors:
            self._plotter.remove_actor(actor, reset_camera=False, render=False)

    @property
    def _actors(self) -> list[pv.Actor]:
        return [self._wire, *(actor for *_, actor in self._dots.values())]

    def _write(self, points: Points) -> None:
        self._lines.points[:] = self._straight(points).reshape(-1, 3) + self._lift
        self._lines.GetPoints().Modified()
        for nodes, shape, data, _ in self._dots.values():
            centres = points[nodes] + self._node_lift[nodes]
            data.points[:] = (centres[:, None] + shape).reshape(-1, 3)
            data.GetPoints().Modified()

    def _straight(self, points: Points) -> Points:
        """Return points along the straight edges, shape (edges, PIECES + 1, 3)."""
        part: Floats = np.linspace(0.0, 1.0, PIECES + 1)[None, :, None]
        start, end = points[self._edges[:, 0], None], points[self._edges[:, 1], None]
        return np.asarray((1.0 - part) * start + part * end)

    def _chains(self) -> np.ndarray:
        """Return the cells of one chain of points an edge, in VTK's flat form."""
        count = PIECES + 1
        chains = np.arange(len(self._edges) * count).reshape(-1, count)
        return np.hstack([np.full((len(chains), 1), count), chains]).ravel()
