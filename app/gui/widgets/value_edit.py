"""Fields in which values are typed: plain numbers, lengths, values with a unit."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

import re
import unicodedata
from typing import Any

from PySide6.QtCore import QEvent, QPoint, QRectF, QSize, Qt, Signal
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
from app.gui.widgets.basic import announce
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import number, tr
from app.i18n.lengths import length_number, read_length, shown_unit, widest_length
from app.presenters.messages import render
from core.errors import LineError
from core.mechanics.constraint_lines import length_ratio

_FIGURE = re.compile(r"^\s*([+-]?\s*\d+(?:[.,]\d*)?)\s*[^\d\s]*\s*$")

_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


_FOCUS = Qt.FocusReason

_BY_KEY = (_FOCUS.TabFocusReason, _FOCUS.BacktabFocusReason, _FOCUS.ShortcutFocusReason)


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


class LengthEdit(InlineEdit):
    """A number with its unit.

    ``opened`` when typing may begin, ``entered`` (share of the rest length) when another length was typed.
    """

    entered = Signal(float)
    opened = Signal()

    def __init__(self, unit: str) -> None:
        super().__init__(shown_unit(unit))
        self._ratio = self._rest_mm = self._whole_mm = 1.0
        self._line = ""
        self.setFont(font("name" if unit == "%" else "body", tabular=True))
        self.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.setProperty("kind", "number")
        self.setTextMargins(0, 0, self._unit_width(), 0)
        self.setFixedSize(self.sizeHint())
        sentence = tr(
            "Enter 94, −6%, −20mm, 440mm, 44cm or 17 1/4in: front length, 50 to 130 % of the original."
        )
        set_tip(self, sentence)
        self.name_line("")

    def sizeHint(self) -> QSize:
        widest = "100.0" if self._unit in ("%", "mm") else "100.00"
        return QSize(self.fontMetrics().horizontalAdvance(widest) + self._unit_width() + 15, 24)

    def name_line(self, title: str) -> None:
        """Set the line name for screen readers and errors."""
        self._line = title
        named = _named_in(self._unit)
        self.setAccessibleName(named.format(line=title or tr("Line")))

    def show_length(self, ratio: float, rest_mm: float, whole_mm: float) -> None:
        """Show a set length, as a share of ``rest_mm`` [1], unless something is being typed."""
        self._ratio, self._rest_mm, self._whole_mm = ratio, rest_mm, whole_mm
        self._follow()

    def focusInEvent(self, event: QFocusEvent) -> None:
        super().focusInEvent(event)
        if event.reason() in _BY_KEY:
            self.selectAll()
        if event.reason() in (*_BY_KEY, _FOCUS.MouseFocusReason):
            self.opened.emit()  # not when a window only comes to the front

    def _unit_width(self) -> int:
        return 12 if self._unit == "%" else 21

    def _words(self) -> str:
        if self._unit == "%":
            return number(self._ratio * 100)
        return length_number(self._ratio * self._rest_mm).replace(",", "")

    def _read(self, text: str) -> float:
        try:
            return length_ratio(text, self._line, self._rest_mm, self._whole_mm, self._unit)
        except LineError as refused:
            raise ValueError(render(refused.text)) from None

    def _take(self, value: float) -> None:
        self._ratio = value
        self.entered.emit(value)


def _named_in(unit: str) -> str:
    """Return what a field of a line's length in ``unit`` is called."""
    return {
        "%": tr("{line}: length in percent"),
        "mm": tr("{line}: length in millimetres"),
        "cm": tr("{line}: length in centimetres"),
        "in": tr("{line}: length in inches"),
    }[unit]


class ValueEdit(InlineEdit):
    """Shows a value in ``unit`` with ``digits``; ``entered`` carries another one that was typed.

    A value in "mm" is shown in the unit of lengths in use, and can be typed in any other.
    """

    entered = Signal(float)

    def __init__(self, unit: str, name: str, *, digits: int = 1, signed: bool = False, widest: str) -> None:
        super().__init__(shown_unit(unit))
        self._of = unit
        self._digits, self._signed, self._widest = digits, signed, widest
        self._value = 0.0
        self.setFont(font("secondary", tabular=True))
        self.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.setProperty("kind", "number")
        self.setAccessibleName(name)
        set_tip(self, name)
        self._make_room()

    def set_unit(self, unit: str, digits: int, signed: bool, *, named: bool = True) -> None:
        """Show values in another unit, which is not ``named`` where it is written beside the field."""
        self._of, self._unit = unit, shown_unit(unit) if named else ""
        self._digits, self._signed = digits, signed
        self._make_room()

    def sizeHint(self) -> QSize:
        widest = widest_length(self._widest, self._digits) if self._of == "mm" else self._widest
        return QSize(self.fontMetrics().horizontalAdvance(widest) + self._unit_width() + 16, 24)

    def show_value(self, value: float) -> None:
        """Show a value, unless something is being typed."""
        self._value = value
        self._follow()

    def _make_room(self) -> None:
        self.setTextMargins(0, 0, self._unit_width(), 0)
        self.setFixedSize(self.sizeHint())

    def _unit_width(self) -> int:
        return self.fontMetrics().horizontalAdvance(self._unit) + 3 if self._unit else 0

    def _words(self) -> str:
        written = length_number if self._of == "mm" else number
        return written(self._value, self._digits, self._signed).replace(",", "")

    def _read(self, text: str) -> float:
        value = read_length(text) if self._of == "mm" else read_number(text)
        if value is None:
            raise ValueError(tr("“{text}” is not a number.").format(text=text))
        return value

    def _take(self, value: float) -> None:
        self._value = value
        self.entered.emit(value)
