"""Icons of the systems (.png, .ico, .icns), made of the drawings in resources/icons/program at packaging."""

from __future__ import annotations

import io
from pathlib import Path

from PIL import Image
from PySide6.QtCore import QBuffer, QRectF, Qt
from PySide6.QtGui import QImage, QPainter
from PySide6.QtSvg import QSvgRenderer

ROOT = Path(__file__).resolve().parent.parent
DRAWINGS = ROOT / "resources" / "icons" / "program"

ICO_SIZES = (16, 20, 24, 32, 40, 48, 64, 128, 256)
"""What Windows asks for at 100 to 250 %, and for large symbols [pixels]."""

ICNS_SIZES = (16, 32, 64, 128, 256, 512, 1024)
"""What macOS asks for, simple and doubled [pixels]."""


def picture(name: str, size: int) -> QImage:
    """Return a drawing as a picture of ``size`` by ``size`` pixels, clear around it."""
    renderer = QSvgRenderer(str(DRAWINGS / f"{name}.svg"))
    if not renderer.isValid():
        raise SystemExit(f"There is no drawing {name}.svg in {DRAWINGS}.")
    image = QImage(size, size, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    renderer.render(painter, QRectF(0, 0, size, size))
    painter.end()
    return image


def drawn(name: str, size: int) -> Image.Image:
    """Return a drawing as a picture that Pillow can put into files of several sizes."""
    buffer = QBuffer()
    picture(name, size).save(buffer, "PNG")
    return Image.open(io.BytesIO(buffer.data().data())).convert("RGBA")


def write_ico(name: str, path: Path) -> Path:
    """Write a drawing as an icon of Windows, each size drawn by itself."""
    return _write(path, "ICO", [drawn(name, size) for size in ICO_SIZES])


def write_icns(name: str, path: Path) -> Path:
    """Write a drawing as an icon of macOS, each size drawn by itself."""
    return _write(path, "ICNS", [drawn(name, size) for size in ICNS_SIZES])


def _write(path: Path, kind: str, pictures: list[Image.Image]) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    *smaller, largest = pictures
    sizes = [picture.size for picture in pictures]
    largest.save(path, kind, sizes=sizes, append_images=smaller)
    return path
