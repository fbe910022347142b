"""The plots of the strip as a figure for paper: side by side, in light colours, over one legend."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QBuffer, QIODevice, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtSvg import QSvgGenerator

from app.gui.plots.live_plot import LivePlot
from app.gui.plots.painting import Entry, legend_width, paint_legend, paint_plot, plot_area
from app.gui.theme.stylesheet import font
from app.rendering.palette import LIGHT

SIZE = QSize(960, 340)
"""Size of the figure [px]; a picture has three dots to each."""

_DOTS = 3
_MARGIN, _HEAD, _FOOT = 20.0, 28.0, 26.0


def figure_bytes(kind: str, plots: Sequence[LivePlot], legend: list[Entry]) -> bytes:
    """Return the figure as a file: ``png`` or ``svg``."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    if kind == "svg":
        drawing = QSvgGenerator()
        drawing.setOutputDevice(buffer)
        drawing.setSize(SIZE)
        drawing.setViewBox(QRectF(0, 0, SIZE.width(), SIZE.height()))
        drawing.setTitle("Busk")
        _paint(QPainter(drawing), plots, legend)
    else:
        image = QImage(SIZE * _DOTS, QImage.Format.Format_RGB32)
        image.setDevicePixelRatio(_DOTS)
        _paint(QPainter(image), plots, legend)
        image.save(buffer, "PNG")  # type: ignore[call-overload]  # the stub asks for bytes, Qt for a text
    return bytes(buffer.data().data())


def _paint(painter: QPainter, plots: Sequence[LivePlot], legend: list[Entry]) -> None:
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.fillRect(QRectF(0, 0, SIZE.width(), SIZE.height()), QColor(LIGHT.raised))
    width = (SIZE.width() - _MARGIN * (len(plots) + 1)) / len(plots)
    for place, plot in enumerate(plots):
        left = _MARGIN + place * (width + _MARGIN)
        _paint_title(painter, plot, QRectF(left, _MARGIN - 6, width, _HEAD))
        room = QRectF(left, _MARGIN + _HEAD, width, SIZE.height() - 2 * _MARGIN - _HEAD - _FOOT)
        # The same turns and values as in the window, on paper of another size.
        paint_plot(painter, plot.canvas.plotted, plot.canvas.scale(plot_area(room)), LIGHT)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    foot = SIZE.height() - _MARGIN - 2
    paint_legend(painter, legend, QPointF((SIZE.width() - legend_width(legend)) / 2, foot), LIGHT)
    painter.end()


def _paint_title(painter: QPainter, plot: LivePlot, room: QRectF) -> None:
    upright = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
    for text, role, ink in (
        (plot.quantity.title, "name", LIGHT.text),
        (plot.quantity.unit, "secondary", LIGHT.text_quiet),
    ):
        painter.setFont(font(role))
        painter.setPen(QColor(ink))
        painter.drawText(room, upright, text)
        room = room.adjusted(painter.fontMetrics().horizontalAdvance(text) + 7, 0, 0, 0)
