"""Curves of a section in millimetres, both axes alike, with marked places; how far the curves are apart."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFocusEvent,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QWheelEvent,
)
from PySide6.QtWidgets import QWidget

from app.gui.plots.painting import curve_path
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import speak_value
from app.i18n.catalog import tr
from app.i18n.lengths import length_number, length_unit
from core.geometry.mesh import Floats

LEFT, BOTTOM, EDGE = 34.0, 18.0, 6.0
"""Room for the numbers of the axes, and round the curves [px]."""

_FINEST = 22.0  # grid lines are never nearer to each other [px]


@dataclass(frozen=True, eq=False)
class SectionDrawing:
    """What is drawn: curves of (k, 2) places [mm] by role, and pairs of marks (former, present), each (2,).

    Roles: "before" is dashed, "after" strong, "other" the mirrored side, "wished" what is asked for.
    ``home``, shape (2, 2) [mm], is the box that is seen first. ``bands`` are outlines, by role, of where the
    skin may lie; ``faint`` until all of it is known. ``most`` is where that is widest: the place and the way
    out, both (2,), and how far in words.
    """

    curves: dict[str, Sequence[Floats]] = field(default_factory=dict)
    marks: Sequence[tuple[Floats, Floats]] = ()
    home: Floats = field(default_factory=lambda: np.array([[-100.0, -100.0], [100.0, 100.0]]))
    bands: dict[str, list[Floats]] = field(default_factory=dict)
    faint: bool = False
    most: tuple[Floats, Floats, str] | None = None


class SectionPlot(QWidget):
    """The plot; ``pointed`` carries the place [mm] under the pointer, shape (2,), or None.

    The wheel zooms to the pointer, a drag moves, a double click shows all that changed again. With the
    keyboard arrows go along the curve, with Shift ten times as far.
    """

    pointed = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.setMouseTracking(True)
        self._drawn = SectionDrawing()
        self._centre, self._scale = np.zeros(2), 1.0  # [mm], [px/mm]
        self._moved = False
        self._last: QPointF | None = None
        self._mark: tuple[Floats, Floats, str] | None = None
        self._at: int | None = None
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAccessibleName(tr("Section curves"))

    def sizeHint(self) -> QSize:
        return QSize(244, 190)

    def show_curves(self, drawn: SectionDrawing, *, again: bool) -> None:
        """Draw these; ``again`` goes back to the box that is seen first."""
        self._drawn = drawn
        if again or not self._moved:
            self.go_home()
        self.update()

    def go_home(self) -> None:
        """Show the box that is seen first."""
        low, high = self._drawn.home
        room, self._moved = self._room(), False
        self._centre = 0.5 * (low + high)
        self._scale = float(min(room.width() / (high - low)[0], room.height() / (high - low)[1]))
        self.update()

    def show_gap(self, former: Floats | None, present: Floats | None = None, text: str = "") -> None:
        """Mark two places, each (2,) [mm], and write how far they are apart; None marks nothing."""
        self._mark = None if former is None or present is None else (former, present, text)
        speak_value(self, text)
        self.update()

    @property
    def gap(self) -> str:
        """Return the text of the distance between the curves, if any."""
        return "" if self._mark is None else self._mark[2]

    def to_pixels(self, places: Floats) -> Floats:
        """Return where flat places [mm] are drawn [px], both (k, 2)."""
        middle = self._room().center()
        away = (np.atleast_2d(places) - self._centre) * [self._scale, -self._scale]
        return np.asarray(away + np.array([middle.x(), middle.y()]))

    def to_mm(self, pixel: QPointF) -> Floats:
        """Return the flat place under a pixel, shape (2,) [mm]."""
        away = pixel - self._room().center()
        return np.asarray(self._centre + np.array([away.x(), -away.y()]) / self._scale)

    # -- painting

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        tokens = tokens_of(self)
        self._paint_grid(painter)
        painter.setClipRect(self._room())
        looks = {
            "before": QPen(QColor(tokens.ghost_curve), 1.4, Qt.PenStyle.DashLine),
            "other": QPen(QColor(tokens.warn_mark), 1.6),
            # Within its band a curve is thin, else it would cover what it stands in.
            "after": QPen(QColor(tokens.accent), 1.2 if self._drawn.bands else 2.2),
            "wished": QPen(QColor(tokens.accent), 1.6, Qt.PenStyle.DashLine),
        }
        for role, outlines in self._drawn.bands.items():
            for outline in outlines:
                paint_band(painter, self._path(outline), looks[role].color(), faint=self._drawn.faint)
        for role, pen in looks.items():
            painter.setPen(pen)
            for places in self._drawn.curves.get(role, ()):
                painter.drawPath(self._path(places))
        painter.setPen(QPen(QColor(tokens.floating), 1.5))
        old = tokens.warn_mark if "other" in self._drawn.curves else tokens.ghost_curve
        for former, present in self._drawn.marks:
            for place, colour in ((former, old), (present, tokens.accent)):
                painter.setBrush(QColor(colour))
                painter.drawEllipse(self._spot(place), 4.0, 4.0)
        painter.setClipping(False)
        if self._drawn.most is not None and not self._drawn.faint and self._mark is None:
            place, way, text = self._drawn.most
            write_uncertainty(
                painter, self._spot(place), way, text, self._room(), tokens.accent, self._taken()
            )
        if self._mark is not None:
            self._paint_gap(painter, *self._mark)
        if self.hasFocus():
            painter.setPen(QPen(QColor(tokens.accent), 2.0))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1.0, 1.0, -1.0, -1.0), 5.0, 5.0)

    def _paint_grid(self, painter: QPainter) -> None:
        tokens, room = tokens_of(self), self._room()
        step = grid_step(_FINEST / self._scale)
        low, high = self.to_mm(room.bottomLeft()), self.to_mm(room.topRight())
        painter.setFont(font("axis", tabular=True))
        for axis in (0, 1):
            for k in range(math.ceil(low[axis] / step), math.floor(high[axis] / step) + 1):
                place = self._centre.copy()
                place[axis] = k * step
                spot = self._spot(place)
                ends = (
                    (QPointF(spot.x(), room.top()), QPointF(spot.x(), room.bottom()))
                    if axis == 0
                    else (QPointF(room.left(), spot.y()), QPointF(room.right(), spot.y()))
                )
                painter.setPen(QPen(QColor(tokens.line), 1.0))
                painter.drawLine(*ends)
                if k % 2 == 0:
                    self._write(painter, axis, spot, length_number(k * step, 0))

    def _write(self, painter: QPainter, axis: int, spot: QPointF, text: str) -> None:
        painter.setPen(QColor(tokens_of(self).text_caption))
        if axis == 0:
            box = QRectF(spot.x() - 24, self.height() - BOTTOM + 1, 48, BOTTOM - 1)
            if box.right() < self.width() + 12 and box.left() > LEFT - 20:
                painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)
        else:
            box = QRectF(0, spot.y() - 8, LEFT - 5, 16)
            if box.top() >= 0:
                painter.drawText(box, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, text)

    def _paint_gap(self, painter: QPainter, former: Floats, present: Floats, text: str) -> None:
        tokens = tokens_of(self)
        start, end = self._spot(former), self._spot(present)
        painter.setPen(QPen(QColor(tokens.text), 1.6))
        painter.drawLine(start, end)
        painter.setPen(QPen(QColor(tokens.floating), 1.0))
        painter.setBrush(QColor(tokens.text))
        for spot in (start, end):
            painter.drawEllipse(spot, 3.0, 3.0)
        face = font("title", tabular=True)
        width = QFontMetricsF(face).horizontalAdvance(text) + 12
        room = self._room()
        left = min(max(end.x() + 10, room.left()), room.right() - width)
        pill = QRectF(left, min(max(end.y() - 24, room.top()), room.bottom() - 20), width, 20)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.ink))
        painter.drawRoundedRect(pill, 4.0, 4.0)
        painter.setFont(face)
        painter.setPen(QColor(tokens.on_ink))
        painter.drawText(pill, Qt.AlignmentFlag.AlignCenter, text)

    def _path(self, places: Floats) -> QPainterPath:
        return curve_path(self.to_pixels(places))

    def _taken(self) -> Floats:
        """Return where curves and marked places are drawn, (k, 2) [px]."""
        drawn = [places for each in self._drawn.curves.values() for places in each]
        drawn += [np.atleast_2d(place) for pair in self._drawn.marks for place in pair]
        return self.to_pixels(np.concatenate(drawn)) if drawn else np.zeros((0, 2))

    def _spot(self, place: Floats) -> QPointF:
        x, y = self.to_pixels(place)[0].tolist()
        return QPointF(x, y)

    def _room(self) -> QRectF:
        return QRectF(
            LEFT, EDGE, max(self.width() - LEFT - EDGE, 1.0), max(self.height() - BOTTOM - EDGE, 1.0)
        )

    # -- the keyboard

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}.get(Qt.Key(event.key()), 0)
        curves = self._drawn.curves.get("after") or self._drawn.curves.get("before") or ()
        if not step or not curves:
            super().keyPressEvent(event)
            return
        # The longest is that of the trunk; the others go round arms.
        places = max(curves, key=len)
        far = 10 * step if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else step
        start = int(places[:, 0].argmax()) if self._at is None else self._at
        self._at = (start + far) % len(places)
        self.pointed.emit(places[self._at])

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self._at = None
        self.pointed.emit(None)

    # -- the pointer

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        here = event.position()
        if self._last is not None:
            step = here - self._last
            self._centre = self._centre - np.array([step.x(), -step.y()]) / self._scale
            self._last, self._moved = here, True
            self.update()
        else:
            self.pointed.emit(self.to_mm(here) if self._room().contains(here) else None)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._last = event.position()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._last = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.go_home()

    def wheelEvent(self, event: QWheelEvent) -> None:
        here = self.to_mm(event.position())
        self._scale = float(np.clip(self._scale * 1.15 ** (event.angleDelta().y() / 120.0), 0.2, 60.0))
        self._centre = self._centre + here - self.to_mm(event.position())
        self._moved = True
        self.update()
        event.accept()

    def leaveEvent(self, event: QEvent) -> None:
        self.pointed.emit(None)


def grid_step(least: float) -> float:
    """Return the smallest of 1, 2, 5, 10, 20 .. mm, or 1/8, 1/4, 1/2, 1 .. in, not below ``least`` [mm]."""
    if length_unit() == "in":
        return 25.4 * max(2.0 ** math.ceil(math.log2(max(least, 1e-3) / 25.4) - 1e-9), 0.125)
    power = 10.0 ** math.floor(math.log10(max(least, 1e-3)))
    step = next(unit * power for unit in (1.0, 2.0, 5.0, 10.0) if unit * power >= least * (1.0 - 1e-9))
    return max(step, 1.0)


BAND_INK, EDGE_INK = 0.28, 0.65
"""How strong the band and its edges are, in parts of the curve's own ink."""

