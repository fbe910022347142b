"""Ways out for a piece that its cloth cannot take, and the chart of darts: worked out beside the window."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, cast

import numpy as np
from PySide6.QtCore import QObject

from app.gui.session.jobs import Job
from app.i18n.catalog import tr
from app.presenters.messages import render
from app.presenters.pattern import piece_title
from core.document.block import Block
from core.errors import UserError
from core.pattern.dart_chart import Dart, DartChart
from core.pattern.garment import worn_skin
from core.pattern.remedies import Remedy, chart_of, remedies, with_dart
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.pattern.controller import PatternController


class WaysOut(QObject):
    """Works out ways out of the selected piece when they are asked for, and applies one of them."""

    def __init__(self, context: AppContext, controller: PatternController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        self._job: Job | None = None
        self._piece = ""
        self._found: tuple[Remedy, ...] = ()
        card = controller.panel.piece_card
        self._card = card
        card.ways_requested.connect(self.look_for)
        card.way_chosen.connect(self._apply)
        card.chart_requested.connect(self.draw_chart)
        card.dart_chosen.connect(self._show_dart)
        card.dart_requested.connect(self._add_dart)
        controller.selected.connect(self._follow)

    def look_for(self) -> None:
        """Try darts, cloths and one more seam for the selected piece."""
        result, piece = self._controller.result, self._controller.piece
        if result is None or not piece:
            return
        skin = worn_skin(result.request.frame.stages, result.request.frame.vertices)
        pattern, drawing = result.pattern, result.drawing

        def work(progress: Progress) -> object:
            return remedies(pattern, piece, drawing, skin, progress)

        self._begin(tr("Trying ways out…"), work, self._show)

    def draw_chart(self) -> None:
        """Try darts all round the selected piece, and draw what each leaves."""
        result, piece = self._controller.result, self._controller.piece
        if result is None or not piece:
            return
        pattern, drawing = result.pattern, result.drawing

        def work(progress: Progress) -> object:
            return chart_of(pattern, piece, drawing, progress)

        self._begin(tr("Trying darts…"), work, self._show_chart)

    def _begin(self, words: str, work: Callable[[Progress], object], done: Callable[[object], None]) -> None:
        self._context.jobs.cancel(self._job)
        self._piece = self._controller.piece
        self._card.show_ways((), words)
        self._job = self._context.jobs.run(words, work, done, self._fail, waited=True)

    def _fail(self, error: Exception) -> None:
        if isinstance(error, UserError):
            self._card.show_ways((), render(error.text))
        else:
            self._card.show_ways((), tr("Nothing was found."))
            self._context.notifications.error(error)

    def _show(self, found: object) -> None:
        self._found = cast(tuple[Remedy, ...], found)
        words = [render(each.message) for each in self._found]
        self._card.show_ways(words, "" if words else tr("No dart, cloth or seam leaves less strain."))

    def _apply(self, place: int) -> None:
        if place < len(self._found):
            remedy = self._found[place]
            self._take(remedy.block, render(remedy.message))

    # -- the chart

    def _show_chart(self, found: object) -> None:
        chart, result = cast(DartChart, found), self._controller.result
        if result is None:
            return
        cloth = next(p.cloth for p in result.pattern.garment.panels if p.name == chart.panel)
        self._card.show_ways(())
        self._card.show_chart(chart, result.pattern.cloths[cloth].limit)
        if chart.best is not None:
            self._show_dart(chart.best)

    def _show_dart(self, dart: object) -> None:
        shown = cast(Dart, dart)
        self._controller.layer.mark([np.stack([shown.start, shown.end])])

    def _add_dart(self, dart: object) -> None:
        result = self._controller.result
        if result is None:
            return
        try:
            block = with_dart(result.pattern, self._piece, cast(Dart, dart), result.drawing)
        except UserError as error:
            self._context.notifications.error(error, "pattern")
            return
        self._take(block, tr("Dart in {piece}").format(piece=piece_title(self._piece)))

    def _take(self, block: Block, text: str) -> None:
        self._controller.change(text, block=block)
        self._clear()

    def _follow(self) -> None:
        """Forget what was found for another piece or another shape."""
        if self._controller.piece != self._piece:
            self._clear()

    def _clear(self) -> None:
        self._context.jobs.cancel(self._job)
        self._piece, self._found = "", ()
        self._card.show_ways(())
        self._card.show_chart(None, 0.0)
        self._controller.layer.mark(())
