"""The desk of ±: how far the figures of a settled design may be off, worked out for who looks at them."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject, QTimer, Signal

from app.gui.features.measurements.panel import ResultPanel
from app.gui.features.uncertainty.card import SpreadCard
from app.gui.session.jobs import Job
from app.i18n.catalog import joined, say, tr
from app.presenters.status import doubt_of, not_computed
from app.presenters.uncertainty import left_out_sentences, source_sentences, spread_view
from core.analysis.uncertainty.estimate import Spreading
from core.analysis.uncertainty.perturbed_solutions import Trials
from core.document.design import Design
from core.errors import UserError
from core.export.report_data import Sheet, with_spread
from core.measurements.uncertain_value import Spread
from core.pipeline.live_solver import Frame
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow

PAUSE = 600
"""So long a design must rest before the work begins: who tries lengths is not to share the processor [ms]."""

KEPT = 12
"""Designs whose ± is kept, so that undone steps and other variants show theirs at once."""


class SpreadDesk(QObject):
    """Keeps how far the figures of designs may be off, and tells below the measures what that means.

    ``found`` says that there is more of it, or less.
    """

    found = Signal()

    def __init__(self, window: MainWindow, panel: ResultPanel) -> None:
        super().__init__(window)
        self._window, self._panel = window, panel
        self.card = SpreadCard(source_sentences(), left_out_sentences())
        panel.feet.addWidget(self.card)
        panel.sure.clicked.connect(lambda: panel.bring(self.card))
        self._known: dict[Design, Spread] = {}
        self._last: Spread | None = None
        self._trials: Trials | None = None
        self._body: object = None
        self._job: Job | None = None
        self._asked: Design | None = None
        self._given_up: tuple[Design, str] | None = None  # and why, where that is known
        self._clock = QTimer(self, interval=PAUSE, singleShot=True)
        self._clock.timeout.connect(self._begin)
        panel.opened.connect(self.follow)
        self.found.connect(self._show)

    @property
    def shown(self) -> tuple[Spread | None, bool]:
        """What is known of the design that is shown, else of the last one, and whether that is faint."""
        frame = self._window.session.frame
        known = None if frame is None else self.of(frame)
        if known is not None:
            return known, False
        comes = frame is not None and not doubt_of(frame) and self._why_not(frame.stages.design) is None
        return (self._last if comes else None), True

    def of(self, frame: Frame) -> Spread | None:
        """Return how far the figures of a frame may be off, if that is known and it is a result."""
        return None if frame.at_work or doubt_of(frame) else self._known.get(frame.stages.design)

    def on_sheet(self, sheet: Sheet, frame: Frame | None, whole: Frame | None) -> Sheet:
        """Return the sheet of a frame, made of ``whole``, with its ± once all of that is known."""
        spread = None if frame is None else self.of(frame)
        if spread is None or whole is None or sheet.off:
            return sheet
        return with_spread(sheet, whole.stages, whole.control_points, spread)

    def follow(self) -> None:
        """Begin with a design once it rests; whatever is edited meanwhile ends that."""
        frame, design = self._window.session.frame, self._window.session.design
        if frame is None or design is None:
            return
        if frame.stages.body is not self._body:
            self._body, self._last, self._trials = frame.stages.body, None, None
            self._known.clear()
        if self._asked is not None and self._asked is not design:
            self._window.jobs.cancel(self._job)
            self._job = self._asked = None
        missing = design not in self._known
        if not (self._looked_at and self._window.session.is_converged and not doubt_of(frame)):
            self._clock.stop()
        elif missing and self._asked is None and self._why_not(design) is None:
            self._clock.start()
        self.found.emit()

    @property
    def _looked_at(self) -> bool:
        window = self._window
        return self._panel.isVisible() or window.section_desk.is_on or window.report_desk.is_open

    def _begin(self) -> None:
        """Compute the ± by all sources: without the landmarks, which are slow, it would be too small."""
        frame = self._window.session.frame
        if frame is None or not self._window.session.is_converged or self._asked is not None:
            return
        self._asked, stages, former = frame.stages.design, frame.stages, self._trials

        def work(progress: Progress) -> tuple[Trials, Spread]:
            trials = Trials(stages, former)
            return trials, Spreading(trials).whole(progress)

        said = tr("Working out how sure the figures are")
        self._job = self._window.jobs.run(said, work, self._end, self._fail, left=self._leave_off)

    def _end(self, found: object) -> None:
        self._trials, spread = cast(tuple[Trials, Spread], found)
        self._job = self._asked = None
        self._keep(self._trials.base.design, spread)

    def _keep(self, design: Design, spread: Spread) -> None:
        self._known[design] = self._last = spread
        while len(self._known) > KEPT:
            del self._known[next(iter(self._known))]
        self.found.emit()

    def _fail(self, error: Exception) -> None:
        logging.error("how sure figures are was not found", exc_info=error)
        self._give_up(say(error.message) if isinstance(error, UserError) else "")

    def _leave_off(self) -> None:
        self._give_up("")

    def _give_up(self, why: str) -> None:
        """Tell no ± of a design."""
        if self._asked is not None:
            self._given_up = self._asked, why
        self._job = self._asked = None
        self.found.emit()

    def _why_not(self, design: Design) -> str | None:
        """Return why there will be no ± of a design, None if it was not given up."""
        return self._given_up[1] if self._given_up is not None and self._given_up[0] is design else None

    def _show(self) -> None:
        """Tell below the measures what the ± means, or why there is none."""
        frame = self._window.session.frame
        if frame is None or not self._panel.isVisible():
            return
        spread, faint = self.shown
        design, waiting = self._window.session.design, ""
        if design is not None and (why := self._why_not(design)) is not None:
            waiting = joined((tr("How far they may be off was not worked out."), why))
        if self._window.session.failure is not None:
            waiting = not_computed()
        waiting = waiting or tr("How far they may be off is worked out once the run rests.")
        view = spread_view(spread, "" if doubt_of(frame) else waiting, faint)
        self.card.show_view(view)
        self._panel.sure.setText(view.short)
        self._panel.sure.setVisible(bool(view.short))
