"""A figure with its unit that reads as text and can be typed over."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal

from app.gui.theme.stylesheet import font
from app.gui.widgets.inline_edit import InlineEdit, read_number
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import number, tr
from app.i18n.lengths import length_number, read_length, shown_unit, widest_length


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
