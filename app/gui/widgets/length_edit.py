"""A length that reads as text and can be typed over, in percent or in the unit of lengths in use."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QFocusEvent

from app.gui.theme.stylesheet import font
from app.gui.widgets.inline_edit import InlineEdit
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import number, tr
from app.i18n.lengths import length_number, shown_unit
from app.presenters.messages import render
from core.errors import LineError
from core.mechanics.constraint_lines import length_ratio

_FOCUS = Qt.FocusReason
_BY_KEY = (_FOCUS.TabFocusReason, _FOCUS.BacktabFocusReason, _FOCUS.ShortcutFocusReason)


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
