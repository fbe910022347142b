"""The picture that a project file carries: what the view shows, in the shape of a card of the start page."""

from __future__ import annotations

from PySide6.QtCore import QBuffer, QIODevice, QRect, Qt
from PySide6.QtGui import QImage

WIDTH, HEIGHT = 480, 456
"""Size of a picture [px]: twice that of a card, for fine screens."""

STATE = "Verdict"
"""Key of the level of the overall verdict on what the picture shows; results themselves are never stored."""


def project_picture(view: QImage, level: str) -> bytes:
    """Return the middle of what the ``view`` shows as a PNG file; ``level`` that of its verdict."""
    width, height = view.width(), view.height()
    across = min(width, height * WIDTH // HEIGHT)
    down = min(height, width * HEIGHT // WIDTH)
    middle = view.copy(QRect((width - across) // 2, (height - down) // 2, across, down))
    image = middle.scaled(
        WIDTH, HEIGHT, Qt.AspectRatioMode.IgnoreAspectRatio, Qt.TransformationMode.SmoothTransformation
    )
    image.setText(STATE, level)
    return png_of(image)


def png_of(image: QImage) -> bytes:
    """Return an image as the bytes of a PNG file."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    image.save(buffer, "PNG")  # type: ignore[call-overload]  # the stub asks for bytes, Qt for a text
    return bytes(buffer.data().data())
