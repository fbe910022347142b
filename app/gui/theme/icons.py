"""Icons: drawings in ``resources/icons`` that take their colour from the theme."""

from __future__ import annotations

from functools import lru_cache
from importlib import resources

from PySide6.QtCore import QByteArray, QRectF, QSize, Qt
from PySide6.QtGui import QIcon, QPainter, QPixmap
from PySide6.QtSvg import QSvgRenderer

SCALES = (1.0, 1.5, 2.0, 3.0)
"""Device pixels to one logical pixel that an icon is drawn for; between them Qt scales down."""

DISABLED_OPACITY = 0.38

OF_WINDOW = (16, 24, 32, 48, 64, 128, 256)
"""Widths of the picture of the program that window managers and task bars choose from [pixels]."""


@lru_cache(maxsize=512)
def icon(name: str, color: str, size: int, on_color: str | None = None) -> QIcon:
    """Return the drawing ``name`` in ``color``, ``size`` logical pixels wide, sharp at any screen scale.

    ``on_color`` is the colour while its button is on; a disabled button shows the drawing faint.
    Whoever gets it shares it. Raises FileNotFoundError for a drawing that does not exist.
    """
    result = QIcon()
    for state, ink in ((QIcon.State.Off, color), (QIcon.State.On, on_color or color)):
        for scale in SCALES:
            result.addPixmap(pixmap(name, ink, size, scale), QIcon.Mode.Normal, state)
            faint = pixmap(name, ink, size, scale, DISABLED_OPACITY)
            result.addPixmap(faint, QIcon.Mode.Disabled, state)
    return result


def program_icon() -> QIcon:
    """Return the picture of the program itself, in its own colours."""
    result = QIcon()
    for size in OF_WINDOW:
        result.addPixmap(pixmap("program/busk", "", size))
    return result


@lru_cache(maxsize=1024)
def pixmap(name: str, color: str, size: int, scale: float = 1.0, opacity: float = 1.0) -> QPixmap:
    """Return the drawing ``name`` as a picture of ``size`` logical pixels at ``scale`` device pixels each."""
    picture = QPixmap(QSize(round(size * scale), round(size * scale)))
    picture.setDevicePixelRatio(scale)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    painter.setOpacity(opacity)
    paint_icon(painter, name, color, QRectF(0, 0, size, size))
    painter.end()
    return picture


def paint_icon(painter: QPainter, name: str, color: str, rect: QRectF) -> None:
    """Paint the drawing ``name`` in ``color`` into ``rect``."""
    renderer = QSvgRenderer(QByteArray(_drawing(name).replace("currentColor", color).encode()))
    renderer.render(painter, rect)


@lru_cache(maxsize=256)
def _drawing(name: str) -> str:
    return (resources.files("resources") / "icons" / f"{name}.svg").read_text(encoding="utf-8")
