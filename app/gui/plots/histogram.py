"""The distribution of a quantity, painted as bars; several series side by side."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QLineF, QPoint, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.gui.plots.painting import faded
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.tooltip import watch_tip
from app.i18n.catalog import number, tr
from app.presenters.batch_distribution import Distribution
from app.presenters.plots import digits_of, round_ticks
from app.rendering.palette import Tokens

SERIES_COLORS = ("accent", "more", "waist_curve", "belly_curve", "seat_curve")
"""Tokens of the colours of series, in their order."""

_LEFT, _RIGHT, _TOP, _BOTTOM = 34.0, 10.0, 10.0, 22.0
_LEGEND = 20.0


class Histogram(QWidget):
    """Bars over an axis of values, with round ticks; the tooltip of a bar is its range and counts."""

    def __init__(self) -> None:
        super().__init__()
        self.shown: Distribution | None = None
        self._words = ""
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Expanding)
        self.setMinimumHeight(150)
        self.setAccessibleName(tr("Distribution"))
        watch_tip(self)

    def sizeHint(self) -> QSize:
        return QSize(300, 230)

    def show_distribution(self, shown: Distribution | None, words: str = "") -> None:
        """Show a distribution, or ``words`` in its place."""
        self.shown, self._words = shown, words
        self.setAccessibleDescription(" ".join((shown.heading, *shown.summary)) if shown else words)
        self.update()

    def tip_at(self, place: QPoint) -> str:
        shown, area = self.shown, self._area()
        if shown is None or not area.contains(QPointF(place)):
            return ""
        count = len(shown.edges) - 1
        return shown.bin_text(min(int((place.x() - area.left()) / area.width() * count), count - 1))

    def _area(self) -> QRectF:
        several = self.shown is not None and len(self.shown.series) > 1
        top = _TOP + (_LEGEND if several else 0.0)
        return QRectF(self.rect()).adjusted(_LEFT, top, -_RIGHT, -_BOTTOM)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.shown is None:
            painter.setFont(font("secondary"))
            painter.setPen(QColor(tokens.text_caption))
            painter.drawText(
                self.rect(), Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, self._words
            )
            return
        area = self._area()
        _paint_counts(painter, self.shown, area, tokens)
        _paint_bars(painter, self.shown, area, tokens)
        _paint_axis(painter, self.shown, area, tokens)
        if len(self.shown.series) > 1:
            _paint_names(painter, [name for name, _ in self.shown.series], area, tokens)


def _paint_counts(painter: QPainter, shown: Distribution, area: QRectF, tokens: Tokens) -> None:
    """Paint hairlines at whole counts."""
    painter.setFont(font("axis", tabular=True))
    whole = [each for each in round_ticks(0.0, shown.most, 3) if each == round(each)] or [0.0, shown.most]
    for level in whole:
        y = round(area.bottom() - level / max(shown.most, 1.0) * area.height()) + 0.5
        painter.setPen(QColor(tokens.line))
        painter.drawLine(QLineF(area.left(), y, area.right(), y))
        painter.setPen(QColor(tokens.text_caption))
        room = QRectF(0.0, y - 8, _LEFT - 8, 16)
        painter.drawText(room, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, number(level, 0))


def _paint_bars(painter: QPainter, shown: Distribution, area: QRectF, tokens: Tokens) -> None:
    bins, series = len(shown.edges) - 1, len(shown.series)
    wide = area.width() / bins
    gap = min(2.0, 0.15 * wide)
    bar = (wide - gap) / series
    painter.setPen(Qt.PenStyle.NoPen)
    for number_, (_, counts) in enumerate(shown.series):
        color = getattr(tokens, SERIES_COLORS[number_ % len(SERIES_COLORS)])
        painter.setBrush(faded(color, 0.85))
        for place, count in enumerate(counts):
            high = count / max(shown.most, 1.0) * area.height()
            if high:
                left = area.left() + place * wide + gap / 2 + number_ * bar
                painter.drawRect(QRectF(left, area.bottom() - high, bar, high))


def _paint_axis(painter: QPainter, shown: Distribution, area: QRectF, tokens: Tokens) -> None:
    painter.setPen(QColor(tokens.outline))
    y = round(area.bottom()) + 0.5
    painter.drawLine(QLineF(area.left(), y, area.right(), y))
    painter.setFont(font("axis", tabular=True))
    painter.setPen(QColor(tokens.text_caption))
    first, last = shown.edges[0], shown.edges[-1]
    digits = digits_of(list(shown.ticks))
    for tick in shown.ticks:
        x = area.left() + (tick - first) / (last - first) * area.width()
        room = QRectF(x - 30, area.bottom() + 4, 60, 16)
        room.moveRight(min(room.right(), area.right() + _RIGHT + 16))
        painter.drawText(room, Qt.AlignmentFlag.AlignHCenter, number(tick, digits))


def _paint_names(painter: QPainter, names: Sequence[str], area: QRectF, tokens: Tokens) -> None:
    painter.setFont(font("caption"))
    x, y = area.left(), area.top() - _LEGEND + 4
    room = area.width() / len(names)
    for place, name in enumerate(names):
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(getattr(tokens, SERIES_COLORS[place % len(SERIES_COLORS)])))
        painter.drawRoundedRect(QRectF(x, y - 8, 9, 9), 2, 2)
        painter.setPen(QColor(tokens.text_quiet))
        text = painter.fontMetrics().elidedText(name, Qt.TextElideMode.ElideMiddle, int(room - 20))
        painter.drawText(QPointF(x + 14, y), text)
        x += room
