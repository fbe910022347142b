"""The desk of contact pressure: worked out once a run rests, and only for who looks at it."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast
from weakref import WeakKeyDictionary, WeakSet

from PySide6.QtCore import QObject, Signal

from app.gui.features.garment.panel import GarmentPanel
from app.gui.features.garment.pressure_card import PressureCard
from app.i18n.catalog import tr
from app.presenters.pressure import pressure_summary, pressure_views, rating_limits, unknown_pressure
from app.presenters.status import invalid_reason, not_computed
from core.garment.pressure_list import PressureList, pressure_list
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow


class PressureDesk(QObject):
    """Keeps what the lines of frames press with, and shows it beside the cut list.

    ``found`` says that there is more of it; ``place_asked`` that the place which is pressed most is to be
    looked at.
    """

    found = Signal()
    place_asked = Signal()

    def __init__(self, window: MainWindow, panel: GarmentPanel) -> None:
        super().__init__(window)
        self._window, self._panel = window, panel
        self.card = PressureCard(rating_limits())
        self.card.hide()
        panel.cards.addWidget(self.card)
        self._shown: PressureList | None = None
        self._stale: bool | None = None
        self._doubt = ""  # why figures of now are no result
        self._body: object = None
        self._known: WeakKeyDictionary[Frame, PressureList] = WeakKeyDictionary()
        self._asked: WeakSet[Frame] = WeakSet()
        self._failed: WeakSet[Frame] = WeakSet()
        self._left: WeakSet[Frame] = WeakSet()
        self.found.connect(self.follow)
        self.card.place_asked.connect(self.place_asked)
        panel.opened.connect(self._begin_again)

    def of(self, frame: Frame) -> PressureList | None:
        """Return what the lines of a frame press with; if that is not known yet it is worked out beside.

        While the body moves it is not: the next frame would be another one.
        """
        moves = frame is self._window.session.frame and not self._window.session.is_at_rest
        if frame not in self._asked and not frame.is_running and not moves:
            self._asked.add(frame)
            self._window.jobs.run(
                tr("Working out the pressure"),
                lambda progress: pressure_list(frame.stages, frame.control_points),
                lambda found: self._take(frame, found),
                lambda error: self._fail(frame, error),
                left=lambda: self._leave_off(frame),
            )
        return self._known.get(frame)

    def has_failed(self, frame: Frame) -> bool:
        """Return whether the pressures of a frame were not computed, and are not on their way."""
        return frame in self._failed or frame in self._left

    def missing(self, frame: Frame) -> str:
        """Return why there are no pressures of a frame, nothing where they are known or will be."""
        if self.has_failed(frame):
            return unknown_pressure()
        session = self._window.session
        failed = session.failure is not None and frame is session.frame
        return not_computed() if failed and frame not in self._known else ""

    def of_listed(self, frame: Frame) -> PressureList | None:
        """Return the same for the list of lines: only where it is seen, and a line is worn."""
        seen = self._window.lines.isVisible() and frame.stages.design.active_lines()
        return self.of(frame) if seen and not invalid_reason(frame) else None

    @property
    def shown(self) -> PressureList | None:
        """What is shown beside the cut list, if that is of now and a result."""
        return None if self._stale or self._doubt else self._shown

    def follow(self) -> None:
        """Bring the figures beside the cut list up to date, if they are seen."""
        frame = self._window.session.frame
        if frame is None or not self._panel.isVisible():
            return
        known = self.of(frame)
        if frame.stages.body is not self._body:
            self._body, self._shown, self._stale = frame.stages.body, None, None
        stale = known is None
        doubt = invalid_reason(frame) or self.missing(frame)
        if (known or self._shown) is self._shown and (stale, doubt) == (self._stale, self._doubt):
            return
        self._shown, self._stale = known or self._shown, stale
        design, self._doubt = frame.stages.design, doubt
        told = None if self._doubt else self._shown
        self._panel.set_pressures(pressure_views(told, design, stale) if told else {})
        self.card.show_summary(pressure_summary(told, design, self._doubt), stale and told is not None)
        self.card.setVisible(bool(design.active_lines()))

    def _take(self, frame: Frame, found: object) -> None:
        self._known[frame] = cast(PressureList, found)
        self.found.emit()

    def _fail(self, frame: Frame, error: Exception) -> None:
        self._failed.add(frame)
        self._window.notifications.error(error)
        self.found.emit()

    def _leave_off(self, frame: Frame) -> None:
        self._left.add(frame)
        self._window.notifications.stopped(tr("Working out the pressure"))
        self.found.emit()  # who waits for it does so no longer

    def _begin_again(self) -> None:
        """Work out what the user stopped: it is looked at again."""
        for frame in self._left:
            self._asked.discard(frame)
        stopped = bool(self._left)
        self._left.clear()
        self.follow()
        if stopped:
            self.found.emit()
