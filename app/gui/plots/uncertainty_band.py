"""The band round the curve of a section within which the skin may lie, and how wide that is in words."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPainterPath, QPen

from app.gui.theme.stylesheet import font
from core.geometry.mesh import Floats

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


def write_off(
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
