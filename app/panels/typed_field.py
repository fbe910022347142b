"""A value that reads as text and can be typed over: Enter takes what was typed, Esc brings it back."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QLineEdit

from app.dress.theme import font, set_tag, tokens_of
from app.wording.words import tr

_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do in a field that is typed into, ready to read."""
    return [("Enter", tr("Take what is typed")), ("Esc", tr("Leave it as it was"))]


class TypedField(QLineEdit):
    """The part of a field that is alike for every kind of value; ``left`` at Enter, once taken, or Esc."""

    left = Signal()

    def __init__(self, unit: str = "") -> None:
        super().__init__()
        self._unit = unit
        self.textEdited.connect(lambda _: set_tag(self, "wrong", False))

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self._enter()
        self._show()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._enter()
            if not self.isModified():
                self.left.emit()
        elif event.key() == Qt.Key.Key_Escape:
            self._show()
            self.left.emit()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        painter = QPainter(self)
        painter.setFont(font("caption"))
        painter.setPen(tokens_of(self).text_caption)
        painter.drawText(self.rect().adjusted(0, 1, -7, 0), _RIGHT, self._unit)

    def _words(self) -> str:
        """Return the present value as it is shown."""
        raise NotImplementedError

    def _read(self, text: str) -> Any:
        """Return the value that was typed. Raises ValueError if it is none that can be."""
        raise NotImplementedError

    def _take(self, value: Any) -> None:
        """Make a typed value the present one, and tell."""
        raise NotImplementedError

    def _follow(self) -> None:
        """Show the present value, unless something is being typed."""
        if not (self.hasFocus() and self.isModified()):
            self._show()

    def _show(self) -> None:
        if self._words() != self.text():
            self.setText(self._words())
        self.setModified(False)
        set_tag(self, "wrong", False)

    def _enter(self) -> None:
        if not self.isModified():
            return
        try:
            value = self._read(self.text())
        except ValueError:
            set_tag(self, "wrong", True)
            self.selectAll()
            return
        self.setModified(False)
        self._take(value)
        self._show()