_EDGE = 0.8  # [px]
_AWAY = 13.0  # from the curve to the words [px]
_HIGH = 16.0
_CLEAR = 3.0  # about the words [px]


def paint_band(painter: QPainter, path: QPainterPath, colour: QColor, *, faint: bool) -> None:
    """Paint a band and its edges, which are seen even where it is hardly wider than its curve."""
    ground, edge = QColor(colour), QColor(colour)
    for ink, share in ((ground, BAND_INK), (edge, EDGE_INK)):
        ink.setAlphaF(share * (0.5 if faint else 1.0))
    path.setFillRule(Qt.FillRule.WindingFill)
    painter.fillPath(path, ground)
    painter.strokePath(path, QPen(edge, _EDGE))


def write_uncertainty(
    painter: QPainter, spot: QPointF, way: Floats, text: str, room: QRectF, ink: str, taken: Floats
) -> None:
    """Write outside a place of the curve how far it may be off; ``way`` (2,) is outward, up positive.

    ``taken`` (k, 2) [px] is what the words are not to lie on, if there is room beside it.
    """
    face = font("caption", tabular=True)
    wide = QFontMetricsF(face).horizontalAdvance(text)
    box = free_box(spot, way, wide, room, taken)
    if room.contains(box.center()):
        painter.setFont(face)
        painter.setPen(QColor(ink))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)


