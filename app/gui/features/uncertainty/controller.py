"""Uncertainty of results, computed when a converged design is looked at, and its card."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.gui.session.frame_cache import FrameCache
from app.gui.theme.stylesheet import label, set_tag
from app.gui.widgets.basic import folded_list, hairline, sentence
from app.i18n.catalog import joined, tr
from app.presenters.messages import render
from app.presenters.status import invalid_reason, not_computed
from app.presenters.uncertainty import (
    UncertaintyView,
    limitation_sentences,
    source_sentences,
    uncertainty_view,
)
from core.analysis.uncertainty.estimate import UncertaintyEstimator
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.errors import UserError
from core.export.report_data import Report, with_uncertainty
from core.measurements.uncertain_value import OutputUncertainties
from core.pipeline.live_solver import Frame
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext


PAUSE = 600
"""Time without a new frame before the job begins: it shares the processor with the solver [ms]."""


class UncertaintyCard(QWidget):
    """What ± means, what another choice of the model makes, and two folds."""

    def __init__(self, sources: tuple[str, ...], left_out: tuple[str, ...]) -> None:
        super().__init__()
        self.meaning, self.contact = sentence("", "caption"), sentence("", "caption")
        column = QVBoxLayout(self)
        column.setContentsMargins(4, 4, 4, 4)
        column.setSpacing(4)
        column.addWidget(hairline())
        column.addWidget(label(tr("Uncertainties"), "heading"))
        column.addWidget(self.meaning)
        column.addWidget(self.contact)
        self.folds = [
            folded_list(column, tr("Sources of uncertainty"), sources),
            folded_list(column, tr("Not included"), left_out),
        ]
        self.show_view(UncertaintyView(""))

    def show_view(self, view: UncertaintyView) -> None:
        """Show what is known of the ±."""
        for words, text in ((self.meaning, view.meaning), (self.contact, view.contact)):
            words.setText(text)
            words.setVisible(bool(text))
            set_tag(words, "tone", "faint" if view.faint else "")


class UncertaintyController(QObject):
    """Keep the uncertainties of designs, and explain them in a card of the panel ``host``.

    They are computed while the host or anything else that ``is_needed`` names is seen. ``changed`` is emitted
    when there are more or fewer of them, ``summarized`` with the line that leads to the card.
    """

    changed = Signal()
    summarized = Signal(str)

    def __init__(self, context: AppContext, host: QWidget, is_needed: Callable[[], bool]) -> None:
        super().__init__(context.session)
        self._session, self._host, self._is_needed = context.session, host, is_needed
        self.card = UncertaintyCard(source_sentences(), limitation_sentences())
        self._last: OutputUncertainties | None = None
        self._trials: PerturbedSolutions | None = None
        self._body: object = None
        self._cache = FrameCache(
            context.session,
            context.jobs,
            tr("Computing uncertainties…"),
            self._compute,
            failed=lambda error: logging.error("no uncertainties were computed", exc_info=error),
            by_design=True,
            pause=PAUSE,
        )
        self._cache.changed.connect(self._take)
        self.changed.connect(self._show)
        context.session.design_changed.connect(lambda _: self.follow())
        context.session.failed.connect(lambda _: self.follow())

    @property
    def shown(self) -> tuple[OutputUncertainties | None, bool]:
        """Those of the design that is shown, else of the last one, and whether they are out of date."""
        frame = self._session.frame
        known = None if frame is None else self.of(frame)
        if known is not None:
            return known, False
        comes = frame is not None and not invalid_reason(frame) and not self._cache.is_given_up(frame)
        return (self._last if comes else None), True

    @property
    def is_computing(self) -> bool:
        """Return whether the uncertainties of the design that is shown are being computed."""
        frame = self._session.frame
        return frame is not None and self._cache.is_running(frame)

    def of(self, frame: Frame) -> OutputUncertainties | None:
        """Return the uncertainties of a frame, if they are known and it is a result."""
        return None if frame.is_running or invalid_reason(frame) else self._cache.get(frame)

    def on_sheet(self, sheet: Report, frame: Frame | None, whole: Frame | None) -> Report:
        """Return the sheet of a frame, made of ``whole``, with its uncertainties once they are known."""
        spread = None if frame is None else self.of(frame)
        if spread is None or whole is None or sheet.off:
            return sheet
        return with_uncertainty(sheet, whole.stages, whole.control_points, spread)

    def follow(self) -> None:
        """Request the uncertainties of a design that has converged and is looked at."""
        frame = self._session.frame
        if frame is None or self._session.design is None:
            return
        if frame.stages.body is not self._body:
            self._body, self._last, self._trials = frame.stages.body, None, None
            self._cache.clear()
        needed = self._host.isVisible() or self._is_needed()
        if needed and self._session.is_converged and not invalid_reason(frame):
            self._cache.request(frame)
        else:
            self._cache.hold()
        self.changed.emit()

    def _compute(self, frame: Frame, progress: Progress) -> OutputUncertainties:
        """Compute by all sources: without the landmarks, which are slow, it would be too small."""
        trials = PerturbedSolutions(frame.stages, self._trials)
        spread = UncertaintyEstimator(trials).estimate(progress)
        self._trials = trials  # the next design begins with them
        return spread

    def _take(self) -> None:
        frame = self._session.frame
        self._last = (self._cache.get(frame) if frame is not None else None) or self._last
        self.changed.emit()

    def _show(self) -> None:
        """Explain the uncertainties, or why there are none."""
        frame = self._session.frame
        if frame is None or not self._host.isVisible():
            return
        spread, faint = self.shown
        view = uncertainty_view(spread, "" if invalid_reason(frame) else self._waiting(frame), faint)
        self.card.show_view(view)
        self.summarized.emit(view.short)

    def _waiting(self, frame: Frame) -> str:
        if self._session.failure is not None:
            return not_computed()
        if self._cache.is_given_up(frame):
            error = self._cache.failure(frame)
            why = render(error.message) if isinstance(error, UserError) else ""
            return joined((tr("Uncertainties were not computed."), why))
        return tr("Uncertainties are computed when the solver has converged.")
