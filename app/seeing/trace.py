"""The curve that a landmark was read from, drawn on the skin."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from core.mesh import Points

RADIUS = 1.5
"""Half the thickness of the curve [mm]."""

COLOURS = {False: "#2459CF", True: "#8DB0FF"}
"""Its colour in the light and in the dark theme: that of what is selected."""


class Trace:
    """One curve on one plotter; without points there is none."""

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = plotter
        self._dark = False
        self._actor: pv.Actor | None = None

    @property
    def shown(self) -> bool:
        """Whether there is a curve."""
        return self._actor is not None

    def show(self, points: Points) -> None:
        """Draw a curve through ``points``, shape (k, 3) [mm], in place of the former one."""
        self._plotter.remove_actor("trace", reset_camera=False, render=False)
        self._actor = None
        if len(points) < 2:
            return
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        whole = points[np.concatenate([[True], steps > 1e-6])]  # VTK's tube needs a direction everywhere
        if len(whole) < 2:
            return
        tube = pv.lines_from_points(whole.astype(np.float32)).tube(radius=RADIUS, n_sides=8)
        self._actor = self._plotter.add_mesh(
            tube, name="trace", lighting=False, color=COLOURS[self._dark], reset_camera=False, render=False
        )

    def set_dark(self, dark: bool) -> None:
        """Repaint for one theme."""
        self._dark = dark
        if self._actor is not None:
            self._actor.prop.color = COLOURS[dark]
