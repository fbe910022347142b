"""Common base of drawing on the body, lines as well as seams: pointer, sketch and card."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, QPointF, Signal

from app.gui.viewport.draw_card import DrawCard
from app.gui.viewport.drawing_tool import DrawingTool
from app.rendering.ribbon_mesh import RibbonSurface
from core.control_mesh.fit import ControlMesh
from core.geometry.mesh import Points
from core.pipeline.live_solver import Frame
from core.scan.body import Body

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.rendering.sketch_actor import SketchActor


_PIECES = 8  # pieces that the path from one control point to the next is laid on the skin with


def meshes_of(frame: Frame) -> dict[str, ControlMesh]:
    """Return the control meshes that lines are drawn on, by region."""
    return {region.fitted.region: region.fitted for region in frame.stages.regions}


class DrawingBase(QObject):
    """Takes places on the body at rest [mm], and draws them where they are on the shown one.

    ``lost`` tells that what was begun is on another body or control mesh than is shown, and is to end.
    """

    lost = Signal()

    def __init__(self, context: AppContext, owner: QObject, card: DrawCard) -> None:
        super().__init__(owner)
        self._context = context
        self._viewport = context.view.viewport
        viewport = context.view.viewport
        canvas = viewport.overlay.parentWidget()
        assert canvas is not None
        self.hand = DrawingTool(viewport, canvas)
        self.card = card
        context.view.place(self.card, "bottom-left")  # beside the body: lines go over its middle
        self._sketch: SketchActor | None = None
        self._surface: tuple[Body, RibbonSurface] | None = None
        self._drawn: tuple[Points, Points, Points, str] | None = None
        self._meshes: tuple[ControlMesh, ...] = ()
        context.session.frame_ready.connect(self._follow)
        viewport.view_changed.connect(self._look)
        context.session.design_changed.connect(self._check)

    def connect_tool(
        self, keep: Callable[[], object], back: Callable[[], object], leave: Callable[[], object]
    ) -> None:
        """Connect keys and buttons: ``keep`` what is drawn, one step ``back``, ``leave`` without changes."""
        requests = {"keep": keep, "back": back, "leave": leave}
        self.hand.requested.connect(lambda request: requests[request]())
        self.card.accepted.connect(keep)
        self.card.back.connect(back)
        for signal in (self.card.closed, self.lost, self._context.navigation.tool_started):
            signal.connect(leave)

    @property
    def at_work(self) -> bool:
        """Return whether something is being drawn."""
        return self.hand.at_work

    @property
    def frame(self) -> Frame | None:
        """Return the shown frame, if it is of the present design's control mesh."""
        frame, design = self._context.session.frame, self._context.session.design
        same = frame is not None and design is not None and frame.stages.design.template == design.template
        return frame if same else None

    def begin(self, frame: Frame) -> None:
        """Take the pointer, and show the card."""
        self._meshes = tuple(meshes_of(frame).values())
        self.hand.begin()
        self.card.show()

    def end(self) -> None:
        """Restore the pointer, and remove all drawing items."""
        if self.at_work:
            self.hand.end()
            self.card.hide()
            self._drawn, self._meshes = None, ()
            if self._sketch is not None:
                self._sketch.clear()
            self._viewport.request_draw()

    def draw(self, curve: Points, path: Points, points: Points, colour: str) -> None:
        """Draw a curve (k, 3), a path (p, 3) in ``colour`` and points (n, 3) to hold; each may be empty."""
        self._drawn = curve, path, points, colour
        scene = self._viewport.scene
        if self._sketch is None:
            from app.rendering.sketch_actor import SketchActor  # noqa: PLC0415 (brings VTK along)

            self._sketch = SketchActor(scene.plotter)
        there = [scene.carried_points(part) if len(part) else part for part in (curve, path, points)]
        self._sketch.show(there[0], there[1], there[2], colour)
        self._sketch.look_from(scene.view)
        self._viewport.request_draw()

    def laid(self, corners: Points) -> Points:
        """Return the way through control points, shape (c, 3), on the skin at rest, shape (k, 3) [mm]."""
        frame = self._context.session.frame
        if frame is None or len(corners) < 2:
            return corners
        body = frame.stages.body
        if self._surface is None or self._surface[0] is not body:
            self._surface = body, RibbonSurface(body.mesh)
        part = np.arange(_PIECES)[:, None] / _PIECES
        pieces = [start + part * (end - start) for start, end in pairwise(corners)]
        return self._surface[1].project(np.concatenate([*pieces, corners[-1:]]))[0]

    def nearest(self, points: Points, at: QPointF, reach: float) -> int:
        """Return which of ``points`` (n, 3) is seen nearest to a pixel, -1 if none within ``reach`` [px].

        Points behind the body are not seen.
        """
        scene, overlay = self._viewport.scene, self._viewport.overlay
        shown = scene.carried_points(points)
        spots = scene.view.to_picture(shown, overlay.width(), overlay.height())
        away = np.hypot(spots[:, 0] - at.x(), spots[:, 1] - at.y())
        for place in np.argsort(away):
            if away[place] > reach:
                break
            if not scene.hidden(shown[place]):
                return int(place)
        return -1

    def _look(self) -> None:
        if self.at_work and self._sketch is not None:
            self._sketch.look_from(self._viewport.view)

    def _check(self, _: object) -> None:
        """Let go once a control mesh is another: there its points have other numbers and places."""
        if not self.at_work:
            return
        meshes = () if self.frame is None else tuple(meshes_of(self.frame).values())
        if [id(each) for each in meshes] != [id(each) for each in self._meshes]:
            self.lost.emit()

    def _follow(self, _: object) -> None:
        """Stay on the body while it moves."""
        self._check(_)
        if self.at_work and self._drawn is not None:
            self.draw(*self._drawn)
