"""The sheet of a panel that floats on the view, with its soft shadow: painted once a size, not a frame."""

from __future__ import annotations

import math
from functools import lru_cache

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPixmap

from app.rendering.palette import DARK, LIGHT

MARGINS = (10, 8, 10, 12)
"""Room for the shadow left of a sheet, above, right of it and below [px]."""

RADIUS = 10.0
"""Of the corners of a sheet [px]."""


@lru_cache(maxsize=32)
def floating_ground(width: int, height: int, ratio: float, dark: bool) -> QPixmap:
    """Return a sheet and its shadow, ``width`` by ``height`` [px] together, at ``ratio`` device pixels each.

    Whenever the view under it moves, a panel is painted anew: its shadow takes long and stays the same.
    """
    tokens = DARK if dark else LIGHT
    left, top, right, bottom = MARGINS
    result = QPixmap(math.ceil(width * ratio), math.ceil(height * ratio))
    result.setDevicePixelRatio(ratio)
    result.fill(Qt.GlobalColor.transparent)
    sheet = QRectF(0, 0, width, height).adjusted(left, top, -right, -bottom)
    painter = QPainter(result)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QColor(0, 0, 0, tokens.shadow_alpha))
    for spread in range(10):
        wider = sheet.adjusted(-spread, -spread, spread, spread).translated(QPointF(0, 3))
        painter.drawRoundedRect(wider, RADIUS + spread, RADIUS + spread)
    fill = QColor(tokens.floating)
    fill.setAlpha(tokens.floating_alpha)
    painter.setBrush(fill)
    painter.setPen(QColor(tokens.line))
    painter.drawRoundedRect(sheet.adjusted(0.5, 0.5, -0.5, -0.5), RADIUS, RADIUS)
    painter.end()
    return result