def free_box(spot: QPointF, way: Floats, wide: float, room: QRectF, taken: Floats) -> QRectF:
    """Return where words so ``wide`` [px] go beside a ``spot``: near, outward, and off what is ``taken``."""
    outward = np.asarray(way)
    boxes = [
        _box(spot, turned, step * _AWAY, wide, room)
        for step in (1.0, 2.0, 3.0)
        for turned in (outward, outward * (1.0, -1.0), -outward)
    ]
    return min(boxes, key=lambda box: _covered(box, taken))  # the first of those that cover as little


def _box(spot: QPointF, way: Floats, away: float, wide: float, room: QRectF) -> QRectF:
    left = spot.x() + away * way[0] - (wide if way[0] < 0.0 else 0.0)
    box = QRectF(left, spot.y() - away * way[1] - 0.5 * _HIGH, wide, _HIGH)
    box.moveLeft(min(max(box.left(), room.left()), room.right() - wide))
    box.moveTop(min(max(box.top(), room.top()), room.bottom() - _HIGH))
    return box


def _covered(box: QRectF, taken: Floats) -> int:
    low = np.array([box.left() - _CLEAR, box.top() - _CLEAR])
    high = np.array([box.right() + _CLEAR, box.bottom() + _CLEAR])
    return int(((taken > low) & (taken < high)).all(axis=1).sum())
