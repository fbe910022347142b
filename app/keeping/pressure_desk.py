"""The desk of contact pressure: worked out once a run rests, and only for who looks at it."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast
from weakref import WeakKeyDictionary, WeakSet

from PySide6.QtCore import QObject, Signal

from app.wording.words import tr
from core.live import Frame
from core.press_list import PressList, press_list

if TYPE_CHECKING:
    from app.main_window import MainWindow


class PressureDesk(QObject):
    """Keeps what the lines of frames press with; ``found`` says that there is more of it."""

    found = Signal()

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._known: WeakKeyDictionary[Frame, PressList] = WeakKeyDictionary()
        self._asked: WeakSet[Frame] = WeakSet()

    def of(self, frame: Frame) -> PressList | None:
        """Return what the lines of a frame press with; if that is not known yet it is worked out beside.

        While the body moves it is not: the next frame would be another one.
        """
        moves = frame is self._window.session.frame and not self._window.is_settled()
        if frame not in self._asked and not frame.at_work and not moves:
            self._asked.add(frame)
            self._window.jobs.run(
                tr("Working out the pressure"),
                lambda progress: press_list(frame.stages, frame.control_points),
                lambda found: self._take(frame, found),
            )
        return self._known.get(frame)

    def _take(self, frame: Frame, found: object) -> None:
        self._known[frame] = cast(PressList, found)
        self.found.emit()
