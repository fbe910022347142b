"""Work before the first paint of a window, and after it."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QCoreApplication, QEvent, QObject, QTimer
from PySide6.QtWidgets import QWidget

_PATIENCE = 1000
"""Milliseconds after which it is done although nothing was painted: a window may open minimised."""

_NESTED = 5  # layouts in layouts, of which each hears of a change from the one within it


def lay_out() -> None:
    """Lay out at once what was shown or resized.

    Qt paints a card that has just been shown before it hears of the heights of wrapped texts; a body that
    moves and is drawn without a graphics card then leaves the card half laid out for a second and more.
    """
    for _ in range(_NESTED):
        QCoreApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest.value)


def when_painted(window: QWidget, do: Callable[[], None]) -> None:
    """Call ``do`` once, from the event loop, when ``window`` has been painted for the first time.

    It is not called of a window that has been closed before.
    """
    _FirstPaint(window, do)


class _FirstPaint(QObject):
    def __init__(self, window: QWidget, do: Callable[[], None]) -> None:
        super().__init__(window)
        self._window, self._do = window, do
        self._due = QTimer(self, interval=_PATIENCE, singleShot=True)
        self._due.timeout.connect(self._call)
        self._due.start()
        window.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        if event.type() == QEvent.Type.Paint:
            # The rest of the window is painted in the same go; what is due comes after it.
            self._due.start(0)
        elif event.type() == QEvent.Type.Hide:
            self._due.stop()  # closed, it has let its threads go: none may begin after that
        return False

    def _call(self) -> None:
        self._window.removeEventFilter(self)
        self._do()
        self.deleteLater()
