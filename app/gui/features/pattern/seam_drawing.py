"""A seam or dart is drawn on the body, from click to click; it divides the pieces that it runs through."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np
from PySide6.QtCore import QObject, QPointF

from app.gui.drawing_base import DrawingBase
from app.gui.session.jobs import Job
from app.gui.viewport.draw_card import DrawCard
from app.i18n.catalog import tr
from app.presenters.pattern import seam_title
from core.document.block import Block
from core.geometry.mesh import Points
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.pattern.controller import PatternController


class SeamDrawTool(QObject):
    """Draw a seam: ``begin``, clicks on the body, Enter; ends near another seam snap to it."""

    def __init__(self, context: AppContext, controller: PatternController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        self._sketching = DrawingBase(context, self, DrawCard(context.view))
        self._places: list[Points] = []
        self._curve: list[Points] = []
        self._job: Job | None = None
        self._sketching.hand.clicked.connect(self._click)
        self._sketching.connect_tool(self.finish, self.back, self.leave)
        controller.panel.draw_requested.connect(self.begin)

    @property
    def at_work(self) -> bool:
        """Return whether a seam is being drawn."""
        return self._sketching.at_work

    def begin(self) -> None:
        """Let a seam be drawn on the pieces that are shown."""
        frame = self._sketching.frame
        if frame is None or not self._controller.is_current():
            return
        self._context.navigation.start_tool()
        self._places, self._curve = [], []
        self._controller.select_piece("")
        self._controller.layer.hand.end()
        self._sketching.begin(frame)
        self._show()

    def back(self) -> None:
        """Remove the last point."""
        if self._places:
            self._places.pop()
            del self._curve[max(len(self._places) - 1, 0) :]
        self._show()

    def leave(self) -> None:
        """Stop drawing without changes."""
        if self.at_work:
            self._context.jobs.cancel(self._job)
            self._sketching.end()
            if self._controller.is_open:
                self._controller.layer.begin()

    def _click(self, spot: QPointF) -> None:
        result, place = self._controller.result, self._context.view.viewport.skin_at(spot)
        if result is None or place is None:
            return
        from core.pattern.seam_edits import snapped  # noqa: PLC0415 (takes 0.1 s to load)

        place = snapped(result.pattern.garment.curves, place)[0]
        if self._places:
            self._curve.append(result.drawing.path(self._places[-1], place))
        self._places.append(place)
        self._show()

    def _show(self) -> None:
        card = self._sketching.card
        card.keep.setEnabled(len(self._places) > 1)
        card.undo.setEnabled(bool(self._places))
        what = tr(
            "Click points on the body from one seam or edge to another to divide a piece. End within the "
            "piece for a dart."
        )
        keys = tr("Enter or double-click: finish · Backspace: undo step · Esc: cancel")
        card.say(tr("Draw seam or dart"), what, keys)
        curve = np.concatenate(self._curve) if self._curve else np.empty((0, 3))
        points = np.array(self._places).reshape(-1, 3)
        self._sketching.draw(curve, np.empty((0, 3)), points, "")

    def finish(self) -> None:
        """Divide the pieces by what was drawn, cut in the background first; a refusal keeps the drawing."""
        result, places = self._controller.result, np.array(self._places)
        if result is None or len(places) < 2 or self._job in self._context.jobs.at_work():
            return
        garment, drawing = result.pattern.garment, result.drawing

        def work(progress: Progress) -> object:
            from core.pattern.garment import cut_garment  # noqa: PLC0415 (takes 0.1 s to load)
            from core.pattern.seam_edits import with_drawn_seam  # noqa: PLC0415

            block = with_drawn_seam(drawing, garment, places)
            cut_garment(drawing, block, garment.is_bridged)
            return block

        take, refuse = partial(self._take, garment.block), self._refuse
        self._job = self._context.jobs.run(tr("Dividing pieces…"), work, take, refuse, waited=True)

    def _refuse(self, error: Exception) -> None:
        self._context.notifications.error(error, "pattern")

    def _take(self, former: Block, divided: object) -> None:
        block, plan = cast(Block, divided), self._controller.plan
        self.leave()
        if plan is None or plan.block != former:  # changed while the pieces were cut
            return
        name = seam_title(block.seams[-1].name)
        self._controller.change(tr("{seam} drawn").format(seam=name), block=block)
