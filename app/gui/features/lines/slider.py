"""Slider for the length of a line, in percent of its original length."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

import math
from collections.abc import Callable

from PySide6.QtCore import QPoint, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QBrush,
    QColor,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QWheelEvent,
)
from PySide6.QtWidgets import QAbstractSlider, QSizePolicy, QWidget

from app.gui.theme.stylesheet import tokens_of
from app.gui.widgets.amount_slider import paint_handle
from app.i18n.catalog import tr
from app.presenters.length_limits import hint
from app.rendering.palette import LINE_COLORS, Tokens
from core.analysis.length_limits.zones import AMBER, GREEN, RED, SLACK, LengthLimits

GROOVE_Y, GROOVE_HEIGHT = 11.0, 6.0
"""Middle of the groove below the slider's top, and its height [px]."""

SHORTEST, LONGEST = 0.80, 1.12
"""Range of a line's length, as a share of its length at rest [1], that a hand can pull it through."""

RESISTANCE = 24.0
"""How much further a hand must pull to get a line into the red [px]."""

STALE = 0.2
"""Strength of zones that are not up to date."""

_BESIDE = 0.02  # room beside a typed length that widens the groove [1]
_GAP = 1.5  # between two zones [px]
_QUIET = 0.42  # of those of a line that is not in hand


STEPS_TO_ONE = 100_000  # one step of the slider is 1/1000 %

_END_ROOM, _HANDLE_RADIUS = 13.0, 8.0

_SMALLEST_WEDGE = 0.0005  # a reached length nearer to the set one shows no wedge


def ends_for(ratio: float) -> tuple[float, float]:
    """Return the range of a groove: the usual one, widened for a typed length that lies outside it [1]."""
    short, long = math.floor(20.0 * (ratio - _BESIDE)) / 20.0, math.ceil(20.0 * (ratio + _BESIDE)) / 20.0
    return (
        SHORTEST if ratio >= SHORTEST else max(short, 0.0),
        LONGEST if ratio <= LONGEST else long,
    )


def wall_of(leeway: LengthLimits | None, ratio: float, short: float) -> float | None:
    """Return the ratio at which a pull from ``ratio`` towards ``short`` meets the red, if it does [1]."""
    red = leeway.red_below if leeway is not None else None
    return red if red is not None and short < red <= ratio else None


def resisted_ratio(ratio: float, wall: float | None, more: float) -> float:
    """Return what a hand gets that pulls to ``ratio``: past the wall it must pull ``more`` [1]."""
    return ratio if wall is None or ratio >= wall else min(ratio + more, wall)


def paint_groove(
    painter: QPainter,
    tokens: Tokens,
    x_of: Callable[[float], float],
    ends: tuple[float, float],
    leeway: LengthLimits | None,
    *,
    strong: bool,
    stale: bool,
) -> None:
    """Paint the groove between ``ends`` (ratios [1]); ``strong`` for a line that is in hand.

    Zones that are ``stale`` belong to the design before: they are faint until new ones come.
    """
    painter.setPen(Qt.PenStyle.NoPen)
    short, long = x_of(ends[0]), x_of(ends[1])
    groove = QRectF(short, GROOVE_Y - GROOVE_HEIGHT / 2, long - short, GROOVE_HEIGHT)
    painter.setBrush(QColor(tokens.groove))
    painter.drawRoundedRect(groove, 3, 3)
    opacity = painter.opacity()
    for tone, start, end in _zones(leeway, ends):
        left = x_of(start) + (_GAP / 2 if start > ends[0] else 0.0)
        right = x_of(end) - (_GAP / 2 if end < ends[1] else 0.0)
        zone = QRectF(left, groove.top(), max(right - left, 1.0), GROOVE_HEIGHT)
        painter.setBrush(QColor(tokens.panel))
        painter.drawRoundedRect(zone.adjusted(-_GAP, 0, _GAP, 0), 1, 1)
        painter.setOpacity(STALE if stale else 1.0 if strong else _QUIET)
        paint_zone(painter, tokens, zone, tone)
        painter.setOpacity(opacity)
    _tick(painter, x_of(1.0), QColor(tokens.control))


def _zones(leeway: LengthLimits | None, ends: tuple[float, float]) -> list[tuple[str, float, float]]:
    """Return tone, start and end of the zones that lie between the ends of the groove [1]."""
    zones = leeway.zones if leeway is not None else ()
    seen = [(zone.tone, max(zone.short, ends[0]), min(zone.long, ends[1])) for zone in zones]
    return [zone for zone in seen if zone[2] > zone[1]]


