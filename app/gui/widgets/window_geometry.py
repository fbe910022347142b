"""Geometry of a window: on an existing screen, and no larger than it."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QByteArray, QRect, QSettings, QSize, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QWidget

FIRST = QSize(1600, 1000)
"""First size of the window [px], where the screen has room for it."""

TITLE = 40
"""Height that the desktop's title bar may take, which Qt does not know before a window is shown [px]."""


def screens() -> list[QRect]:
    """Return what is free of each screen, the first one first [px]."""
    return [screen.availableGeometry() for screen in QGuiApplication.screens()]


def fitted(place: QRect, free: Sequence[QRect]) -> QRect:
    """Return a place moved, and made smaller if need be, into the screen that it lies on most.

    ``free`` are the screens; what lies on none of them goes to the first. A place is without its title [px].
    """
    screen = max(free, key=lambda each: _area(each & place))
    room = screen.adjusted(0, TITLE, 0, 0)
    size = place.size().boundedTo(room.size())
    left = min(max(place.left(), room.left()), room.right() + 1 - size.width())
    top = min(max(place.top(), room.top()), room.bottom() + 1 - size.height())
    return QRect(left, top, size.width(), size.height())


def put_as_last(window: QWidget) -> None:
    """Place the main window, or what stands in its place, where that stood last and a screen is there."""
    place = QSettings().value("window/geometry")
    if isinstance(place, QByteArray) and window.restoreGeometry(place):
        put_on_screen(window, window.normalGeometry())
    else:
        put_first(window, FIRST)


def put_first(window: QWidget, wanted: QSize) -> None:
    """Place a window in the middle of the first screen; one that has no room there fills the screen."""
    free = screens()
    place = QRect(window.pos(), wanted)
    place.moveCenter(free[0].center())
    put_on_screen(window, place)
    if window.size() != wanted:
        window.setWindowState(window.windowState() | Qt.WindowState.WindowMaximized)


def put_on_screen(window: QWidget, place: QRect) -> None:
    """Place a window where it is seen as a whole, as near to ``place`` as that goes; it stays maximised."""
    state, inside = window.windowState(), fitted(place, screens())
    window.setMinimumSize(window.minimumSize().boundedTo(inside.size()))
    if inside != window.geometry():
        window.setWindowState(Qt.WindowState.WindowNoState)
        window.setGeometry(inside)
        window.setWindowState(state)


def _area(place: QRect) -> int:
    return place.width() * place.height() if place.isValid() else 0
