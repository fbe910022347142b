"""A value that reads as text and can be typed over: Enter takes what was typed, Esc brings it back."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import re
import unicodedata
from typing import Any

from PySide6.QtCore import QEvent, QPoint, QRectF, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFocusEvent,
    QHideEvent,
    QKeyEvent,
    QKeySequence,
    QPainter,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QApplication, QLabel, QLineEdit, QWidget

from app.gui.theme.stylesheet import font, set_tag, tokens_of
from app.gui.widgets.accessibility import announce
from app.i18n.catalog import tr

_FIGURE = re.compile(r"^\s*([+-]?\s*\d+(?:[.,]\d*)?)\s*[^\d\s]*\s*$")

_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


def keys_in_words() -> list[tuple[str, str]]:
    """Return what the keys do in a field that is typed into, ready to read."""
    return [("Enter", tr("Apply value")), ("Esc", tr("Cancel"))]


def read_number(text: str) -> float | None:
    """Return the figure that was typed, with or without a unit, or None if it is none."""
    plain = unicodedata.normalize("NFKC", text).replace("\N{MINUS SIGN}", "-")
    match = _FIGURE.match(plain)
    return float(match.group(1).replace(",", ".").replace(" ", "")) if match else None


def forget_refused() -> None:
    """Show the present value in the field that has the keyboard, if what it holds was refused."""
    field = QApplication.focusWidget()
    if isinstance(field, InlineEdit) and field.refused:
        field._show()


class InlineEdit(QLineEdit):
    """The part of a field that is alike for every kind of value; ``closed`` at Enter, once taken, or Esc.

    What cannot be is ringed in red, and a card under the field says why until something else is typed.
    """

    closed = Signal()

    def __init__(self, unit: str = "") -> None:
        super().__init__()
        self._unit = unit
        self.refused = False
        self._refusal: Refusal | None = None
        self._room = self.textMargins()
        self.textEdited.connect(self._widen)

    def event(self, event: QEvent) -> bool:
        # Once what was typed is taken, undo means the edit and not its letters.
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent):
            keys = QKeySequence.StandardKey.Undo, QKeySequence.StandardKey.Redo
            if not self.isModified() and any(event.matches(key) for key in keys):
                event.ignore()
                return False
        return super().event(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self._enter()
        self._show()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self._refuse("")

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._enter()
            if not self.isModified():
                self.closed.emit()
        elif event.key() == Qt.Key.Key_Escape:
            self._show()
            self.closed.emit()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        if self.isModified():
            return
        painter = QPainter(self)
        painter.setFont(font("caption"))
        painter.setPen(tokens_of(self).text_caption)
        painter.drawText(self.rect().adjusted(0, 1, -7, 0), _RIGHT, self._unit)

    def _words(self) -> str:
        """Return the present value as it is shown."""
        raise NotImplementedError

    def _read(self, text: str) -> Any:
        """Return the value that was typed. Raises ValueError, in words to be shown, if it cannot be."""
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
        if self._room.right():
            self.setTextMargins(self._room)
        self._refuse("")

    def _widen(self) -> None:
        """Leave the room of the unit to what is typed, which may have one of its own."""
        if self.textMargins().right():
            self._room = self.textMargins()
            self.setTextMargins(0, 0, 0, 0)
        self._refuse("")

    def _refuse(self, why: str) -> None:
        """Say why what is typed cannot be; no words take the refusal back."""
        self.refused = bool(why)
        set_tag(self, "wrong", bool(why))
        self.setAccessibleDescription(why)
        if self._refusal is None and why:
            self._refusal = Refusal(self)
        if self._refusal is not None:
            self._refusal.say(why)

    def _enter(self) -> None:
        if not self.isModified():
            return
        try:
            value = self._read(self.text())
        except ValueError as why:
            self._refuse(str(why))
            self.selectAll()
            return
        self.setModified(False)
        self._take(value)
        self._show()


class Refusal(QLabel):
    """A card that lies under a field, over whatever is there, and says why it is ringed in red."""

    def __init__(self, field: QWidget) -> None:
        super().__init__(field.window())
        self._field = field
        self.setFont(font("secondary"))
        self.setWordWrap(True)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setContentsMargins(10, 7, 10, 8)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        field.destroyed.connect(self.deleteLater)

    def say(self, why: str) -> None:
        """Show these words, or go if there are none."""
        self.setText(why)
        self.setVisible(bool(why))
        if not why:
            return
        field, window = self._field, self.parentWidget()
        assert window is not None
        wide = min(self.fontMetrics().horizontalAdvance(why) + 24, 290)
        self.resize(wide, self.heightForWidth(wide))
        corner = field.mapTo(window, QPoint(field.width() - wide, field.height() + 4))
        below = corner.y() + self.height() < window.height()
        top = corner.y() if below else corner.y() - field.height() - 8 - self.height()
        self.move(max(corner.x(), 4), top)
        self.raise_()
        announce(field, why)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(tokens.bad), 1))
        painter.setBrush(QColor(tokens.raised))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 7, 7)
        painter.end()
        super().paintEvent(event)
