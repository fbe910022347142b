"""Antialiasing of a canvas: fast during motion, smooth outlines otherwise."""

from __future__ import annotations

import math

from app.gui.viewport.canvas import Canvas
from app.rendering.scene import Scene
from app.rendering.vertex_lighting import VertexLighting

FINEST = 2.5
"""Details of a large body that are smaller than so many pixels are not drawn without a graphics card."""


class Antialiasing:
    """Chooses filter, light and detail of one canvas."""

    def __init__(self, canvas: Canvas, scene: Scene) -> None:
        self._canvas, self._scene = canvas, scene
        self._light, self._filter = VertexLighting(scene.plotter), ""

    def use(self, kind: str) -> None:
        """Let outlines be smoothed by one of VTK's filters, or by none while things move."""
        if self._canvas.painted:
            self._light.use(quickly=not kind)
            self._canvas.hurry(not kind)
            self._draw_down_to(FINEST * self._pixel if kind else math.inf)
        if kind != self._filter:
            self._filter = kind
            if kind:
                self._scene.plotter.enable_anti_aliasing(kind)
            else:
                self._scene.plotter.disable_anti_aliasing()

    @property
    def _pixel(self) -> float:
        """Return the size of a pixel where the eye looks [mm]."""
        return 2.0 * self._scene.view.half_height / max(self._canvas.height(), 1)

    def _draw_down_to(self, finest: float) -> None:
        if self._scene.body is not None:
            self._scene.body.set_detail(finest)
