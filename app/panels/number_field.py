"""A length that reads as text and can be typed over, in percent or in millimetres."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import re
import unicodedata

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QLineEdit

from app.panels.length_slider import LONGEST, SHORTEST
from app.theme import font, set_tag, tokens_of
from app.words import number, tr

_MM_PER_UNIT = {"mm": 1.0, "cm": 10.0, "in": 25.4}
_FOCUS = Qt.FocusReason
_BY_KEY = (_FOCUS.TabFocusReason, _FOCUS.BacktabFocusReason, _FOCUS.ShortcutFocusReason)
_TYPED = re.compile(r"([+-]?)(\d+(?:\.\d*)?|\.\d+)(%|mm|cm|in)?")


def parse_length(text: str, rest_mm: float, whole_mm: float, unit: str = "%") -> float:
    """Return what was typed as a share of the rest length of the front part [1].

    ``94``, ``94%``, ``692mm``, ``69.2cm`` and ``27.2in`` are lengths; ``-6%`` and ``-20mm``, with a sign,
    change the rest length. ``unit`` is that of a bare number. A length is read as that of the whole band,
    ``whole_mm`` at rest, if only so it can be set. Raises ValueError for anything else.
    """
    plain = unicodedata.normalize("NFKC", text).replace("\N{MINUS SIGN}", "-").replace(",", ".")
    match = _TYPED.fullmatch(re.sub(r"\s+", "", plain).lower())
    if match is None:
        raise ValueError(f"no length: {text}")
    sign, figures, typed_unit = match.groups()
    value = float(sign + figures)
    typed_unit = typed_unit or unit
    if typed_unit == "%":
        share = value / 100
    else:
        share = value * _MM_PER_UNIT[typed_unit] / rest_mm
        of_whole = share - (whole_mm - rest_mm) / rest_mm
        if not sign and not _can_be_set(share) and _can_be_set(of_whole):
            share = of_whole
    ratio = 1.0 + share if sign else share
    if not _can_be_set(ratio):
        raise ValueError(f"no length: {text}")
    return ratio


def _can_be_set(ratio: float) -> bool:
    return SHORTEST <= round(ratio, 9) <= LONGEST


class NumberField(QLineEdit):
    """A number with its unit.

    ``opened`` when typing may begin, ``entered`` (share of the rest length) when another length was typed,
    ``left`` at Enter or Esc.
    """

    entered = Signal(float)
    opened = Signal()
    left = Signal()

    def __init__(self, unit: str) -> None:
        super().__init__()
        self._unit, self._ratio, self._rest_mm, self._whole_mm = unit, 1.0, 1.0, 1.0
        self.setFont(font("name" if unit == "%" else "body", tabular=True))
        self.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.setProperty("kind", "number")
        self.setTextMargins(0, 0, self._unit_width(), 0)
        self.setFixedSize(self.sizeHint())
        self.setToolTip(tr("Type 94, −6%, −20mm, 692mm or 69.2cm; from 80 to 112 % of the length at rest."))
        self.textEdited.connect(lambda _: set_tag(self, "wrong", False))

    def sizeHint(self) -> QSize:
        return QSize(self.fontMetrics().horizontalAdvance("100.0") + self._unit_width() + 18, 24)

    def show_length(self, ratio: float, rest_mm: float, whole_mm: float) -> None:
        """Show a set length, as a share of ``rest_mm`` [1], unless something is being typed."""
        self._ratio, self._rest_mm, self._whole_mm = ratio, rest_mm, whole_mm
        if not (self.hasFocus() and self.isModified()):
            self._show_number()

    def focusInEvent(self, event: QFocusEvent) -> None:
        super().focusInEvent(event)
        if event.reason() in _BY_KEY:
            self.selectAll()
        if event.reason() in (*_BY_KEY, _FOCUS.MouseFocusReason):
            self.opened.emit()  # not when a window only comes to the front

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self._enter()
        self._show_number()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._enter()
            if not self.isModified():
                self.left.emit()
        elif event.key() == Qt.Key.Key_Escape:
            self._show_number()
            self.left.emit()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        painter = QPainter(self)
        painter.setFont(font("caption"))
        painter.setPen(tokens_of(self).text_caption)
        painter.drawText(self.rect().adjusted(0, 1, -7, 0), _RIGHT, self._unit)

    def _unit_width(self) -> int:
        return 12 if self._unit == "%" else 21

    def _show_number(self) -> None:
        value = self._ratio * 100 if self._unit == "%" else self._ratio * self._rest_mm
        text = number(value).replace(",", "")
        if text != self.text():
            self.setText(text)
        self.setModified(False)
        set_tag(self, "wrong", False)

    def _enter(self) -> None:
        if not self.isModified():
            return
        try:
            ratio = parse_length(self.text(), self._rest_mm, self._whole_mm, self._unit)
        except ValueError:
            set_tag(self, "wrong", True)
            self.selectAll()
            return
        self._ratio = ratio
        self._show_number()
        self.entered.emit(ratio)


_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
