"""The table of measures: computed where it is seen, copied, written to a file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject

from app.gui.features.measurements.panel import MeasurementsPanel
from app.gui.file_export import copy_table, save_table
from app.gui.session.jobs import Job
from app.gui.session.settings import get_setting, set_setting
from app.i18n.catalog import tr
from app.i18n.lengths import length
from app.presenters.measurements import MeasureView, as_table, measure_views, measured_views
from app.presenters.sizes import size_views
from app.presenters.status import invalid_reason, not_computed
from app.presenters.uncertainty import with_uncertainty
from core.geometry.mesh import Points
from core.measurements.definitions import Measure
from core.measurements.table import Measures, before_after
from core.measurements.uncertain_value import OutputUncertainties
from core.pipeline.live_solver import Frame
from core.scan.body import Body

if TYPE_CHECKING:
    from app.gui.context import AppContext


class MeasurementsController(QObject):
    """Fill the panel of measures: values of the model with every frame, of the body once the run rests.

    ``uncertainties`` returns those of the design that is shown, and whether they are out of date.
    """

    def __init__(
        self,
        context: AppContext,
        panel: MeasurementsPanel,
        uncertainties: Callable[[], tuple[OutputUncertainties | None, bool]],
    ) -> None:
        super().__init__(context.session)
        self._context, self._panel, self._uncertainties = context, panel, uncertainties
        self._frame: Frame | None = None
        self._asked: Frame | None = None
        self._body: Body | None = None
        self._job: Job | None = None
        self._rest: Measures | None = None
        self._worn: Measures | None = None
        self._sized: OutputUncertainties | None = None  # what the sizes shown were told with
        self._tried: tuple[Measure, Measure] | None = None
        self._views: list[MeasureView] = []  # what was measured, without what it may be off by
        panel.marked.connect(self._show_mark)
        panel.framed.connect(self._look_at)
        panel.opened.connect(self.refresh)
        context.view.compared.connect(self._show_mark)
        panel.copy_requested.connect(lambda: copy_table(context, self._as_table()))
        panel.table_requested.connect(
            lambda: save_table(context, self._as_table(), tr("Export table of measurements"), "measures")
        )
        panel.sizes.chosen.connect(self._choose)
        panel.sizes.allowed.connect(self._allow)

    def show_frame(self, frame: Frame) -> None:
        """Show the measures of a frame."""
        self._frame = frame
        self.refresh()

    def refresh(self) -> None:
        """Update the table, if visible."""
        if self._frame is not None and self._panel.isVisible():
            self._panel.set_rows(self._spread(measure_views(self._frame)), invalid_reason(self._frame))
            self._measure(self._frame)

    def show_spread(self) -> None:
        """Show beside what is known how far it may be off."""
        if self._frame is None or not self._panel.isVisible():
            return
        self._panel.set_rows(self._spread(measure_views(self._frame)), invalid_reason(self._frame))
        if self._sized is not self._sure:
            self._show_sizes()
        if self._panel.measured:
            stale = self._panel.stale
            self._panel.set_measured(self._spread(self._views))
            self._panel.set_stale(stale)

    def _spread(self, views: Sequence[MeasureView]) -> list[MeasureView]:
        return with_uncertainty(views, *self._uncertainties())

    def _measure(self, frame: Frame) -> None:
        """Measure the body of a frame beside the window, once it rests."""
        context = self._context
        if self._asked is frame:
            return
        context.jobs.cancel(self._job)
        self._job = self._asked = None
        if not self._panel.measured or self._body is not frame.stages.body:
            self._body = frame.stages.body
            self._rest = self._worn = None
            self._show_sizes()
            self._panel.set_measured([], self._waiting())
        self._panel.set_stale(True)
        self._show_mark()
        if context.session.is_at_rest:
            self._asked = frame
            self._job = context.jobs.run(
                tr("Measuring body…"),
                lambda progress: before_after(frame.stages, *frame.region_points),
                self._show_measured,
                self._fail,
                left=self._leave_off,
            )

    def _waiting(self) -> str:
        """Return why nothing is measured yet."""
        if self._context.session.failure is not None:
            return not_computed()
        if self._context.session.is_at_rest:
            return tr("Measuring body…")
        return tr("Measurements appear when the solver has converged.")

    def _show_measured(self, found: object) -> None:
        self._rest, self._worn = cast(tuple[Measures, Measures], found)
        frame = self._asked
        assert frame is not None  # a job that was let go of does not come here
        self._views = measured_views(self._rest, self._worn)
        self._panel.set_measured(self._spread(self._views))
        self._show_sizes()
        self._show_mark()

    def _fail(self, error: Exception) -> None:
        self._context.notifications.error(error)
        self._give_up(tr("The body could not be measured."))

    def _leave_off(self) -> None:
        self._context.notifications.stopped(tr("Measuring body…"))
        self._give_up(tr("Measuring stopped. Open this list again to measure the body."))

    def _give_up(self, why: str) -> None:
        """Be ready to be asked again; what was measured before stays, as of a former shape."""
        self._job = self._asked = None
        if not self._panel.measured:
            self._panel.set_measured([], why)

    def try_out(self, found: tuple[Measure, Measure] | None) -> None:
        """Draw a measure that is being made, before and after, on the body instead of the marked one."""
        if found is not self._tried:
            self._tried = found
            self._show_mark()

    def _show_mark(self) -> None:
        """Draw the marked measure on the body, on each that is seen; while it moves it is not there."""
        rest, worn = (() if self._panel.stale else self._curves(found) for found in (self._rest, self._worn))
        if self._tried is not None:
            rest, worn = (found.curves for found in self._tried)
        for body in self._context.view.beside.live:
            if body.body is None:
                continue
            trace = body.viewport.scene.measure
            if rest or worn or trace.shown:
                trace.show_both(rest, worn)
                body.viewport.request_draw()

    def _look_at(self) -> None:
        viewport = self._context.view.viewport
        if viewport.shows_body and viewport.scene.measure.shown:
            viewport.frame_points(viewport.scene.measure.points)

    def _curves(self, found: Measures | None) -> tuple[Points, ...]:
        measure = found.get(self._panel.mark) if found else None
        return measure.curves if measure else ()

    def _choose(self, system: str) -> None:
        set_setting("size_system", system)
        self._show_sizes()

    def _allow(self, mm: float) -> None:
        text = tr("Tape tension allowance: {length}").format(length=length(mm))
        self._context.session.change({"worn_tight_mm": mm}, text)
        self._show_sizes()

    def _show_sizes(self) -> None:
        design = self._context.session.design
        allowance = design.worn_tight_mm if design else 0.0
        self._sized = self._sure
        views, why = size_views(self._rest, allowance, self._sized) if self._rest else ([], "")
        self._panel.sizes.set_sizes(views, get_setting("size_system"), allowance, why)

    @property
    def _sure(self) -> OutputUncertainties | None:
        """Return how far the girths of the shown body may be off, once all of it is known."""
        spread, faint = self._uncertainties()
        return None if faint else spread

    def _as_table(self) -> list[list[str]]:
        # What was measured on a former body is no measure of this one.
        measured = () if self._panel.stale else self._panel.measured
        return as_table([*measured, *self._panel.rows], self._panel.doubt)
