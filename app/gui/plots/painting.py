"""A plot painted: grid, axes, curves. On the screen and on paper alike."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QByteArray, QDataStream, QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetrics, QPainter, QPainterPath, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import font, tokens_of
from app.i18n.catalog import number, tr
from app.presenters.model_options import control_texts
from app.presenters.plots import Curve, Numbers, Plotted, digits_of, envelope, flips_every_turn, round_ticks
from app.presenters.zones import zone_title
from app.rendering.palette import Tokens
from core.geometry.mesh import Floats

_ROOM = 0.08  # of the range of values, above and below
_END = 0.02  # of the turns, behind the last


# An element of a QPainterPath as QDataStream reads it: 0 moves to the point, 1 draws a line to it.
_ELEMENT = np.dtype([("kind", ">i4"), ("point", ">f8", 2)])


def curve_path(points: Floats) -> QPainterPath:
    """Return a polyline through ``points`` (n, 2) [px], broken where one is not finite.

    The points are handed to Qt as one block of memory: one call a point takes six times as long.
    """
    kept = np.flatnonzero(np.isfinite(points).all(axis=1))
    elements = np.zeros(len(kept), _ELEMENT)
    elements["point"] = points[kept]
    elements["kind"][1:] = np.diff(kept) == 1
    start_and_fill_rule = bytes(8)
    path = QPainterPath()
    stream = QDataStream(
        QByteArray(np.array(len(kept), ">i4").tobytes() + elements.tobytes() + start_and_fill_rule)
    )
    stream >> path
    return path


@dataclass(frozen=True)
class Scale:
    """Turns ``first`` to ``last`` and values ``low`` to ``high`` on ``area`` [px]."""

    area: QRectF
    first: float
    last: float
    low: float
    high: float

    def x(self, turn: float) -> float:
        """Return how far right a turn lies [px]."""
        return self.area.left() + (turn - self.first) * self.turn_width

    def y(self, value: float) -> float:
        """Return how far down a value lies [px]."""
        return self.area.bottom() - ((value - self.low) / self._span + _ROOM) * self._height

    def turn_at(self, x: float) -> float:
        """Return the turn that lies at ``x`` [px]."""
        return self.first + (x - self.area.left()) / self.turn_width

    @property
    def turn_width(self) -> float:
        """Return the width of one turn [px]."""
        return self.area.width() / ((1.0 + _END) * max(self.last - self.first, 1e-9))

    def path(self, turns: Numbers, values: Numbers) -> QPainterPath:
        """Return a curve [px], broken where a value is not finite."""
        x = self.area.left() + (turns - self.first) * self.turn_width
        y = self.area.bottom() - ((values - self.low) / self._span + _ROOM) * self._height
        return curve_path(np.column_stack((x, y)))

    def levels(self) -> list[float]:
        """Return the round values that get a line and a number."""
        return round_ticks(self.low, self.high, 4 if self.area.height() > 74 else 3)

    def turn_ticks(self) -> list[float]:
        """Return the round turns that get a number; the last piece is kept for the word."""
        ticks = round_ticks(self.first, self.last, 4)
        room = self.last - max(0.12 * (self.last - self.first), 52.0 / self.turn_width)
        return [tick for tick in ticks if tick < room and tick.is_integer()]

    @property
    def _span(self) -> float:
        return max(self.high - self.low, 1e-12)

    @property
    def _height(self) -> float:
        return self.area.height() / (1.0 + 2.0 * _ROOM)


LEFT, BOTTOM, RIGHT, TOP = 38.0, 18.0, 12.0, 2.0
"""Room about the curves: numbers on the left, turns below, and nothing else [px]."""

DENSE = 6.0
"""Turns nearer than this would melt into a block [px]."""

EVENT_HEIGHT = 6.0
"""Height of the tick of an event on the axis [px]."""

ROLE_COLORS = {
    **{"main": "accent", "warning": "warn_mark", "ghost": "ghost_curve"},
    **{"waist": "waist_curve", "belly": "belly_curve", "front": "belly_curve"},
    **{"seat-left": "seat_curve", "seat-right": "seat_curve"},
}
"""Colour tokens of the roles of curves."""

DASHED_ROLES = ("front", "seat-right")
"""Roles that share the colour of another one, and are dashed."""


def plot_area(room: QRectF) -> QRectF:
    """Return where the curves lie in the room of a plot [px]."""
    return room.adjusted(LEFT, TOP, -RIGHT, -BOTTOM)


def is_dense(curve: Curve, scale: Scale) -> bool:
    """Return whether a curve oscillates so densely that its envelope is drawn."""
    return flips_every_turn(curve.values) and scale.turn_width < DENSE


def paint_plot(
    painter: QPainter, plotted: Plotted, scale: Scale, tokens: Tokens, smooth: bool = True
) -> None:
    """Paint all of a plot; ``smooth`` edges take longer."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    _paint_levels(painter, plotted, scale, tokens)
    _paint_turns(painter, plotted, scale, tokens)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing, smooth)
    painter.save()
    # A pen is as wide as half of it beyond its line.
    painter.setClipRect(scale.area.adjusted(-4, -2, 6, 1))
    for curve in sorted(plotted.curves, key=lambda each: each.role != "ghost"):
        if len(curve.turns) > 1:
            _paint_curve(painter, curve, scale, tokens)
    if plotted.exact is not None:
        _paint_exact(painter, plotted, scale, tokens)
    painter.restore()


