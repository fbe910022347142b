"""Fixes for a piece that exceeds the limit of its cloth, and its dart chart: computed in the background."""

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
from core.document.garment_pattern import GarmentPattern
from core.errors import UserError
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.pattern.controller import PatternController
    from core.pattern.dart_chart import Dart, DartChart
    from core.pattern.piece_fixes import PieceFix


class PieceFixes(QObject):
    """Computes fixes and the dart chart of the selected piece on request, and applies a fix."""

    def __init__(self, context: AppContext, controller: PatternController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        self._job: Job | None = None
        self._piece = ""
        self._plan: GarmentPattern | None = None
        self._found: tuple[PieceFix, ...] = ()
        card = controller.panel.piece_card
        self._card = card
        card.fixes_requested.connect(self.suggest)
        card.fix_chosen.connect(self._apply)
        card.chart_requested.connect(self.draw_chart)
        card.dart_chosen.connect(self._show_dart)
        card.dart_requested.connect(self._add_dart)
        controller.selected.connect(self._follow)
        context.session.design_changed.connect(lambda _: self._follow())

    def suggest(self) -> None:
        """Compute fixes for the selected piece."""
        result, piece = self._controller.result, self._controller.piece
        if result is None or not piece:
            return
        frame, pattern, drawing = result.request.frame, result.pattern, result.drawing

        def work(progress: Progress) -> object:
            from core.pattern.garment import worn_skin  # noqa: PLC0415 (takes 0.1 s to load)
            from core.pattern.piece_fixes import piece_fixes  # noqa: PLC0415

            skin = worn_skin(frame.stages, frame.vertices)
            return piece_fixes(pattern, piece, drawing, skin, progress)

        self._begin(tr("Computing fixes…"), work, self._show)

    def draw_chart(self) -> None:
        """Compute the dart chart of the selected piece."""
        result, piece = self._controller.result, self._controller.piece
        if result is None or not piece:
            return
        pattern, drawing = result.pattern, result.drawing

        def work(progress: Progress) -> object:
            from core.pattern.piece_fixes import chart_of  # noqa: PLC0415 (takes 0.1 s to load)

            return chart_of(pattern, piece, drawing, progress)

        self._begin(tr("Computing dart chart…"), work, self._show_chart)

    def _begin(self, words: str, work: Callable[[Progress], object], done: Callable[[object], None]) -> None:
        self._context.jobs.cancel(self._job)
        self._piece, self._plan = self._controller.piece, self._controller.plan
        self._card.show_fixes((), words)
        self._job = self._context.jobs.run(words, work, done, self._fail, waited=True)

    def _fail(self, error: Exception) -> None:
        if isinstance(error, UserError):
            self._card.show_fixes((), render(error.text))
        else:
            self._card.show_fixes((), tr("The computation failed."))
            self._context.notifications.error(error)

    def _show(self, found: object) -> None:
        self._found = cast("tuple[PieceFix, ...]", found)
        words = [render(each.message) for each in self._found]
        self._card.show_fixes(words, "" if words else tr("No dart, cloth or seam reduces the strain."))

    def _apply(self, place: int) -> None:
        if place < len(self._found):
            fix = self._found[place]
            self._take(fix.block, render(fix.message))

    # -- the chart

    def _show_chart(self, found: object) -> None:
        chart, result = cast("DartChart", found), self._controller.result
        if result is None:
            return
        cloth = next((p.cloth for p in result.pattern.garment.panels if p.name == chart.panel), None)
        if cloth is None:
            return
        self._card.show_fixes(())
        self._card.show_chart(chart, result.pattern.cloths[cloth].limit)
        if chart.best is not None:
            self._show_dart(chart.best)

    def _show_dart(self, dart: object) -> None:
        shown = cast("Dart", dart)
        self._controller.layer.mark([np.stack([shown.start, shown.end])])

    def _add_dart(self, dart: object) -> None:
        result = self._controller.result
        if result is None:
            return
        from core.pattern.piece_fixes import with_dart  # noqa: PLC0415 (takes 0.1 s to load)

        try:
            block = with_dart(result.pattern, self._piece, cast("Dart", dart), result.drawing)
        except UserError as error:
            self._context.notifications.error(error, "pattern")
            return
        self._take(block, tr("Dart in {piece}").format(piece=piece_title(self._piece)))

    def _take(self, block: Block, text: str) -> None:
        self._controller.change(text, block=block)
        self._clear()

    def _follow(self) -> None:
        """Clear the fixes of another piece or plan."""
        other = self._controller.piece != self._piece or self._controller.plan is not self._plan
        if self._piece and other:
            self._clear()

    def _clear(self) -> None:
        self._context.jobs.cancel(self._job)
        self._piece, self._found = "", ()
        self._card.show_fixes(())
        self._card.show_chart(None, 0.0)
        self._controller.layer.mark(())
