"""The space bar: a tap flips before and after, a hold lets one peek."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QCoreApplication, QElapsedTimer, QEvent, QObject, Qt
from PySide6.QtGui import QAction, QKeyEvent
from PySide6.QtWidgets import QAbstractButton, QApplication, QWidget

from app.gui.viewport.view_area import ViewArea

HOLD = 350
"""Milliseconds from which on a pressed key is held and no longer tapped."""


class CompareKey(QObject):
    """Flips to the body at rest when ``flip`` is triggered, and back to what it was flipped from.

    If its key is let go after having been held it flips back at once. ``show_variants`` puts these side by
    side again, which the view cannot do by itself.
    """

    def __init__(
        self, window: QWidget, flip: QAction, view: ViewArea, show_variants: Callable[[], object]
    ) -> None:
        super().__init__(window)
        self._view, self._show_variants = view, show_variants
        self._former, self._back = "", "after"
        self._held = QElapsedTimer()
        flip.setAutoRepeat(False)
        flip.triggered.connect(self._flip)
        view.compared.connect(self._forget)
        window.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Handle the key going down and up; leave it to a button with keyboard focus."""
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
        if held >= HOLD and self._view.beside.way != self._former:
            self._flip()

    def _flip(self) -> None:
        way, back = self._view.beside.way, self._back
        if way == "before" and back == "variants":
            self._show_variants()
        else:
            self._view.compare_by(back if way == "before" else "before")
        self._back = back if way == "before" else way

    def _forget(self) -> None:
        """Flip to the reshaped body alone, unless it was the key that has just brought what is seen."""
        self._back = "after"


def _everything() -> QCoreApplication:
    application = QApplication.instance()
    assert application is not None
    return application


def _is_space(event: QEvent) -> bool:
    return isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Space and not event.isAutoRepeat()


def _button_by_keyboard() -> bool:
    """Return whether a button has the focus: none of them takes it from the mouse."""
    return isinstance(QApplication.focusWidget(), QAbstractButton)
