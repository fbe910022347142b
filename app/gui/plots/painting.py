"""A plot painted: grid, axes, curves. On the screen and on paper alike."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from app.gui.plots.axes import Scale
from app.gui.theme.stylesheet import font
from app.i18n.catalog import number, tr
from app.presenters.plots import Curve, Plotted, digits_of, envelope, flips_every_turn
from app.rendering.palette import Tokens

LEFT, BOTTOM, RIGHT, TOP = 38.0, 18.0, 12.0, 2.0
"""Room about the curves: numbers on the left, turns below, and nothing else [px]."""

DENSE = 6.0
"""Turns nearer than this would melt into a block [px]."""

EVENT_HEIGHT = 6.0
"""Height of the tick of an event on the axis [px]."""

ROLE_COLORS = {"main": "accent", "warning": "warn_mark", "ghost": "ghost_curve"}
"""Colour tokens of the roles of curves."""


def plot_area(room: QRectF) -> QRectF:
    """Return where the curves lie in the room of a plot [px]."""
    return room.adjusted(LEFT, TOP, -RIGHT, -BOTTOM)


def is_dense(curve: Curve, scale: Scale) -> bool:
    """Tell whether a curve flips so densely that its envelope is drawn."""
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
    painter.drawText(end, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, tr("turn"))
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
