"""The bar of a map's legend: its colours, the numbers beside them, and a hand that sets the range."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QLinearGradient, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import number, tr
from app.i18n.lengths import shown_digits, shown_value
from app.presenters.maps import Mark

TICKS = 5
"""Numbers beside the bar, those at its ends included."""

BAR = QRectF(2.0, 12.0, 14.0, 168.0)
"""Where the colours are, within their widget [px]."""

SMALL = 92.0
"""The height of the colours where there is little room [px]."""

_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
_WORD = 13.0  # height of a word at a limit [px]
_PULL = 120.0  # pixels that an end is dragged to make the range smaller or larger by a factor of e


class LegendBar(QWidget):
    """The colours with their numbers; an end is dragged with ``dragged``, a double click is ``freed``."""

    dragged = Signal(bool, float)
    freed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.range_ = (0.0, 1.0)
        self._stops: Sequence[str] = ("#000000", "#FFFFFF")
        self._value: float | None = None
        self._grip: tuple[bool, float, tuple[float, float]] | None = None
        self._by_hand = False
        self._unit, self._digits, self._signed = "", 1, False
        self._marks: tuple[Mark, ...] = ()
        self._bar = QRectF(BAR)
        ends = tr("Maximum of the colour scale"), tr("Minimum of the colour scale")
        self.high, self.low = (ValueEdit("", name, widest="−100.0") for name in ends)
        for field in (self.high, self.low):
            field.setParent(self)
            field.setAlignment(_LEFT)
        self.setFixedWidth(self.sizeHint().width())
        self.set_small(False)
        self.say("")
        self.setCursor(Qt.CursorShape.SizeVerCursor)

    def sizeHint(self) -> QSize:
        return QSize(124, round(self._bar.bottom()) + 17)

    def say(self, note: str) -> None:
        """Show values and range in a tooltip."""
        how = tr("Drag an end or enter a value to set the range. Double-click for the automatic range.")
        set_tip(self, "\n".join(filter(None, (note, how))))

    def set_small(self, small: bool) -> None:
        """Set the short or the normal height."""
        self._bar.setHeight(SMALL if small else BAR.height())
        for field, y in ((self.high, self._bar.top()), (self.low, self._bar.bottom())):
            field.move(20, round(y) - field.height() // 2)
        self.setFixedHeight(self.sizeHint().height())
        self.update()

    def set_numbers(self, unit: str, digits: int, signed: bool, marks: Sequence[Mark]) -> None:
        """Write the numbers and limits of another map, whose values are in ``unit``."""
        self._unit, self._digits, self._signed, self._marks = unit, digits, signed, tuple(marks)
        for field in (self.high, self.low):
            field.set_unit(unit, digits, signed, named=False)
        self.show_ends()

    def set_range(self, low: float, high: float, stops: Sequence[str], by_hand: bool) -> None:
        """Show these ends and colours."""
        self.range_, self._stops, self._by_hand = (low, high), tuple(stops), by_hand
        self.show_ends()
        self.update()

    def set_value(self, value: float | None) -> None:
        """Mark a value, or none."""
        self._value = value
        self.update()

    def show_ends(self) -> None:
        """Write the numbers at the ends."""
        self.low.show_value(self.range_[0])
        self.high.show_value(self.range_[1])

    def y_of(self, value: float) -> float:
        """Return how far down a value stands [px]; beyond the ends at the ends."""
        low, high = self.range_
        part = (value - low) / (high - low) if high > low else 0.5
        return self._bar.bottom() - min(max(part, 0.0), 1.0) * self._bar.height()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        tokens = tokens_of(self)
        colours = QLinearGradient(self._bar.bottomLeft(), self._bar.topLeft())
        for place, stop in zip(np.linspace(0.0, 1.0, len(self._stops)), self._stops, strict=True):
            colours.setColorAt(float(place), QColor(stop))
        painter.setBrush(colours)
        painter.setPen(QPen(QColor(tokens.accent if self._by_hand else tokens.outline), 1.0))
        painter.drawRoundedRect(self._bar.adjusted(0.5, 0.5, -0.5, -0.5), 3.0, 3.0)
        painter.setFont(font("caption", tabular=True))
        low, high = self.range_
        digits = shown_digits(self._digits, self._unit)
        shown = [shown_value(float(value), self._unit) for value in np.linspace(low, high, TICKS)]
        if any(abs(value - round(value, digits)) > 1e-6 for value in shown):
            digits += 1  # rounded they would look uneven
        for value, written in zip(np.linspace(low, high, TICKS), shown, strict=True):
            y = self.y_of(float(value))
            painter.setPen(QPen(QColor(tokens.control), 1.0))
            painter.drawLine(QPointF(self._bar.right() + 1, y), QPointF(self._bar.right() + 4, y))
            if low < value < high:
                painter.setPen(QColor(tokens.text_quiet))
                painter.drawText(QRectF(27, y - 10, 60, 20), _LEFT, number(written, digits, self._signed))
        self._paint_marks(painter)
        if self._value is not None:
            self._paint_value(painter, self._value)

    def _paint_marks(self, painter: QPainter) -> None:
        """Paint the limits that lie within the range: a line over the colours, and a word that has room."""
        tokens, above = tokens_of(self), self._bar.bottom() + _WORD
        for value, tone, word in self._marks:
            if self.range_[0] < value <= self.range_[1]:
                y = self.y_of(value)
                above = min(y, above - _WORD)
                painter.setPen(QPen(QColor(getattr(tokens, tone)), 2.0))
                painter.drawLine(QPointF(self._bar.left(), y), QPointF(self._bar.right() + 4, y))
                painter.drawText(QRectF(62, above - 10, 90, 20), _LEFT, word)

    def _paint_value(self, painter: QPainter, value: float) -> None:
        tokens, y = tokens_of(self), self.y_of(value)
        painter.setPen(QPen(QColor(tokens.text), 2.0))
        painter.drawLine(QPointF(self._bar.left() - 2, y), QPointF(self._bar.right() + 6, y))
        pill = QRectF(96, y - 9, 54, 18)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.ink))
        painter.drawRoundedRect(pill, 4.0, 4.0)
        painter.setPen(QColor(tokens.on_ink))
        written = number(shown_value(value, self._unit), shown_digits(self._digits, self._unit), self._signed)
        painter.drawText(pill, Qt.AlignmentFlag.AlignCenter, written)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            is_high = self._signed or event.position().y() < self._bar.center().y()
            self._grip = (is_high, event.position().y(), self.range_)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._grip is None:
            return
        is_high, start, (low, high) = self._grip
        down = event.position().y() - start
        if self._signed and start > self._bar.center().y():
            down = -down  # the lower end goes the other way
        if is_high:
            fixed = 0.0 if self._signed else low
            self.dragged.emit(True, fixed + (high - fixed) * float(np.exp(-down / _PULL)))
        else:
            self.dragged.emit(False, high - (high - low) * float(np.exp(down / _PULL)))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._grip = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self._grip = None
        self.freed.emit()
