"""A figure with its unit that reads as text and can be typed over."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import re
import unicodedata

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QLineEdit

from app.dress.theme import font, set_tag, tokens_of
from app.wording.words import number

_FIGURE = re.compile(r"^\s*([+-]?\s*\d+(?:[.,]\d*)?)\s*[^\d\s]*\s*$")


def read_figure(text: str) -> float | None:
    """Return the figure that was typed, with or without a unit, or None if it is none."""
    plain = unicodedata.normalize("NFKC", text).replace("\N{MINUS SIGN}", "-")
    match = _FIGURE.match(plain)
    return float(match.group(1).replace(",", ".").replace(" ", "")) if match else None


class FigureField(QLineEdit):
    """Shows a value in ``unit`` with ``digits``; ``entered`` carries another one that was typed."""

    entered = Signal(float)

    def __init__(self, unit: str, name: str, *, digits: int = 1, signed: bool = False, widest: str) -> None:
        super().__init__()
        self._unit, self._digits, self._signed, self._widest = unit, digits, signed, widest
        self._value = 0.0
        self.setFont(font("secondary", tabular=True))
        self.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.setProperty("kind", "number")
        self.setAccessibleName(name)
        self.setToolTip(name)
        self._make_room()
        self.textEdited.connect(lambda _: set_tag(self, "wrong", False))

    def set_unit(self, unit: str, digits: int, signed: bool) -> None:
        """Show values in another unit."""
        self._unit, self._digits, self._signed = unit, digits, signed
        self._make_room()

    def sizeHint(self) -> QSize:
        return QSize(self.fontMetrics().horizontalAdvance(self._widest) + self._unit_width() + 16, 24)

    def show_value(self, value: float) -> None:
        """Show a value, unless something is being typed."""
        self._value = value
        if not (self.hasFocus() and self.isModified()):
            self._show()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self._enter()
        self._show()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._enter()
        elif event.key() == Qt.Key.Key_Escape:
            self._show()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        painter = QPainter(self)
        painter.setFont(font("caption"))
        painter.setPen(tokens_of(self).text_caption)
        across = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        painter.drawText(self.rect().adjusted(0, 1, -6, 0), across, self._unit)

    def _make_room(self) -> None:
        self.setTextMargins(0, 0, self._unit_width(), 0)
        self.setFixedSize(self.sizeHint())

    def _unit_width(self) -> int:
        return self.fontMetrics().horizontalAdvance(self._unit) + 3 if self._unit else 0

    def _show(self) -> None:
        self.setText(number(self._value, self._digits, self._signed).replace(",", ""))
        self.setModified(False)
        set_tag(self, "wrong", False)

    def _enter(self) -> None:
        if not self.isModified():
            return
        value = read_figure(self.text())
        if value is None:
            set_tag(self, "wrong", True)
            self.selectAll()
            return
        self._value = value
        self._show()
        self.entered.emit(value)
