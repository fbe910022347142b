"""The groove of a line's slider: how far the line can go, seen before it is tried."""

from __future__ import annotations

import math
from collections.abc import Callable

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QPainter, QPen

from app.rendering.palette import Tokens
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


def ends_for(ratio: float) -> tuple[float, float]:
    """Return the range of a groove: the usual one, widened for a typed length that lies outside it [1]."""
    short, long = math.floor(20.0 * (ratio - _BESIDE)) / 20.0, math.ceil(20.0 * (ratio + _BESIDE)) / 20.0
    return (
        SHORTEST if ratio >= SHORTEST else max(short, 0.0),
        LONGEST if ratio <= LONGEST else long,
    )


def wall_of(leeway: LengthLimits | None, ratio: float) -> float | None:
    """Return the ratio at which a pull that begins at ``ratio`` meets the red, if it does [1]."""
    red = leeway.red_below if leeway is not None else None
    return red if red is not None and ends_for(ratio)[0] < red <= ratio else None


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
