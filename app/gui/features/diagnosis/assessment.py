"""The overall verdict: computed once a run has converged, shown wherever a design is judged."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol
from weakref import WeakKeyDictionary

from PySide6.QtCore import QObject, Signal

from app.gui.session.frame_cache import FrameCache
from app.i18n.catalog import tr
from app.presenters.assessment import IDLE, AssessmentView, assessment_view
from app.presenters.status import ConvergenceView, convergence_view, out_of_date
from core.garment.assessment import BAD, CAUTION, GOOD, PENDING, assess_with
from core.garment.cut_list import CutList, cut_list_of
from core.garment.pressure_list import PressureList
from core.measurements.figure import figure_girths
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext

_STEP_STATES = {BAD: "bad", CAUTION: "look", GOOD: "done", PENDING: "available", IDLE: "available"}


class Pressures(Protocol):
    """Returns the contact pressures of frames."""

    def of(self, frame: Frame) -> PressureList | None:
        """Return the pressures of a frame, or None while they are not known."""
        ...

    def has_failed(self, frame: Frame) -> bool:
        """Return whether there will be none."""
        ...


class AssessmentController(QObject):
    """Keep the overall verdict of frames, and show that of the current one at the steps.

    ``assessed`` carries what the convergence panel shows of it, whenever it may be another one.
    """

    assessed = Signal(object)

    def __init__(self, context: AppContext, pressures: Pressures) -> None:
        super().__init__(context.session)
        self._session, self._navigation, self._pressures = context.session, context.navigation, pressures
        self._frame: Frame | None = None
        self._cuts: WeakKeyDictionary[Frame, CutList] = WeakKeyDictionary()
        # Of a fine scan they take more than a second.
        self._girths = FrameCache(
            context.session,
            context.jobs,
            tr("Measuring bust girth…"),
            lambda frame, _: figure_girths(frame),
            failed=context.notifications.error,
        )
        self._girths.changed.connect(self.refresh)

    def of(self, frame: Frame) -> AssessmentView:
        """Return the overall verdict of a frame, as far as it is known; pressures are computed in a job."""
        design = frame.stages.design
        moves = frame is self._session.frame and not self._session.is_at_rest
        running, failed, cuts, pressed = frame.is_running or moves, False, None, None
        if not running and frame.verdict.is_valid and not design.is_bare:
            cuts = self._cuts.get(frame)
            if cuts is None:
                cuts = self._cuts[frame] = cut_list_of(frame)
            pressed, failed = self._pressures.of(frame), self._pressures.has_failed(frame)
        found = assess_with(frame, cuts, pressed, running=running, failed=failed)
        return assessment_view(found, design)

    def level_of(self, frame: Frame) -> str:
        """Return the level of the overall verdict of a frame."""
        return self.of(frame).level

    def show_frame(self, frame: Frame) -> None:
        """Show the verdict of a frame."""
        self._frame = frame
        self.refresh()

    def refresh(self) -> None:
        """Show the verdict of the current frame as far as it is known by now."""
        if self._frame is None:
            return
        view, failed = self.of(self._frame), self._session.failure is not None
        verdict = self._strip_verdict(self._frame, view)
        state = "available" if failed else _STEP_STATES[view.level]
        count = len(view.reasons) if state in ("bad", "look") else 0
        self._navigation.mark_step("lines", state, count)
        self._navigation.mark_step("result", state)
        self.assessed.emit(out_of_date(verdict) if failed else verdict)

    def _strip_verdict(self, frame: Frame, view: AssessmentView) -> ConvergenceView:
        """Return what the convergence panel shows; girth and pressure only once the body has converged."""
        if not frame.verdict.is_valid or frame.is_running or not self._session.is_at_rest:
            return convergence_view(frame, view)
        pressed = self._pressures.of(frame) if not frame.stages.design.is_bare else None
        return convergence_view(frame, view, self._girths.request(frame), pressed)
