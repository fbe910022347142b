"""Chart of darts: round the bust point, the strain that a dart from each place of the border leaves."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import announce
from app.i18n.catalog import number, tr
from core.geometry.mesh import Floats

if TYPE_CHECKING:
    from core.pattern.dart_chart import Dart, DartChart

_ROOM = 26.0  # for the words round it [px]
_LEAST = 0.25  # of the radius, of the smallest strain [1]


class DartChartView(QWidget):
    """A spoke for each dart, as long as the strain that it leaves; ``chosen`` carries a Dart.

    The border of the piece runs round as it is seen from the front: up is up.
    """

    chosen = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.chart: DartChart | None = None
        self.dart: Dart | None = None
        self._limit = 0.0
        self._turn = 1.0
        self.setFixedHeight(190)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAccessibleName(tr("Remaining strain by dart position"))

    def sizeHint(self) -> QSize:
        return QSize(280, 190)

    def show_chart(self, chart: DartChart, limit: float) -> None:
        """Show what darts do for a piece, and the limit of its cloth [1]; the best one is chosen."""
        self.chart, self._limit = chart, limit
        # Clock positions run outward: to the right for the left breast as it is seen from the front.
        self._turn = -1.0 if chart.panel.endswith(" right") else 1.0
        self.dart = chart.best
        self.update()

    def _angles(self, darts: tuple[Dart, ...]) -> Floats:
        """Return the angle of each spoke from above, clockwise [rad]."""
        clocks = [dart.clock for dart in darts]
        if any(clock is None for clock in clocks):
            return np.linspace(0.0, 2.0 * np.pi, len(darts), endpoint=False)
        return self._turn * np.radians(np.array(clocks, dtype=np.float64))

    def _spots(self, radii: Floats, angles: Floats) -> Floats:
        middle = np.array([self.width(), self.height()]) / 2.0
        return np.asarray(middle + radii[:, None] * np.stack([np.sin(angles), -np.cos(angles)], axis=1))

    def _radii(self, strains: Floats) -> Floats:
        assert self.chart is not None
        most = max(self._most(), 1e-9)
        whole = 0.5 * min(self.width(), self.height()) - _ROOM
        return np.asarray(whole * (_LEAST + (1.0 - _LEAST) * np.minimum(strains / most, 1.0)))

    def _most(self) -> float:
        assert self.chart is not None
        return max([self._limit, *(dart.within for dart in self.chart.darts)])

    def _nearest(self, place: QPointF) -> Dart | None:
        if self.chart is None or not self.chart.darts:
            return None
        off = place - QPointF(self.width() / 2.0, self.height() / 2.0)
        angle = np.arctan2(off.x(), -off.y())
        away = np.cos(self._angles(self.chart.darts) - angle)
        return self.chart.darts[int(away.argmax())]

    def _choose(self, dart: Dart | None) -> None:
        if dart is not None:
            self.dart = dart
            self.update()
            announce(self, self.words())
            self.chosen.emit(dart)

    def words(self) -> str:
        """Return what the chosen dart leaves."""
        if self.dart is None:
            return tr("No dart can be flattened here.")
        strain = number(100.0 * self.dart.within, 1)
        if self.dart.clock is None:
            return tr("Dart from here: strain {strain} %").format(strain=strain)
        text = tr("Dart from {clock}°: strain {strain} %")
        return text.format(clock=number(self.dart.clock, 0), strain=strain)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._choose(self._nearest(event.position()))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._choose(self._nearest(event.position()))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        turn = {Qt.Key.Key_Right: 1, Qt.Key.Key_Left: -1}.get(Qt.Key(event.key()))
        if turn is None or self.chart is None or self.dart is None:
            event.ignore()
            return
        darts = self.chart.darts
        self._choose(darts[(darts.index(self.dart) + turn) % len(darts)])

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.chart is None or not self.chart.darts:
            painter.setFont(font("secondary"))
            painter.setPen(QColor(tokens.text_quiet))
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, self.words())
            return
        darts = self.chart.darts
        angles = self._angles(darts)
        spots = self._spots(self._radii(np.array([dart.within for dart in darts])), angles)
        middle = QPointF(self.width() / 2.0, self.height() / 2.0)
        for strain, ink, style in (
            (self._limit, tokens.warn_mark, Qt.PenStyle.DashLine),
            (self._most(), tokens.line, Qt.PenStyle.SolidLine),
        ):
            radius = float(self._radii(np.array([strain]))[0])
            painter.setPen(QPen(QColor(ink), 1.0, style))
            painter.drawEllipse(middle, radius, radius)
        order = np.argsort(angles % (2.0 * np.pi))
        painter.setPen(QPen(QColor(tokens.text_quiet), 1.4))
        painter.drawPolygon(QPolygonF([QPointF(*spot) for spot in spots[order].tolist()]))
        self._paint_spokes(painter, spots)
        painter.setFont(font("caption"))
        painter.setPen(QColor(tokens.text_caption))
        where = QRectF(self.rect()).adjusted(4, 2, -4, -2)
        limit = tr("dashed: limit {limit} %").format(limit=number(100.0 * self._limit, 0))
        painter.drawText(where, Qt.AlignmentFlag.AlignBottom | Qt.AlignmentFlag.AlignRight, limit)

    def _paint_spokes(self, painter: QPainter, spots: Floats) -> None:
        assert self.chart is not None
        tokens, middle = tokens_of(self), QPointF(self.width() / 2.0, self.height() / 2.0)
        for dart, (x, y) in zip(self.chart.darts, spots.tolist(), strict=True):
            chosen = dart is self.dart
            good = dart.within <= self._limit
            ink = tokens.accent if chosen else tokens.ok if good else tokens.warn_mark
            if chosen:
                painter.setPen(QPen(QColor(ink), 1.6))
                painter.drawLine(middle, QPointF(x, y))
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(ink))
            painter.drawEllipse(QPointF(x, y), 4.5 if chosen else 2.8, 4.5 if chosen else 2.8)
        painter.setBrush(Qt.BrushStyle.NoBrush)
