"""The stored picture of a project over the view while its body is computed."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPaintEvent, QRadialGradient
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import tokens_of

_STRENGTH = 0.55  # of the picture: not to be taken for the body that can be turned


class OpeningCover(QWidget):
    """Covers the view with a picture, which ends softly at its edges."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._picture = QImage()
        self.hide()

    def show_picture(self, picture: QImage | None) -> None:
        """Show a picture, or uncover the view without one."""
        if picture is None:
            self.hide()
        elif self.isHidden():
            self._picture = _faded_out(picture)
            self.show()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the picture in the middle, as high as the view."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.fillRect(self.rect(), QColor(tokens_of(self).app))
        size = self._picture.size().scaled(self.size(), Qt.AspectRatioMode.KeepAspectRatio)
        place = QRectF((self.width() - size.width()) / 2, 0, size.width(), size.height())
        painter.setOpacity(_STRENGTH)
        painter.drawImage(place, self._picture)


def _faded_out(picture: QImage) -> QImage:
    """Return a picture that becomes transparent towards its edges."""
    result = picture.convertToFormat(QImage.Format.Format_ARGB32_Premultiplied)
    middle, radius = QRectF(result.rect()).center(), max(result.width(), result.height()) / 2
    mask = QRadialGradient(middle, radius)
    mask.setColorAt(0.75, QColor(0, 0, 0, 255))
    mask.setColorAt(1.0, QColor(0, 0, 0, 0))
    painter = QPainter(result)
    painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_DestinationIn)
    painter.fillRect(result.rect(), mask)
    painter.end()
    return result