def paint_zone(painter: QPainter, tokens: Tokens, zone: QRectF, tone: str) -> None:
    """Paint one zone; where a line is slack the groove is hollow: nothing pulls there."""
    colours = {GREEN: tokens.zone_ok, AMBER: tokens.zone_warn, RED: tokens.zone_bad}
    if tone == SLACK:
        painter.setPen(QPen(QColor(tokens.outline), 1.0))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRoundedRect(zone.adjusted(0.5, 0.5, -0.5, -0.5), 2, 2)
        painter.setPen(Qt.PenStyle.NoPen)
        return
    painter.setBrush(QColor(colours[tone]))
    painter.drawRoundedRect(zone, 2, 2)
    if tone == RED:
        _hatch(painter, zone, QColor(tokens.panel))


def _hatch(painter: QPainter, zone: QRectF, colour: QColor) -> None:
    painter.save()
    painter.setClipRect(zone)
    painter.setPen(QPen(QBrush(colour), 1.2))
    x = zone.left() - zone.height()
    while x < zone.right():
        painter.drawLine(int(x), int(zone.bottom() + 1), int(x + zone.height() + 1), int(zone.top()))
        x += 4.0
    painter.restore()


def _tick(painter: QPainter, x: float, colour: QColor) -> None:
    """Mark the length at rest."""
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawRect(QRectF(x - 0.5, GROOVE_Y - GROOVE_HEIGHT / 2 - 3, 1, GROOVE_HEIGHT + 6))


