"""Parts of the window that share its room, shared out by hand or by keys."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QSplitter, QSplitterHandle, QWidget

from app.gui.theme.stylesheet import tokens_of
from app.i18n.catalog import tr

STEP = 8
"""Pixels that an arrow key moves the line between two parts."""

_FARTHEST = 10**5
_TO = {Qt.Key.Key_Home: -_FARTHEST, Qt.Key.Key_End: _FARTHEST}
_WAYS = {
    Qt.Orientation.Horizontal: {Qt.Key.Key_Left: -STEP, Qt.Key.Key_Right: STEP} | _TO,
    Qt.Orientation.Vertical: {Qt.Key.Key_Up: -STEP, Qt.Key.Key_Down: STEP} | _TO,
}


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do on the line between two parts, ready to read."""
    return [
        ("← → ↑ ↓", tr("Resize by {count} pixels").format(count=STEP)),
        ("Home, End", tr("Resize to the limit")),
    ]


class Splitter(QSplitter):
    """Two parts beside or above each other, with a hairline between that keys move too."""

    def __init__(self, orientation: Qt.Orientation, name: str) -> None:
        super().__init__(orientation)
        self._name = name
        self.setHandleWidth(1)
        self.setChildrenCollapsible(False)

    def createHandle(self) -> QSplitterHandle:
        return _Line(self.orientation(), self, self._name)


class _Line(QSplitterHandle):
    """The hairline; as long as it has the keyboard it is three pixels in the colour of focus."""

    def __init__(self, orientation: Qt.Orientation, parent: Splitter, name: str) -> None:
        super().__init__(orientation, parent)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAccessibleName(name)

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            event.setAccepted(event.key() in _WAYS[self.orientation()])
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        way = _WAYS[self.orientation()].get(Qt.Key(event.key()))
        if way is None:
            super().keyPressEvent(event)
            return
        here = self.pos() + self.contentsRect().topLeft()
        self.moveSplitter((here.x() if self.orientation() == Qt.Orientation.Horizontal else here.y()) + way)

    def focusInEvent(self, event: QFocusEvent) -> None:
        super().focusInEvent(event)
        self.setMask(self.rect().adjusted(1, 1, -1, -1))

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self.setMask(self.contentsRect())
        self._give_back()

    def _give_back(self) -> None:
        """Let what lies beside the hairline paint anew: what paints all of itself is not told by Qt."""
        for each in self.splitter().findChildren(QWidget):
            place = self.geometry()
            place.moveTopLeft(each.mapFrom(self.splitter(), place.topLeft()))
            each.update(place)

    def paintEvent(self, event: QPaintEvent) -> None:
        if self.hasFocus():
            QPainter(self).fillRect(self.rect(), tokens_of(self).accent)
        else:
            super().paintEvent(event)
