"""The space bar: a tap flips before and after, a hold lets one peek."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QElapsedTimer, QEvent, QObject, Qt
from PySide6.QtGui import QAction, QKeyEvent
from PySide6.QtWidgets import QAbstractButton, QApplication, QWidget

from app.view_area import ViewArea
from app.viewing.beside import WAYS

HOLD = 350
"""Milliseconds from which on a pressed key is held and no longer tapped."""


class FlipKey(QObject):
    """Flips the view when ``flip`` is triggered, and back if its key is let go after having been held."""

    def __init__(self, window: QWidget, flip: QAction, view: ViewArea) -> None:
        super().__init__(window)
        self._view = view
        self._former = ""
        self._held = QElapsedTimer()
        flip.setAutoRepeat(False)
        flip.triggered.connect(lambda: view.set_after(view.beside.way == "before"))
        window.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """See the key go down and up; leave it to a button that was reached by keyboard."""
        if event.type() == QEvent.Type.ShortcutOverride and _is_space(event):
            if _button_by_keyboard():
                event.accept()
            elif not self._held.isValid():
                self._press()
        elif self._held.isValid() and (
            event.type() == QEvent.Type.ApplicationDeactivate
            or (event.type() == QEvent.Type.KeyRelease and _is_space(event))
        ):
            self._let_go()
        return False

    def _press(self) -> None:
        self._former = self._view.beside.way
        self._held.start()
        _everything().installEventFilter(self)  # until the key is let go: this is not cheap

    def _let_go(self) -> None:
        held = self._held.elapsed()
        self._held.invalidate()
        _everything().removeEventFilter(self)
        if held >= HOLD and self._former in WAYS:
            self._view.compare_by(self._former)


def _everything() -> QCoreApplication:
    application = QApplication.instance()
    assert application is not None
    return application


def _is_space(event: QEvent) -> bool:
    return isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Space and not event.isAutoRepeat()


def _button_by_keyboard() -> bool:
    """Whether a button has the focus because somebody went there by keyboard."""
    focused = QApplication.focusWidget()
    by_keyboard = Qt.WidgetAttribute.WA_KeyboardFocusChange
    return isinstance(focused, QAbstractButton) and focused.window().testAttribute(by_keyboard)
