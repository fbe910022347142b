"""A live curve over the turns of a run, drawn so that a vibrating run can be read."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, QLineF, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QResizeEvent, QTransform
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from app.dress.theme import font, label, tokens_of
from app.wording.tokens import Tokens
from app.wording.words import number, tr

Numbers = NDArray[np.float64]

_FLIP_WINDOW = 24
_DENSE_PX = 6.0  # turns nearer than this would melt into a block


@dataclass(frozen=True, eq=False)
class Curve:
    """A run: ``turns`` (n,), ``values`` (n,); its role is main, warning (main, but vibrating) or ghost."""

    turns: Numbers
    values: Numbers
    role: str


def flips_every_turn(values: Numbers) -> bool:
    """Return whether the last values go up and down in turn, by more than a trifle."""
    recent = values[-_FLIP_WINDOW:]
    if len(recent) < 8 or not np.isfinite(recent).all():
        return False
    steps = np.diff(recent)
    flips = np.count_nonzero(steps[1:] * steps[:-1] < 0.0)
    span = float(np.ptp(values[np.isfinite(values)]))
    return bool(flips >= 0.8 * (len(steps) - 1) and np.abs(steps).mean() > 0.02 * span > 0.0)


def envelope(values: Numbers) -> tuple[Numbers, Numbers]:
    """Return lower and upper edge, each (n,), of values that flip: their own or their neighbours' mean."""
    padded = np.concatenate([values[1:2], values, values[-2:-1]])
    across = (padded[:-2] + padded[2:]) / 2.0
    return np.minimum(values, across), np.maximum(values, across)


def round_ticks(low: float, high: float, count: int = 4) -> list[float]:
    """Return about ``count`` round numbers from ``low`` to ``high``."""
    span = high - low
    if not (math.isfinite(span) and span > 0.0):
        return [low]
    rough = span / count
    unit = 10.0 ** math.floor(math.log10(rough))
    step = min((m * unit for m in (1, 2, 2.5, 5, 10)), key=lambda s: abs(span / s - count))
    first = math.ceil(low / step - 1e-9)
    return [i * step for i in range(first, math.floor(high / step + 1e-9) + 1)]


