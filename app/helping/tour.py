"""The tour through the window: four places, what each is for, and a card beside it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QPoint, QRect, Qt, QTimer
from PySide6.QtWidgets import QWidget

from app.keeping.recent import end_first_start
from app.panels.coach_mark import CoachMark
from app.wording.words import tr

if TYPE_CHECKING:
    from app.main_window import MainWindow

Stop = tuple[str, str, Callable[[], Sequence[QWidget]]]
"""Title, sentence, and the parts of the window that they speak of."""


class Tour(QObject):
    """Leads through its stops; the window can be used meanwhile. Where it ended counts as seen."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._place = -1
        self.mark = CoachMark(window)
        self.mark.went.connect(self._go)
        self.mark.skipped.connect(self.end)

    @property
    def place(self) -> int:
        """Which stop is shown, from 0; -1 while there is no tour."""
        return self._place

    def begin(self) -> None:
        """Begin with the first stop."""
        self._place = 0
        self._window.installEventFilter(self)
        self._show()

    def begin_when_settled(self) -> None:
        """Begin once the body that is being opened is in its finished state."""
        self._window.session.frame_ready.connect(self._begin_if_settled)

    def end(self) -> None:
        """Go, and do not come again by itself."""
        self._place = -1
        self._window.removeEventFilter(self)
        self.mark.leave()
        self._window.layout_.enter()
        end_first_start()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Stay beside what is spoken of when the window changes its size."""
        if event.type() == QEvent.Type.Resize:
            QTimer.singleShot(0, self, self._point)
        return False

    def _begin_if_settled(self) -> None:
        if self._window.is_settled():
            self._window.session.frame_ready.disconnect(self._begin_if_settled)
            self.begin()

    def _go(self, step: int) -> None:
        self._place = max(self._place + step, 0)
        if self._place < len(self._stops()):
            self._show()
        else:
            self.end()

    def _show(self) -> None:
        stops = self._stops()
        title, words, _ = stops[self._place]
        self._window.desk.go_to("lines")
        self._window.strip.set_folded(False)
        self.mark.show_step(self._place, len(stops), title, words)
        self._point()
        self.mark.setFocus(Qt.FocusReason.OtherFocusReason)
        # What was folded away a moment ago has its place only then.
        QTimer.singleShot(0, self, self._point)

    def _point(self) -> None:
        if self._place >= 0:
            parts = self._stops()[self._place][2]()
            places = [QRect(part.mapTo(self._window, QPoint(0, 0)), part.size()) for part in parts]
            # Not over the menus: they can be opened meanwhile, as all else can.
            room = self._window.rect().adjusted(0, self._window.top.geometry().bottom() + 1, 0, 0)
            self.mark.point_at(reduce(QRect.united, places), room)

    def _stops(self) -> tuple[Stop, ...]:
        window = self._window
        return (
            (
                tr("Four steps"),
                tr(
                    "From the scan to the result. Nothing is locked: go to any of them at any time. "
                    "For a scan of your own, drop its file on the window or press Ctrl+O."
                ),
                lambda: list(window.rail.items.values()),
            ),
            (
                tr("Drag a line"),
                tr(
                    "Pull the handle of a line to the left: it gets shorter, and the body follows at once. "
                    "You can type a number as well."
                ),
                lambda: [window.lines.rows.get(window.view.selected_line, window.lines)],
            ),
            (
                tr("Before and after"),
                tr("Press Space, or click here, to see the body as it was scanned, and reshaped again."),
                lambda: [window.view.compare],
            ),
            (
                tr("Does it come to rest?"),
                tr(
                    "Each turn brings every point nearer to its balance. The word says how the body stands, "
                    "the plots how far the volume is kept and the bust is lifted."
                ),
                lambda: [window.strip],
            ),
        )
