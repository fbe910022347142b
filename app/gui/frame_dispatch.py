"""Dispatch of solver frames to receivers: one order, some of them at a limited rate."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterable

from PySide6.QtCore import QObject, QTimer

from app.presenters.plots import PLOT_INTERVAL
from core.pipeline.live_solver import Frame

Receiver = Callable[[Frame], object]


class FrameDispatch(QObject):
    """Pass frames to receivers in their ``order``; a fault of one does not keep frames from the others."""

    def __init__(self, receivers: Iterable[Receiver], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.order = list(receivers)

    def show_frame(self, frame: Frame) -> None:
        """Pass a frame to all receivers."""
        for receive in tuple(self.order):
            try:
                receive(frame)
            except Exception:
                sys.excepthook(*sys.exc_info())


class ThrottledDispatch(FrameDispatch):
    """Pass frames of a run on at most every ``PLOT_INTERVAL`` ms, and the newest in the end."""

    def __init__(self, receivers: Iterable[Receiver], parent: QObject | None = None) -> None:
        super().__init__(receivers, parent)
        self._frame: Frame | None = None
        self._passed: Frame | None = None
        self._due = 0.0
        self._clock = QTimer(self, interval=PLOT_INTERVAL, singleShot=True)
        self._clock.timeout.connect(self.flush)

    def show_frame(self, frame: Frame) -> None:
        """Pass a frame on, at once if it is not the next one of the same run."""
        former, self._frame = self._frame, frame
        running = frame.is_running and former is not None and frame.stages.model is former.stages.model
        if not running or time.monotonic() >= self._due:
            self.flush()
        elif not self._clock.isActive():
            self._clock.start()

    def flush(self) -> None:
        """Pass the newest frame on now, if that has not been done."""
        frame = self._frame
        if frame is None or frame is self._passed:
            return
        self._passed = frame
        self._due = time.monotonic() + PLOT_INTERVAL / 1000.0
        super().show_frame(frame)

    def repeat(self) -> None:
        """Pass the newest frame on again: the session has another state with the same frame."""
        self._passed = None
        self.flush()

    def close(self) -> None:
        """Stop the clock."""
        self._clock.stop()