class LengthSlider(QAbstractSlider):
    """A slider from 80 to 112 % with a wedge under the groove at the reached length.

    It is wider where a length beyond these was typed, until another length comes from elsewhere: what the
    slider sets itself never changes its range. The groove shows how far the line can go, and tells why where
    the pointer rests; a hand meets resistance in the red.

    ``previewed`` (share of the rest length) while the handle is dragged; ``committed`` once on release or at
    a key; ``cancelled`` when Esc ends a drag and the old value is back.
    """

    previewed = Signal(float)
    committed = Signal(float)
    cancelled = Signal()

    def __init__(self, color: str = LINE_COLORS[0], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._color = color
        self._reached: float | None = None
        self._leeway: LengthLimits | None = None
        self._stale = False
        self._strong = False
        self._before_drag = 0
        self._grip = 0.0
        self._wall: float | None = None
        self._previewed = False
        self.setOrientation(Qt.Orientation.Horizontal)
        self._ends = SHORTEST, LONGEST
        self.setSingleStep(STEPS_TO_ONE // 1000)
        self.setPageStep(STEPS_TO_ONE // 100)
        self.set_ratio(1.0)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def sizeHint(self) -> QSize:
        return QSize(240, 28)

    def minimumSizeHint(self) -> QSize:
        return QSize(120, 28)

    def ends(self) -> tuple[float, float]:
        """Return from where to where it goes, as shares of the rest length [1]."""
        return self._ends

    def ratio(self) -> float:
        """Return the set length as a share of the rest length [1]."""
        return self.value() / STEPS_TO_ONE

    def set_ratio(self, ratio: float) -> None:
        """Show a set length; nothing is emitted, and a handle in the user's hand stays where it is.

        The length that it has already, such as one that was dragged to, leaves the range as it is.
        """
        if self.isSliderDown() or round(ratio * STEPS_TO_ONE) == self.value():
            return
        self._ends = ends_for(ratio)
        self.setRange(*(round(end * STEPS_TO_ONE) for end in self._ends))
        self.setValue(round(ratio * STEPS_TO_ONE))

    def set_reached(self, ratio: float | None) -> None:
        """Show the reached length as a share of the rest length [1], or none."""
        if ratio != self._reached:
            self._reached = ratio
            self.update()

    def set_color(self, color: str) -> None:
        """Set the colour of the handle to that of its line."""
        if color != self._color:
            self._color = color
            self.update()

    def set_leeway(self, leeway: LengthLimits | None, stale: bool = False) -> None:
        """Show how far the line can go, or that this is not known; ``stale``: of the design before."""
        if (leeway, stale) != (self._leeway, self._stale):
            self._leeway, self._stale = leeway, stale
            self.update()

    def set_strong(self, strong: bool) -> None:
        """Show the zones at full strength, as for the selected line."""
        if strong != self._strong:
            self._strong = strong
            self.update()

    def tip_at(self, place: QPoint) -> str:
        if self._leeway is None:
            return self.toolTip()
        known = hint(self._leeway, self._ratio_under(place.x()))
        told = tr("Computing length limits…") if self._stale else known
        return f"{told}\n\n{self.toolTip()}"

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            event.ignore()
            return
        self._before_drag, self._previewed = self.value(), False
        self._grip = event.position().x() - self.x_of(self.ratio())
        self._wall = wall_of(None if self._stale else self._leeway, self.ratio(), self._ends[0])
        self.setSliderDown(True)
        if abs(self._grip) > _HANDLE_RADIUS + 3:
            self._grip = 0.0
            self._drag_to(event.position().x())
        self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self.isSliderDown():
            self._drag_to(event.position().x() - self._grip)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self.isSliderDown() and event.button() == Qt.MouseButton.LeftButton:
            self.setSliderDown(False)
            if self._previewed:
                self.committed.emit(self.ratio())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = event.key()
        if key == Qt.Key.Key_Escape and self.isSliderDown():
            self._cancel_drag()
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Minus):
            self._step(-1, event.modifiers())
        elif key in (Qt.Key.Key_Right, Qt.Key.Key_Plus):
            self._step(1, event.modifiers())
        elif key == Qt.Key.Key_Backspace:
            self._commit(STEPS_TO_ONE)
        else:
            event.ignore()  # the arrows up and down belong to the list of lines

    def wheelEvent(self, event: QWheelEvent) -> None:
        turned = event.angleDelta().y() or event.angleDelta().x()
        if self.hasFocus() and turned:
            self._step(1 if turned > 0 else -1, event.modifiers())
            event.accept()
        else:
            event.ignore()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        strong = self._strong or self.underMouse() or self.isSliderDown()
        groove = tokens_of(self), self.x_of, self._ends, self._leeway
        paint_groove(painter, *groove, strong=strong, stale=self._stale)
        if self._leeway is None:
            self._paint_way(painter)
        if self._reached is not None and abs(self._reached - self.ratio()) > _SMALLEST_WEDGE:
            short, long = self._ends
            self._paint_wedge(painter, self.x_of(min(max(self._reached, short), long)))
        self._paint_handle(painter, QPointF(self.x_of(self.ratio()), GROOVE_Y))

    def _drag_to(self, x: float) -> None:
        more = self._ratio_at(x + RESISTANCE) - self._ratio_at(x)
        ratio = resisted_ratio(self._ratio_at(x), self._wall, more)
        before = self.value()
        self.setValue(round(round(ratio * 1000) * STEPS_TO_ONE / 1000))
        if self.value() != before:
            self._previewed = True
            self.previewed.emit(self.ratio())

    def _cancel_drag(self) -> None:
        self.setSliderDown(False)
        self.setValue(self._before_drag)
        self.cancelled.emit()

    def _step(self, direction: int, held: Qt.KeyboardModifier) -> None:
        step = self.singleStep()
        if held & Qt.KeyboardModifier.ShiftModifier:
            step *= 10
        elif held & Qt.KeyboardModifier.AltModifier:
            step //= 10
        self._commit(self.value() + direction * step)

    def _commit(self, value: int) -> None:
        before = self.value()
        self.setValue(value)
        if self.value() != before:
            self.committed.emit(self.ratio())

    def x_of(self, ratio: float) -> float:
        """Return where a ratio is on the groove [px]."""
        share = (ratio - self._ends[0]) / (self._ends[1] - self._ends[0])
        return _END_ROOM + share * (self.width() - 2 * _END_ROOM)

    def _ratio_at(self, x: float) -> float:
        share = (x - _END_ROOM) / max(self.width() - 2 * _END_ROOM, 1.0)
        return self._ends[0] + share * (self._ends[1] - self._ends[0])

    def _ratio_under(self, x: float) -> float:
        """Return the length that is told about at a place: on the handle the set one [1]."""
        if abs(x - self.x_of(self.ratio())) <= _HANDLE_RADIUS:
            return self.ratio()
        return min(max(self._ratio_at(x), self._ends[0]), self._ends[1])

    def _paint_way(self, painter: QPainter) -> None:
        """Darken the groove between the length at rest and the set one."""
        rest, here = self.x_of(1.0), self.x_of(self.ratio())
        color = QColor(tokens_of(self).text_caption)
        color.setAlpha(90)
        painter.setBrush(color)
        top = GROOVE_Y - GROOVE_HEIGHT / 2
        painter.drawRect(QRectF(min(rest, here), top, abs(rest - here), GROOVE_HEIGHT))

    def _paint_wedge(self, painter: QPainter, x: float) -> None:
        y = GROOVE_Y + GROOVE_HEIGHT / 2 + 5
        painter.setBrush(QColor(tokens_of(self).text))
        painter.drawPolygon(QPolygonF([QPointF(x, y), QPointF(x + 4, y + 5), QPointF(x - 4, y + 5)]))

    def _paint_handle(self, painter: QPainter, at: QPointF) -> None:
        paint_handle(painter, self, at, _HANDLE_RADIUS)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self._color if self.isEnabled() else tokens_of(self).control))
        painter.drawEllipse(at, 4.2, 4.2)
