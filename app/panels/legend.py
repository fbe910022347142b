"""The legend of a map: what is shown, its colours and its range, which can be set by hand."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QLinearGradient, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QHBoxLayout, QMenu, QVBoxLayout, QWidget

from app.dress.parts import FloatingPanel, ToolButton
from app.dress.theme import font, label, tokens_of
from app.panels.figure_field import FigureField
from app.showing.live_plot import PullTitle, Quantity
from app.wording.words import number, tr

TICKS = 5
"""Numbers beside the bar, those at its ends included."""

WIDTH = 152
"""Width of what is inside the panel, whatever map it is [px]."""

BAR = QRectF(2.0, 12.0, 14.0, 168.0)
"""Where the colours are, within their widget [px]."""

SMALL = 92.0
"""The height of the colours where there is little room [px]."""

_WORD = 13.0  # height of a word at a limit [px]
_PULL = 120.0  # pixels that an end is dragged to make the range smaller or larger by a factor of e


@dataclass(frozen=True)
class MapKind:
    """A map that can be chosen: title, unit, what it means, in words a tooltip long, and a line below.

    ``both_ways``: its values go both ways from zero, and so does its range. ``marks`` are limits on its
    bar: value, tone and word.
    """

    name: str
    title: str
    unit: str
    tip: str
    note: str
    digits: int = 1
    both_ways: bool = False
    marks: tuple[tuple[float, str, str], ...] = ()


class Legend(FloatingPanel):
    """Title, bar and numbers.

    ``chosen`` carries another map, or an empty name to close; ``range_set`` low and high by hand;
    ``range_freed`` asks for the automatic one; ``flags_cleared`` for the values on the body to go.
    """

    chosen = Signal(str)
    range_set = Signal(float, float)
    range_freed = Signal()
    flags_cleared = Signal()
    theme_changed = Signal()

    def __init__(self, kinds: Sequence[MapKind], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._kinds = {kind.name: kind for kind in kinds}
        self._kind = kinds[0]
        column = QVBoxLayout()
        column.setContentsMargins(6, 2, 2, 2)
        column.setSpacing(4)
        head = QHBoxLayout()
        head.setSpacing(4)
        self.title = PullTitle([Quantity(kind.name, kind.title, kind.unit, 0.0) for kind in kinds])
        self.title.chosen.connect(self.chosen)
        self._add_to(self.title.menu)
        close = ToolButton("x", tr("Close the map  C"), size=14, room=24)
        close.clicked.connect(lambda: self.chosen.emit(""))
        head.addWidget(self.title)
        head.addStretch(1)
        head.addWidget(close)
        column.addLayout(head)
        self.bar = LegendBar()
        self.bar.pulled.connect(self._set_end)
        self.bar.freed.connect(self.range_freed)
        self.high, self.low = self.bar.high, self.bar.low
        self.high.entered.connect(lambda value: self._set_end(True, value))
        self.low.entered.connect(lambda value: self._set_end(False, value))
        column.addWidget(self.bar)
        self._note = label("", "caption")
        self._note.setWordWrap(True)
        column.addWidget(self._note)
        self.row.addLayout(column)
        self._note.setFixedWidth(WIDTH)
        self.bar.setFixedWidth(WIDTH)

    def show_map(self, name: str) -> None:
        """Show another map's title and words; nothing is emitted."""
        self._kind = kind = self._kinds[name]
        self.title.show_quantity(Quantity(kind.name, kind.title, kind.unit, 0.0))
        self.title.setToolTip(kind.tip)
        self.show_note(kind.note)
        self.bar.set_kind(kind)

    def show_note(self, note: str) -> None:
        """Say under the bar what the values are."""
        self._note.setText(note)
        self.bar.say(note)

    def set_small(self, small: bool) -> None:
        """Take less room: shorter, and what is said below the colours is said by a tip."""
        self.bar.set_small(small)
        self._note.setVisible(not small)

    def show_range(self, low: float, high: float, stops: Sequence[str], by_hand: bool) -> None:
        """Show the ends of the range and the colours from low to high."""
        self.bar.set_range(low, high, stops, by_hand)
        self.automatic.setEnabled(by_hand)

    def show_value(self, value: float | None) -> None:
        """Mark a value on the bar: that of the last flag on the body."""
        self.bar.set_value(value)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self.theme_changed.emit()

    def _add_to(self, menu: QMenu) -> None:
        menu.addSeparator()
        self.automatic = menu.addAction(tr("Automatic range"))
        self.automatic.triggered.connect(self.range_freed)
        menu.addAction(tr("Remove the values on the body")).triggered.connect(self.flags_cleared)

    def _set_end(self, is_high: bool, value: float) -> None:
        low, high = self.bar.range_
        if self._kind.both_ways:
            low, high = -abs(value), abs(value)
        elif is_high:
            high = value
        else:
            low = value
        if high - low > 0.0:
            self.range_set.emit(low, high)
        else:
            self.bar.show_ends()


