"""A figure with its unit that reads as text and can be typed over."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import unicodedata

from PySide6.QtCore import QSize, Qt, Signal

from app.dress.theme import font
from app.dress.tip import set_tip
from app.panels.typed_field import TypedField, read_figure
from app.wording.words import number, tr

_LENGTHS = {"": 1.0, "mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, '"': 25.4}
"""Units that may be typed into a field of millimetres [mm]."""


class FigureField(TypedField):
    """Shows a value in ``unit`` with ``digits``; ``entered`` carries another one that was typed.

    Into a field of millimetres other units of length can be typed.
    """

    entered = Signal(float)

    def __init__(self, unit: str, name: str, *, digits: int = 1, signed: bool = False, widest: str) -> None:
        super().__init__(unit)
        self._digits, self._signed, self._widest = digits, signed, widest
        self._value = 0.0
        self.setFont(font("secondary", tabular=True))
        self.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.setProperty("kind", "number")
        self.setAccessibleName(name)
        set_tip(self, name)
        self._make_room()

    def set_unit(self, unit: str, digits: int, signed: bool) -> None:
        """Show values in another unit."""
        self._unit, self._digits, self._signed = unit, digits, signed
        self._make_room()

    def sizeHint(self) -> QSize:
        return QSize(self.fontMetrics().horizontalAdvance(self._widest) + self._unit_width() + 16, 24)

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
        return number(self._value, self._digits, self._signed).replace(",", "")

    def _read(self, text: str) -> float:
        value, factor = read_figure(text), 1.0
        if self._unit == "mm":  # who types another unit means it
            plain = unicodedata.normalize("NFKC", text).strip()
            unit = plain.lstrip("+-\N{MINUS SIGN}0123456789., ").lower()
            factor = _LENGTHS.get(unit, 0.0)
        if value is None or not factor:
            raise ValueError(tr("“{text}” is no number.").format(text=text))
        return value * factor

    def _take(self, value: float) -> None:
        self._value = value
        self.entered.emit(value)
