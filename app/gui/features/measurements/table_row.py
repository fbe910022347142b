"""Where a row of the table of measures stands, and how it is painted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

from PySide6.QtCore import QPoint, QRect, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetrics, QPainter

from app.gui.theme.stylesheet import faded, font
from app.presenters.measurements import MeasureView
from app.rendering.palette import Tokens

ROW, NAME, FOOT, EDGE = 30, 20, 30, 4
"""Heights of a row, of a name on a line of its own and of the buttons of an open row; the margin [px]."""

OFF = 13
"""What a row is higher by where ± stands under its figures [px]."""

CELLS, BAR = (48, 54, 48), 28
"""Widths of the figures before, after and change, and of the bar [px]."""

LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
_WRAPPED = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
_FAINT = 0.5  # of what is of a former shape, or of none that is a result
_GAP = 4  # over each paragraph of an open row


@dataclass(frozen=True)
class RowGeometry:
    """Where a row stands: ``wide`` if its name takes a line of its own, ``opened`` if it tells its details.

    ``mixed`` if its unit is not that of the heading.
    """

    view: MeasureView
    top: int
    width: int
    mixed: bool
    opened: bool = False

    @cached_property
    def wide(self) -> bool:
        """Whether the name does not fit beside the figures."""
        advance = _advance(self.view.label, "body")
        if self.mixed:
            advance += 10 + _advance(self.view.unit_shown, "caption")
        return self.view.known and advance > name_width(self.width, alone=False)

    @property
    def figures(self) -> int:
        """Where the line with the figures begins."""
        return self.top + (NAME if self.wide else 0)

    @property
    def line(self) -> int:
        """How high the line with the figures is, with ± under them [px]."""
        return ROW + (OFF if self.view.off else 0)

    @cached_property
    def texts(self) -> list[tuple[str, str, QRect]]:
        """What stands under the figures: words, the kind of type, and where."""
        told = [(self.view.caption, "caption")] if self.view.caption else []
        told += [(each, "secondary") for each in self.view.details] if self.opened else []
        result, top = [], self.figures + self.line - 4
        for words, role in told:
            wide = max(self.width - 2 * EDGE, 60)
            high = _wrapped_height(words, role, wide)
            result.append((words, role, QRect(EDGE, top, wide, high)))
            top += high + (_GAP if self.opened else 0)
        return result

    @property
    def foot(self) -> QRect:
        """Where the buttons of an opened row of one's own stand."""
        low = self.texts[-1][2].bottom() + _GAP if self.texts else self.figures + self.line
        return QRect(EDGE, low, self.width - 2 * EDGE, FOOT if self.opened and self.view.own else 0)

    @cached_property
    def height(self) -> int:
        """How high the row is [px]."""
        high = self.figures + self.line - self.top
        if self.texts:
            high += sum(rect.height() for _, _, rect in self.texts)
        if self.opened:
            high += _GAP * (len(self.texts) + 1)
        return high + self.foot.height()

    def holds(self, place: QPoint) -> bool:
        """Tell whether a place lies on the row."""
        return self.top <= place.y() < self.top + self.height


@lru_cache(maxsize=1000)  # a table is laid out with each frame, and few of its words are others
def _advance(words: str, role: str) -> int:
    return QFontMetrics(font(role)).horizontalAdvance(words)


@lru_cache(maxsize=1000)
def _wrapped_height(words: str, role: str, width: int) -> int:
    return QFontMetrics(font(role)).boundingRect(QRect(0, 0, width, 1000), _WRAPPED, words).height()


def name_width(width: int, alone: bool) -> int:
    """Return the room for a name in a table so wide, ``alone`` on its line or beside the figures [px]."""
    return width - 2 * EDGE - (0 if alone else sum(CELLS) + BAR + 8)


def cells(width: int, top: float, height: float) -> list[QRectF]:
    """Return the cells before, after, change and bar of a line of a table so wide."""
    left = width - EDGE - BAR
    result = [QRectF(left, top, BAR, height)]
    left -= 6
    for room in reversed(CELLS):
        left -= room
        result.append(QRectF(left, top, room, height))
    return result[::-1]