class LegendBar(QWidget):
    """The colours with their numbers; an end is dragged with ``pulled``, a double click is ``freed``."""

    pulled = Signal(bool, float)
    freed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.range_ = (0.0, 1.0)
        self._stops: Sequence[str] = ("#000000", "#FFFFFF")
        self._value: float | None = None
        self._by_hand = False
        self._grip: tuple[bool, float, tuple[float, float]] | None = None
        self._digits, self._signed = 1, False
        self._marks: tuple[tuple[float, str, str], ...] = ()
        self._bar = QRectF(BAR)
        ends = tr("Highest value of the colours"), tr("Lowest value of the colours")
        self.high, self.low = (FigureField("", name, widest="−100.0") for name in ends)
        for field in (self.high, self.low):
            field.setParent(self)
            field.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.setFixedWidth(self.sizeHint().width())
        self.set_small(False)
        self.say("")
        self.setCursor(Qt.CursorShape.SizeVerCursor)

    def sizeHint(self) -> QSize:
        return QSize(124, round(self._bar.bottom()) + 17)

    def say(self, note: str) -> None:
        """Tell in a tip what the values are, and how their range is set."""
        how = tr("Drag an end or type a number to set the range; double click: automatic.")
        self.setToolTip("\n".join(filter(None, (note, how))))

    def set_small(self, small: bool) -> None:
        """Be shorter, or as high as usual."""
        self._bar.setHeight(SMALL if small else BAR.height())
        for field, y in ((self.high, self._bar.top()), (self.low, self._bar.bottom())):
            field.move(20, round(y) - field.height() // 2)
        self.setFixedHeight(self.sizeHint().height())
        self.update()

    def set_kind(self, kind: MapKind) -> None:
        """Write the numbers of another map."""
        self._digits, self._signed, self._marks = kind.digits, kind.both_ways, kind.marks
        for field in (self.high, self.low):
            field.set_unit("", kind.digits, kind.both_ways)
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
        digits = self._digits
        if any(abs(value - round(value, digits)) > 1e-6 for value in np.linspace(low, high, TICKS)):
            digits += 1  # rounded they would look uneven
        left = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        for value in np.linspace(low, high, TICKS):
            y = self.y_of(float(value))
            painter.setPen(QPen(QColor(tokens.control), 1.0))
            painter.drawLine(QPointF(self._bar.right() + 1, y), QPointF(self._bar.right() + 4, y))
            if low < value < high:
                painter.setPen(QColor(tokens.text_quiet))
                painter.drawText(QRectF(27, y - 10, 60, 20), left, number(float(value), digits, self._signed))
        self._paint_marks(painter)
        if self._value is not None:
            self._paint_value(painter, self._value)

    def _paint_marks(self, painter: QPainter) -> None:
        """Paint the limits that lie within the range: a line over the colours, and a word that has room."""
        tokens, above = tokens_of(self), self._bar.bottom() + _WORD
        left = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        for value, tone, word in self._marks:
            if self.range_[0] < value < self.range_[1]:
                y = self.y_of(value)
                above = min(y, above - _WORD)
                painter.setPen(QPen(QColor(getattr(tokens, tone)), 2.0))
                painter.drawLine(QPointF(self._bar.left(), y), QPointF(self._bar.right() + 4, y))
                painter.drawText(QRectF(62, above - 10, 90, 20), left, word)

    def _paint_value(self, painter: QPainter, value: float) -> None:
        tokens, y = tokens_of(self), self.y_of(value)
        painter.setPen(QPen(QColor(tokens.text), 2.0))
        painter.drawLine(QPointF(self._bar.left() - 2, y), QPointF(self._bar.right() + 6, y))
        pill = QRectF(96, y - 9, 54, 18)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.ink))
        painter.drawRoundedRect(pill, 4.0, 4.0)
        painter.setPen(QColor(tokens.on_ink))
        painter.drawText(pill, Qt.AlignmentFlag.AlignCenter, number(value, self._digits, self._signed))

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
            self.pulled.emit(True, fixed + (high - fixed) * float(np.exp(-down / _PULL)))
        else:
            self.pulled.emit(False, high - (high - low) * float(np.exp(down / _PULL)))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._grip = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self._grip = None
        self.freed.emit()
