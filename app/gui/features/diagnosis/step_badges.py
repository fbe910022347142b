"""The desk of the overall verdict: computed once a run has converged, shown wherever a design is judged."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast
from weakref import WeakKeyDictionary, WeakSet

from PySide6.QtCore import QObject, Signal

from app.i18n.catalog import tr
from app.presenters.assessment import IDLE, AssessmentView, assessment_view
from app.presenters.bust_shift import bust_girths
from app.presenters.status import ConvergenceView, convergence_view, out_of_date
from core.garment.assessment import BAD, CAUTION, GOOD, PENDING, assess_with
from core.garment.cut_list import CutList, cut_list
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow

_RAIL = {BAD: "bad", CAUTION: "look", GOOD: "done", PENDING: "available", IDLE: "available"}


class VerdictDesk(QObject):
    """Keeps the overall verdict of frames, and shows that of the current one in the strip and the rail.

    ``changed`` is emitted whenever the verdict of the current frame may be another one.
    """

    changed = Signal()

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._frame: Frame | None = None
        self._cuts: WeakKeyDictionary[Frame, CutList] = WeakKeyDictionary()
        self._girths: WeakKeyDictionary[Frame, tuple[float, float]] = WeakKeyDictionary()
        self._measured: WeakSet[Frame] = WeakSet()  # their girths are known, being computed or given up

    def of(self, frame: Frame) -> AssessmentView:
        """Return the overall verdict of a frame, as far as it is known; pressures are computed in a job."""
        window, design = self._window, frame.stages.design
        moves = frame is window.session.frame and not window.session.is_at_rest
        running, failed, cuts, pressed = frame.is_running or moves, False, None, None
        if not running and frame.verdict.is_valid and design.active_lines():
            cuts = self._cuts.get(frame)
            if cuts is None:
                cuts = self._cuts[frame] = cut_list(frame.stages, frame.control_points)
            pressed, failed = window.pressure_desk.of(frame), window.pressure_desk.has_failed(frame)
        found = assess_with(frame, cuts, pressed, running=running, failed=failed)
        return assessment_view(found, design)

    def _strip_verdict(self, frame: Frame, view: AssessmentView) -> ConvergenceView:
        """Return the values of the strip; girth and pressure only once the body has come to rest."""
        if not frame.verdict.is_valid or frame.is_running or not self._window.session.is_at_rest:
            return convergence_view(frame, view)
        if frame not in self._measured:
            self._measure(frame)
        pressed = self._window.pressure_desk.of(frame) if frame.stages.design.active_lines() else None
        return convergence_view(frame, view, self._girths.get(frame), pressed)

    def _measure(self, frame: Frame) -> None:
        """Compute the bust girths of a frame in a job: of a fine scan they take more than a second."""
        self._measured.add(frame)

        def show(girths: object) -> None:
            self._girths[frame] = cast(tuple[float, float], girths)
            self.refresh()

        show_failure, words = self._window.notifications.error, tr("Measuring the bust girth")
        self._window.jobs.run(words, lambda progress: bust_girths(frame), show, show_failure)

    def show_frame(self, frame: Frame) -> None:
        """Show the verdict of a frame."""
        self._frame = frame
        self.refresh()

    def refresh(self) -> None:
        """Show the verdict of the current frame as far as it is known by now."""
        if self._frame is None:
            return
        view, window = self.of(self._frame), self._window
        verdict, failed = self._strip_verdict(self._frame, view), window.session.failure is not None
        window.strip.set_verdict(out_of_date(verdict) if failed else verdict)
        looks = "available" if failed else _RAIL[view.level]
        count = len(view.reasons) if looks in ("bad", "look") else 0
        window.navigation.mark_step("lines", looks, count)
        window.navigation.mark_step("result", looks)
        self.changed.emit()