def paint_row(
    painter: QPainter, tokens: Tokens, spot: RowGeometry, focused: bool, doubtful: bool = False
) -> None:
    """Paint a row; an opened one has a ground, and a rim if the keyboard is there.

    What is ``doubtful`` is no result: figures after and changes are pale, and no bar tells them.
    """
    view, wide = spot.view, spot.wide
    if spot.opened:
        painter.setPen(QColor(tokens.accent) if focused else Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.selected))
        painter.drawRoundedRect(QRectF(0.5, spot.top + 1.5, spot.width - 1, spot.height - 3), 5, 5)
    name = QRectF(
        EDGE,
        spot.top + (3 if wide else 0),
        name_width(spot.width, wide or not view.known),
        NAME if wide else ROW,
    )
    painter.setFont(font("body"))
    painter.setPen(QColor(tokens.text))
    shown = painter.fontMetrics().elidedText(view.label, Qt.TextElideMode.ElideRight, int(name.width()))
    painter.drawText(name, LEFT, shown)
    if spot.mixed and view.known:
        said = painter.fontMetrics().horizontalAdvance(view.label) + 6
        painter.setFont(font("caption"))
        painter.setPen(QColor(tokens.text_caption))
        painter.drawText(name.adjusted(said, 1, 0, 1), LEFT, view.unit_shown)
    if view.known:
        _paint_figures(painter, tokens, spot, doubtful)
    for words, role, room in spot.texts:
        painter.setFont(font(role))
        painter.setPen(QColor(tokens.text_caption if role == "caption" else tokens.text_quiet))
        painter.drawText(room, _WRAPPED, words)


def _paint_figures(painter: QPainter, tokens: Tokens, spot: RowGeometry, doubtful: bool) -> None:
    view, places = spot.view, cells(spot.width, spot.figures, ROW)
    pale = faded(tokens.text_caption, tokens.panel, _FAINT).name() if doubtful else ""
    values = (
        (view.before, "body", tokens.text_caption, False),
        (view.after, "body" if doubtful else "name", pale or tokens.text, False),
        (view.change, "body", pale or tokens.text_quiet, True),
    )
    for cell, (value, role, color, signed) in zip(places, values, strict=False):
        painter.setFont(font(role, tabular=True))
        painter.setPen(QColor(color))
        painter.drawText(cell, RIGHT, view.written(value, signed))
    if view.off:
        _paint_off(painter, tokens, spot)
    if view.change is not None and not doubtful:
        _paint_bar(painter, tokens, places[-1], view.change / _full_bar(view.unit))


def _paint_off(painter: QPainter, tokens: Tokens, spot: RowGeometry) -> None:
    """Paint how far figures may be off, under them."""
    painter.save()
    painter.setOpacity(painter.opacity() * (_FAINT if spot.view.off_faint else 1.0))
    painter.setFont(font("caption", tabular=True))
    painter.setPen(QColor(tokens.text_caption))
    for cell, off in zip(cells(spot.width, spot.figures + ROW - 9, OFF + 4), spot.view.off, strict=False):
        if off is not None:
            painter.drawText(cell, RIGHT, spot.view.written_off(off))
    painter.restore()


def _paint_bar(painter: QPainter, tokens: Tokens, cell: QRectF, share: float) -> None:
    middle = cell.center()
    length = min(max(share, -1.0), 1.0) * BAR / 2
    bar = QRectF(min(middle.x(), middle.x() + length), middle.y() - 3, abs(length), 6)
    painter.fillRect(bar, QColor(tokens.more if share > 0 else tokens.less))
    painter.fillRect(QRectF(middle.x() - 0.5, middle.y() - 7, 1, 14), QColor(tokens.control))


def _full_bar(unit: str) -> float:
    """Return the change that fills half a bar, in ``unit``."""
    return {"ml": 100.0, "mm": 30.0}.get(unit, 10.0)
