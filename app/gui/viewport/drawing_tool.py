"""A hand that draws on the body: clicks place points, drags still turn the body, a few keys end or undo."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QApplication, QWidget

from app.i18n.catalog import tr

_CLICK = 3.0  # pixels that the pointer may stray within a click

_KEYS = {
    Qt.Key.Key_Return: "keep",
    Qt.Key.Key_Enter: "keep",
    Qt.Key.Key_Backspace: "back",
    Qt.Key.Key_Delete: "back",
    Qt.Key.Key_Escape: "leave",
}


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do while a line is drawn or led, ready to read."""
    return [
        ("Enter", tr("Finish line")),
        ("Backspace", tr("Remove last point")),
        ("Esc", tr("Cancel")),
    ]


class DrawingTool(QObject):
    """Listens before the pointer of ``view`` does, while it is ``at_work``.

    ``clicked``, ``double_clicked`` and ``hovered`` carry places on the canvas, ``requested`` one of: keep,
    back, leave; of these only what it ``takes``. What ``grabs`` takes hold of is ``dragged``, then
    ``dropped``; any other drag is left to the view.
    """

    clicked = Signal(QPointF)
    hovered = Signal(QPointF)
    dragged = Signal(QPointF)
    dropped = Signal(QPointF)
    double_clicked = Signal(QPointF)
    requested = Signal(str)

    def __init__(self, view: QWidget, canvas: QWidget) -> None:
        super().__init__(view)
        self._view, self._canvas = view, canvas
        self.at_work = False
        self.grabs: Callable[[QPointF], bool] = lambda _: False
        self.takes: Callable[[str], bool] = lambda _: True
        self._pressed: QMouseEvent | None = None
        self._holds = self._passing = False

    def begin(self) -> None:
        """Start handling events, and take the keyboard focus."""
        if not self.at_work:
            self.at_work = True
            for each in (self._canvas, self._view):
                each.installEventFilter(self)
        self._view.setFocus(Qt.FocusReason.OtherFocusReason)
        self._canvas.setCursor(Qt.CursorShape.CrossCursor)

    def end(self) -> None:
        """Stop handling events."""
        self.at_work, self._pressed, self._holds = False, None, False
        for each in (self._canvas, self._view):
            each.removeEventFilter(self)
        self._canvas.setCursor(Qt.CursorShape.ArrowCursor)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take clicks on the canvas and the keys of the hand, wherever in the view the keyboard is."""
        if isinstance(event, QKeyEvent) and event.key() in _KEYS:
            request = _KEYS[Qt.Key(event.key())]
            if not self.takes(request):
                return False
            event.accept()  # of a shortcut: the key is wanted here
            if event.type() == QEvent.Type.KeyPress:
                self.requested.emit(request)
            return event.type() != QEvent.Type.KeyRelease
        if watched is self._canvas and isinstance(event, QMouseEvent) and not self._passing:
            return self._mouse(event)
        return False

    def _mouse(self, event: QMouseEvent) -> bool:
        kind, of_left = event.type(), event.button() == Qt.MouseButton.LeftButton
        left = of_left and not event.modifiers()
        if kind == QEvent.Type.MouseButtonDblClick and left:
            self.double_clicked.emit(event.position())
            self.requested.emit("keep")
            return True
        if kind == QEvent.Type.MouseButtonPress and left:
            self._pressed = _copy(event)
            self._holds = self.grabs(event.position())
            return True
        if kind == QEvent.Type.MouseMove:
            return self._move(event)
        if kind == QEvent.Type.MouseButtonRelease and of_left and self._pressed is not None:
            self._pressed = None
            (self.dropped if self._holds else self.clicked).emit(event.position())
            self._holds = False
            return True
        return False

    def _move(self, event: QMouseEvent) -> bool:
        if self._holds:
            self.dragged.emit(event.position())
            return True
        if self._pressed is not None:
            if (event.position() - self._pressed.position()).manhattanLength() <= _CLICK:
                return True
            # It is a drag after all: the view hears of its beginning now.
            pressed, self._pressed, self._passing = self._pressed, None, True
            QApplication.sendEvent(self._canvas, pressed)
            self._passing = False
            return False
        if not event.buttons():
            self.hovered.emit(event.position())
            return True
        return False


def _copy(event: QMouseEvent) -> QMouseEvent:
    return QMouseEvent(
        event.type(),
        event.position(),
        event.globalPosition(),
        event.button(),
        event.buttons(),
        event.modifiers(),
    )
