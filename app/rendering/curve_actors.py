"""Curves on the skin: the one that a landmark was read from, those that show a measure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyvista as pv

from core.geometry.mesh import Points

RADIUS = 1.5
"""Half the thickness of a curve [mm]."""

FAINT = 0.3
"""How opaque the hidden part of a curve is where it shines through the body."""

COLOURS = {False: "#2459CF", True: "#8DB0FF"}
"""Their colour in the light and in the dark theme: that of what is selected."""


class Trace:
    """Curves of one ``name`` on one plotter; without points there are none.

    ``through`` lets what the body hides of them shine through it, opaque to that share [1]. They are
    ``radius`` [mm] thick to each side.
    """

    def __init__(
        self, plotter: pv.BasePlotter, name: str = "trace", through: float = 0.0, radius: float = RADIUS
    ) -> None:
        self._plotter, self._name, self._through, self._radius = plotter, name, through, radius
        self._dark = False
        self._actors: list[pv.Actor] = []

    @property
    def shown(self) -> bool:
        """Return whether there is a curve."""
        return bool(self._actors)

    def show(self, *curves: Points) -> None:
        """Draw curves, each of shape (k, 3) [mm], in place of the former ones."""
        for actor in self._actors:
            self._plotter.remove_actor(actor, reset_camera=False, render=False)
        self._actors = []
        tubes = [tube for curve in curves if (tube := _tube(curve, self._radius)) is not None]
        if not tubes:
            return
        whole = tubes[0].append_polydata(*tubes[1:])
        self._draw(whole, self._name)
        if self._through:
            faint = self._draw(whole, f"{self._name} through")
            faint.prop.opacity = self._through
            faint.mapper.SetResolveCoincidentTopologyToPolygonOffset()
            faint.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -66000.0)

    def _draw(self, tube: pv.PolyData, name: str) -> pv.Actor:
        actor = self._plotter.add_mesh(
            tube, name=name, lighting=False, color=COLOURS[self._dark], reset_camera=False, render=False
        )
        self._actors.append(actor)
        return actor

    def set_dark(self, dark: bool) -> None:
        """Repaint for one theme."""
        self._dark = dark
        for actor in self._actors:
            actor.prop.color = COLOURS[dark]


class MeasureTrace(Trace):
    """The curves that show a measure, on the body at rest or as it is worn; what is hidden shines through."""

    def __init__(self, plotter: pv.BasePlotter) -> None:
        super().__init__(plotter, "measure", through=FAINT)
        self._both: tuple[Sequence[Points], Sequence[Points]] = ((), ())
        self._before = False

    def show_both(self, rest: Sequence[Points], worn: Sequence[Points]) -> None:
        """Draw the curves, each (k, 3) [mm], that belong to the shown body."""
        self._both = rest, worn
        self.show(*self._both[0 if self._before else 1])

    def before(self, shown: bool) -> None:
        """Show those of the body at rest, or those of the worn one."""
        self._before = shown
        self.show_both(*self._both)

    @property
    def points(self) -> Points:
        """Return all points of the drawn curves, shape (k, 3) [mm]."""
        return np.concatenate([np.empty((0, 3)), *self._both[0 if self._before else 1]])


def _tube(points: Points, radius: float) -> pv.PolyData | None:
    """Return a tube along points, shape (k, 3) [mm], if they lead anywhere."""
    if len(points) < 2:
        return None
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    whole = points[np.concatenate([[True], steps > 1e-6])]  # VTK's tube needs a direction everywhere
    if len(whole) < 2:
        return None
    return pv.lines_from_points(whole.astype(np.float32)).tube(radius=radius, n_sides=8)
