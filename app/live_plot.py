"""A live curve over the turns of a run, drawn so that a vibrating run can be read."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QColor, QPen, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from app.theme import font, label, tokens_of
from app.tokens import Tokens
from app.words import number, tr

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
    """A titled plot: the main curve strong, others faint, the exact answer dashed, a tolerance as a band."""

    def __init__(self, title: str, unit: str, least_span: float, tolerance: float = 0.0) -> None:
        super().__init__()
        self._least_span, self._tolerance = least_span, tolerance
        self._curves: tuple[Curve, ...] = ()
        self._exact: float | None = None
        self._exact_is_main = False
        self._range: tuple[float, float] | None = None
        self._smooth = True
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Expanding)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.head = QHBoxLayout()
        self.head.setContentsMargins(0, 0, 0, 0)
        self.head.setSpacing(6)
        self.head.addWidget(label(title, "title"))
        self.head.addWidget(label(unit, "caption"))
        self.head.addStretch(1)
        column.addLayout(self.head)
        self._plot = _bare_plot()
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
        self._smooth = refit
        self._fit(refit)
        self._draw()

    def drawn_as_envelope(self, curve: Curve) -> bool:
        """Return whether a curve flips so densely that its envelope is drawn."""
        turns = max(float(curve.turns[-1] - curve.turns[0]), 1.0) if len(curve.turns) else 1.0
        return flips_every_turn(curve.values) and self._plot.getViewBox().width() / turns < _DENSE_PX

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._draw()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._draw()

    def _fit(self, refit: bool) -> None:
        values = [curve.values[np.isfinite(curve.values)] for curve in self._curves]
        if self._exact is not None:
            values.append(np.array([self._exact]))
        if self._tolerance:
            values.append(np.array([-self._tolerance, self._tolerance]))
        together = np.concatenate([*values, np.empty(0)])
        low, high = (float(together.min()), float(together.max())) if len(together) else (0.0, 0.0)
        if self._range is not None and not refit:
            low, high = min(low, self._range[0]), max(high, self._range[1])
        slack = max(self._least_span - (high - low), 0.0) / 2
        self._range = (low - slack, high + slack)

    def _draw(self) -> None:
        tokens = tokens_of(self)
        self._plot.clear()
        low, high = self._range or (0.0, 1.0)
        last = max((float(curve.turns[-1]) for curve in self._curves if len(curve.turns)), default=0.0)
        self._draw_frame(tokens, low, high, max(last, 10.0))
        if self._tolerance:
            self._band(tokens)
        for curve in sorted(self._curves, key=lambda each: each.role != "ghost"):
            if len(curve.turns):
                self._draw_curve(curve, tokens)
        if self._exact is not None:
            color = tokens.accent if self._exact_is_main else tokens.exact_curve
            pen = self._pen(color, 2.0 if self._exact_is_main else 1.3)
            pen.setDashPattern([4, 4])
            self._plot.addItem(pg.InfiniteLine(self._exact, angle=0, pen=pen))

    def _draw_frame(self, tokens: Tokens, low: float, high: float, last: float) -> None:
        room = 0.08 * (high - low)
        self._plot.setRange(xRange=(0.0, last * 1.02), yRange=(low - room, high + room), padding=0)
        left, bottom = self._plot.getAxis("left"), self._plot.getAxis("bottom")
        values = round_ticks(low, high, 4 if self.height() > 110 else 3)
        digits = 0 if all(abs(v - round(v)) < 1e-9 for v in values) else 1
        if any(abs(v * 10 - round(v * 10)) > 1e-6 for v in values):
            digits = 2
        left.setTicks([[(value, number(value, digits)) for value in values]])
        turns = [turn for turn in round_ticks(0.0, last, 4) if turn < 0.95 * last]
        bottom.setTicks([[*((turn, f"{turn:.0f}") for turn in turns), (last, tr("turn"))]])
        for axis in (left, bottom):
            axis.setTextPen(QColor(tokens.text_caption))
        left.setPen(QPen(Qt.PenStyle.NoPen))
        bottom.setPen(QColor(tokens.outline))
        for value in values:
            self._plot.addItem(pg.InfiniteLine(value, angle=0, pen=self._pen(tokens.line, 1.0)))

    def _band(self, tokens: Tokens) -> None:
        fill = QColor(tokens.ok)
        fill.setAlphaF(0.13)
        within = (-self._tolerance, self._tolerance)
        band = pg.LinearRegionItem(
            within, "horizontal", brush=fill, pen=QPen(Qt.PenStyle.NoPen), movable=False
        )
        self._plot.addItem(band)

    def _draw_curve(self, curve: Curve, tokens: Tokens) -> None:
        name = {"main": "accent", "warning": "warn_mark", "ghost": "ghost_curve"}[curve.role]
        color, ghost = QColor(getattr(tokens, name)), curve.role == "ghost"
        if self.drawn_as_envelope(curve):
            self._draw_envelope(curve, color, ghost)
        else:
            color.setAlphaF(0.62 if ghost else 1.0)
            self._line(curve.turns, curve.values, self._pen(color, 1.0 if ghost else 2.0))
        if not ghost and np.isfinite(curve.values[-1]):
            dot = pg.ScatterPlotItem(
                [curve.turns[-1]],
                [curve.values[-1]],
                size=8 * self.devicePixelRatioF(),
                brush=QColor(getattr(tokens, name)),
                pen=self._pen(tokens.panel, 1.5),
            )
            self._plot.addItem(dot)

    def _draw_envelope(self, curve: Curve, color: QColor, ghost: bool) -> None:
        lower, upper = envelope(curve.values)
        zigzag, fill, edge = QColor(color), QColor(color), QColor(color)
        zigzag.setAlphaF(0.2 if ghost else 0.45)
        fill.setAlphaF(0.1 if ghost else 0.22)
        edge.setAlphaF(0.62 if ghost else 1.0)
        pen = self._pen(edge, 1.0 if ghost else 1.6)
        edges = [self._line(curve.turns, each, pen) for each in (lower, upper)]
        self._plot.addItem(pg.FillBetweenItem(*edges, brush=fill))
        self._line(curve.turns, curve.values, self._pen(zigzag, 1.0))

    def _line(self, turns: Numbers, values: Numbers, pen: QPen) -> pg.PlotDataItem:
        line = pg.PlotDataItem(turns, values, pen=pen, antialias=self._smooth)
        self._plot.addItem(line)
        return line

    def _pen(self, color: str | QColor, width: float) -> QPen:
        """Return a cosmetic pen ``width`` logical pixels wide; Qt counts its width in device pixels."""
        pen = QPen(QColor(color), width * self.devicePixelRatioF())
        pen.setCosmetic(True)
        return pen


def _bare_plot() -> pg.PlotWidget:
    """Return a plot without frame, buttons, menu or mouse."""
    plot = pg.PlotWidget(background=None)
    plot.setFrameShape(plot.Shape.NoFrame)
    plot.hideButtons()
    plot.setMenuEnabled(False)
    plot.setMouseEnabled(False, False)
    plot.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
    plot.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    for side in ("left", "bottom"):
        axis = plot.getAxis(side)
        axis.setTickPen(QColor(0, 0, 0, 0))  # a tick of no length still draws a dot
        axis.setStyle(
            tickLength=0, tickAlpha=0, tickFont=font("axis", tabular=True), hideOverlappingLabels=False
        )
    plot.getPlotItem().layout.setContentsMargins(0, 0, 12, 0)
    plot.getAxis("left").setWidth(34)
    plot.getAxis("bottom").setHeight(18)
    return plot