def _paint_levels(painter: QPainter, plotted: Plotted, scale: Scale, tokens: Tokens) -> None:
    area, levels = scale.area, scale.levels()
    digits, upright = digits_of(levels), Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
    painter.setFont(font("axis", tabular=True))
    for level in levels:
        y = round(scale.y(level))
        painter.setPen(QPen(QColor(tokens.line), 1))
        painter.drawLine(QLineF(area.left(), y, area.right() + RIGHT, y))
        painter.setPen(QColor(tokens.text_caption))
        room = QRectF(area.left() - LEFT, y - 8, LEFT - 6, 16)
        painter.drawText(room, upright, number(level, digits))
    if plotted.tolerance:
        top = max(scale.y(plotted.tolerance), area.top())
        foot = min(scale.y(-plotted.tolerance), area.bottom())
        if foot > top:
            band = QRectF(area.left(), top, area.width() + RIGHT, foot - top)
            painter.fillRect(band, faded(tokens.ok, 0.13))


def _paint_turns(painter: QPainter, plotted: Plotted, scale: Scale, tokens: Tokens) -> None:
    area = scale.area
    painter.setPen(QPen(QColor(tokens.outline), 1))
    ground = round(area.bottom())
    painter.drawLine(QLineF(area.left(), ground, area.right() + RIGHT, ground))
    painter.setPen(QColor(tokens.text_caption))
    for turn in scale.turn_ticks():
        room = QRectF(scale.x(turn) - 30, ground + 3, 60, 14)
        painter.drawText(room, Qt.AlignmentFlag.AlignCenter, number(turn, 0))
    end = QRectF(area.right() - 60, ground + 3, 60 + RIGHT - 2, 14)
    painter.drawText(end, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, tr("iteration"))
    painter.setPen(QPen(QColor(tokens.control), 1.6))
    for event in plotted.events:
        if scale.first <= event.turn <= scale.last:
            x = scale.x(event.turn)
            painter.drawLine(QLineF(x, ground - EVENT_HEIGHT, x, ground))