class LivePlot(QWidget):
    """A titled plot: the main curve strong, others faint, the exact answer dashed, a tolerance as a band.

    ``pointed`` carries the turn under the mouse, or None.
    """

    pointed = Signal(object)

    def __init__(self, title: str, unit: str, least_span: float, tolerance: float = 0.0) -> None:
        super().__init__()
        self._least_span, self._tolerance = least_span, tolerance
        self._curves: tuple[Curve, ...] = ()
        self._exact: float | None = None
        self._exact_is_main = False
        self._range = (0.0, 1.0)
        self._levels: list[float] = []
        self._pointed: float | None = None
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Expanding)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.head = QHBoxLayout()
        self.head.setContentsMargins(0, 0, 0, 0)
        self.head.setSpacing(6)
        self.head.addWidget(label(title, "title"))
        self.head.addWidget(label(unit, "caption"))
        self._readout = label("", "caption", tabular=True)
        self.head.addWidget(self._readout)
        self.head.addStretch(1)
        column.addLayout(self.head)
        self._plot, self._drawing = _bare_plot(), _Drawing(self)
        self._plot.addItem(self._drawing, ignoreBounds=True)
        self._plot.scene().sigMouseMoved.connect(self._follow)
        self._plot.setAccessibleName(f"{title} {unit}")
        column.addWidget(self._plot, 1)

    def set_curves(
        self,
        curves: Sequence[Curve],
        exact: float | None = None,
        *,
        exact_is_main: bool = False,
        refit: bool = True,
    ) -> None:
        """Draw these runs and the exact answer; without ``refit`` the range only grows, as during a drag."""
        self._curves, self._exact, self._exact_is_main = tuple(curves), exact, exact_is_main
        self._fit(refit)
        self._set_axes()

    def value_range(self) -> tuple[float, float]:
        """Return the lowest and the highest value that has room."""
        return self._range

    def drawn_as_envelope(self, curve: Curve) -> bool:
        """Return whether a curve flips so densely that its envelope is drawn."""
        turns = max(float(curve.turns[-1] - curve.turns[0]), 1.0) if len(curve.turns) else 1.0
        return flips_every_turn(curve.values) and self._plot.getViewBox().width() / turns < _DENSE_PX

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._plot.resetCachedContent()  # the view keeps a picture of its ground
            self._set_axes()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._set_axes()

    def leaveEvent(self, event: QEvent) -> None:
        self.pointed.emit(None)

    def point_at(self, turn: float | None) -> None:
        """Read out the strong curve at the nearest turn, or stop to."""
        strong = next((curve for curve in self._curves if curve.role != "ghost" and len(curve.turns)), None)
        self._pointed = None
        self._readout.setText("")
        if turn is not None and strong is not None:
            nearest = int(np.abs(strong.turns - turn).argmin())
            self._pointed = float(strong.turns[nearest])
            value = number(strong.values[nearest], 2)
            self._readout.setText(tr("turn {turn}: {value}").format(turn=f"{self._pointed:.0f}", value=value))
        self._drawing.update()

    def _follow(self, scene_at: QPointF) -> None:
        self.pointed.emit(self._drawing.mapFromScene(scene_at).x())

    def paint_curves(self, painter: QPainter, to_pixels: QTransform) -> None:
        """Paint all curves; ``to_pixels`` maps turns and values to pixels."""
        tokens = tokens_of(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint_grid(painter, to_pixels, tokens)
        for curve in sorted(self._curves, key=lambda each: each.role != "ghost"):
            if len(curve.turns) > 1:
                self._paint_curve(painter, to_pixels, curve, tokens)
        if self._pointed is not None:
            painter.setPen(QPen(QColor(tokens.control), 1))
            x, edges = to_pixels.map(QPointF(self._pointed, 0.0)).x(), painter.clipBoundingRect()
            painter.drawLine(QPointF(x, edges.top()), QPointF(x, edges.bottom()))
        if self._exact is not None:
            color = tokens.accent if self._exact_is_main else tokens.exact_curve
            pen = QPen(QColor(color), 2.0 if self._exact_is_main else 1.3)
            pen.setDashPattern([4, 3])
            painter.setPen(pen)
            painter.drawLine(_level(painter, to_pixels, self._exact))

    def _fit(self, refit: bool) -> None:
        """Set the range of values: all that is drawn, at least the smallest span worth seeing."""
        values = [curve.values[np.isfinite(curve.values)] for curve in self._curves]
        if self._exact is not None:
            values.append(np.array([self._exact]))
        if self._tolerance:
            values.append(np.array([-self._tolerance, self._tolerance]))
        together = np.concatenate([*values, np.empty(0)])
        low, high = (float(together.min()), float(together.max())) if len(together) else (0.0, 0.0)
        if not refit:
            low, high = min(low, self._range[0]), max(high, self._range[1])
        slack = max(self._least_span - (high - low), 0.0) / 2
        self._range = (low - slack, high + slack)

    def _set_axes(self) -> None:
        low, high = self._range
        ends = [(float(curve.turns[0]), float(curve.turns[-1])) for curve in self._curves if len(curve.turns)]
        first = min((end[0] for end in ends), default=0.0)
        last = max(max((end[1] for end in ends), default=0.0), first + 10.0)
        room = 0.08 * (high - low)
        within = (first, last + 0.02 * (last - first))
        self._plot.setRange(xRange=within, yRange=(low - room, high + room), padding=0)
        self._levels = round_ticks(low, high, 4 if self.height() > 110 else 3)
        digits = next((d for d in (0, 1, 2) if all(abs(v - round(v, d)) < 1e-9 for v in self._levels)), 3)
        room_for_word = last - 0.2 * (last - first)
        turns = [turn for turn in round_ticks(first, last, 4) if turn < room_for_word and turn.is_integer()]
        left, bottom = self._plot.getAxis("left"), self._plot.getAxis("bottom")
        left.setTicks([[(level, number(level, digits)) for level in self._levels]])
        bottom.setTicks([[*((turn, f"{turn:.0f}") for turn in turns), (last, tr("turn"))]])
        tokens = tokens_of(self)
        for axis in (left, bottom):
            axis.setTextPen(QColor(tokens.text_caption))
        left.setPen(QPen(Qt.PenStyle.NoPen))
        bottom.setPen(QColor(tokens.outline))
        self._drawing.update()

    def _paint_grid(self, painter: QPainter, to_pixels: QTransform, tokens: Tokens) -> None:
        painter.setPen(QPen(QColor(tokens.line), 1))
        for level in self._levels:
            painter.drawLine(_level(painter, to_pixels, level))
        if self._tolerance:
            upper = _level(painter, to_pixels, self._tolerance)
            lower = _level(painter, to_pixels, -self._tolerance)
            painter.fillRect(QRectF(upper.p1(), lower.p2()), _fade(tokens.ok, 0.13))

    def _paint_curve(self, painter: QPainter, to_pixels: QTransform, curve: Curve, tokens: Tokens) -> None:
        ghost = curve.role == "ghost"
        color = {"main": tokens.accent, "warning": tokens.warn_mark, "ghost": tokens.ghost_curve}[curve.role]
        path = _path(to_pixels, curve.turns, curve.values)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        if self.drawn_as_envelope(curve):
            lower, upper = (_path(to_pixels, curve.turns, each) for each in envelope(curve.values))
            painter.fillPath(_between(lower, upper), _fade(color, 0.10 if ghost else 0.22))
            painter.setPen(QPen(_fade(color, 0.2 if ghost else 0.45), 1))
            painter.drawPath(path)
            painter.setPen(QPen(_fade(color, 0.62 if ghost else 1.0), 1 if ghost else 1.6))
            painter.drawPath(lower)
            painter.drawPath(upper)
        else:
            painter.setPen(QPen(_fade(color, 0.62 if ghost else 1.0), 1 if ghost else 2))
            painter.drawPath(path)
        if not ghost and np.isfinite(curve.values[-1]):
            painter.setPen(QPen(QColor(tokens.panel), 1.5))
            painter.setBrush(QColor(color))
            painter.drawEllipse(to_pixels.map(QPointF(curve.turns[-1], curve.values[-1])), 4, 4)


class _Drawing(pg.GraphicsObject):  # type: ignore[misc]
    """All curves as one item, because one item a line costs a millisecond each time it is drawn anew."""

    def __init__(self, owner: LivePlot) -> None:
        super().__init__()
        self._owner = owner

    def boundingRect(self) -> QRectF:
        return QRectF(self.viewRect())

    def viewRangeChanged(self) -> None:
        self.prepareGeometryChange()

    def paint(self, painter: QPainter, *_: object) -> None:
        # In pixels, pens are as wide as they say at any screen scale.
        to_pixels = painter.transform()
        painter.resetTransform()
        self._owner.paint_curves(painter, to_pixels)


def _fade(color: str, share: float) -> QColor:
    result = QColor(color)
    result.setAlphaF(share)
    return result


def _level(painter: QPainter, to_pixels: QTransform, value: float) -> QLineF:
    """Return the line across the plot at ``value`` [px]."""
    y = to_pixels.map(QPointF(0.0, value)).y()
    edges = painter.clipBoundingRect()
    return QLineF(edges.left(), y, edges.right(), y)


def _path(to_pixels: QTransform, turns: Numbers, values: Numbers) -> QPainterPath:
    """Return the curve [px]; it is broken where a value is not finite."""
    x, y = to_pixels.m11() * turns + to_pixels.dx(), to_pixels.m22() * values + to_pixels.dy()
    return QPainterPath(pg.arrayToQPath(x, y, connect="finite"))


def _between(lower: QPainterPath, upper: QPainterPath) -> QPainterPath:
    """Return the area between two curves."""
    area = QPainterPath(lower)
    area.connectPath(upper.toReversed())
    return area


def _bare_plot() -> pg.PlotWidget:
    """Return a plot without frame, buttons, menu or mouse."""
    plot = pg.PlotWidget(background=None)
    plot.setFrameShape(plot.Shape.NoFrame)
    plot.hideButtons()
    plot.setMenuEnabled(False)
    plot.setMouseEnabled(False, False)
    plot.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
    plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    plot.getPlotItem().layout.setContentsMargins(0, 0, 12, 0)
    for axis in map(plot.getAxis, ("left", "bottom")):
        axis.setTickPen(QColor(0, 0, 0, 0))  # a tick of no length still draws a dot
        tick_font = font("axis", tabular=True)
        axis.setStyle(tickLength=0, tickAlpha=0, hideOverlappingLabels=False, tickFont=tick_font)
    plot.getAxis("left").setWidth(34)
    plot.getAxis("bottom").setHeight(18)
    return plot