def _paint_curve(painter: QPainter, curve: Curve, scale: Scale, tokens: Tokens) -> None:
    ghost, color = curve.role == "ghost", getattr(tokens, ROLE_COLORS[curve.role])
    strong = QPen(faded(color, 0.62 if ghost else 1.0), 1 if ghost else 2)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    paths = [scale.path(curve.turns, curve.values)]
    if is_dense(curve, scale):
        lower, upper = (scale.path(curve.turns, each) for each in envelope(curve.values))
        area = QPainterPath(lower)
        area.connectPath(upper.toReversed())
        painter.fillPath(area, faded(color, 0.10 if ghost else 0.22))
        painter.setPen(QPen(faded(color, 0.2 if ghost else 0.45), 1))
        painter.drawPath(paths[0])
        strong.setWidthF(1.0 if ghost else 1.6)
        paths = [lower, upper]
    if curve.role in DASHED_ROLES:
        strong.setDashPattern([4, 3])
    painter.setPen(strong)
    for path in paths:
        painter.drawPath(path)
    if not ghost and np.isfinite(curve.values[-1]):
        paint_dot(painter, scale, curve.turns[-1], curve.values[-1], color, tokens)


def _paint_exact(painter: QPainter, plotted: Plotted, scale: Scale, tokens: Tokens) -> None:
    if plotted.exact is None:
        return
    main = plotted.exact_is_main
    pen = QPen(QColor(tokens.accent if main else tokens.exact_curve), 2.0 if main else 1.3)
    pen.setDashPattern([4, 3])
    painter.setPen(pen)
    y = scale.y(plotted.exact)
    painter.drawLine(QLineF(scale.area.left(), y, scale.area.right() + RIGHT, y))


def paint_dot(
    painter: QPainter, scale: Scale, turn: float, value: float, color: str, tokens: Tokens, size: float = 4.0
) -> None:
    """Paint a dot on a curve, with a ring that parts it from others."""
    painter.setPen(QPen(QColor(tokens.panel), 1.5))
    painter.setBrush(QColor(color))
    painter.drawEllipse(QPointF(scale.x(turn), scale.y(value)), size, size)


def faded(color: str, share: float) -> QColor:
    """Return a colour that covers only a share of what lies under it."""
    result = QColor(color)
    result.setAlphaF(share)
    return result


Entry = tuple[str, str, bool]
"""A name, the token of its colour, and whether its line is dashed."""


def legend_entries(roles: Mapping[str, str], exact: bool, exact_is_main: bool) -> list[Entry]:
    """Return the names of these runs by their roles, and of the exact answer if there is one."""
    texts = control_texts()
    entries = [(texts[name].curve, ROLE_COLORS[role], False) for name, role in roles.items()]
    answer = (texts["exact"].curve, "accent" if exact_is_main else "exact_curve", True)
    return [*entries, answer] if exact else entries


def zone_entries(zones: Iterable[str]) -> list[Entry]:
    """Return the names of the curves of these zones."""
    return [(zone_title(zone), ROLE_COLORS[zone], zone in DASHED_ROLES) for zone in zones]


def legend_width(entries: list[Entry]) -> int:
    """Return the room that a legend takes [px]."""
    wide = QFontMetrics(font("caption"))
    return max(sum(wide.horizontalAdvance(title) + 34 for title, _, _ in entries) - 9, 0)


def paint_legend(painter: QPainter, entries: list[Entry], at: QPointF, tokens: Tokens) -> None:
    """Paint a legend from ``at`` to the right, the middle of its line at that height."""
    painter.setFont(font("caption"))
    x = at.x()
    for title, token, dashed in entries:
        pen = QPen(QColor(getattr(tokens, token)), 2)
        if dashed:
            pen.setDashPattern([2.5, 1.5])
        painter.setPen(pen)
        painter.drawLine(QPointF(x + 2, at.y()), QPointF(x + 18, at.y()))
        painter.setPen(QColor(tokens.text_quiet))
        painter.drawText(QPointF(x + 23, at.y() + 4), title)
        x += painter.fontMetrics().horizontalAdvance(title) + 34


class Legend(QWidget):
    """A legend of its own."""

    def __init__(self) -> None:
        super().__init__()
        self.entries: list[Entry] = []

    def show_entries(self, entries: list[Entry]) -> None:
        """Show these names."""
        if entries != self.entries:
            self.entries = entries
            self.setFixedSize(legend_width(entries), 18)
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        paint_legend(QPainter(self), self.entries, QPointF(0.0, self.height() / 2), tokens_of(self))
