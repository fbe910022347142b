"""The sheet as a PDF file, with its type inside."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QBuffer, QIODevice, QMarginsF
from PySide6.QtGui import QPageLayout, QPageSize, QPainter, QPdfWriter

from app.report.pages import Pages
from app.report.painter import UNITS
from core.errors import ProjectError
from core.files.atomic_write import atomic_path
from core.messages import Message

_DOTS = 1200  # of the writer to an inch


def write_pdf(path: str | Path, pages: Pages, title: str) -> None:
    """Write the pages of a sheet, whole or not at all. Raises UserError if they cannot be written."""
    target, data = Path(path), QBuffer()
    data.open(QIODevice.OpenModeFlag.WriteOnly)
    if not _paint(_writer(data, title), pages):
        raise ProjectError(
            Message("{target} cannot be written: the pages could not be drawn.", target=str(target)),
            Message("Choose another folder."),
        )
    # Painted in memory first: of a disk that gets full Qt says nothing, half a sheet would count as written.
    with atomic_path(target) as partial:
        partial.write_bytes(data.data().data())


def _writer(data: QBuffer, title: str) -> QPdfWriter:
    writer = QPdfWriter(data)
    writer.setTitle(title)
    writer.setCreator("Busk")
    writer.setResolution(_DOTS)
    upright = QPageLayout.Orientation.Portrait
    writer.setPageLayout(QPageLayout(QPageSize(QPageSize.PageSizeId.A4), upright, QMarginsF(0, 0, 0, 0)))
    return writer


def _paint(writer: QPdfWriter, pages: Pages) -> bool:
    """Paint the pages, and return whether that went well."""
    painter = QPainter()
    if not painter.begin(writer):
        return False
    scale = _DOTS / 25.4 / UNITS
    for page in range(pages.count):
        if page and not writer.newPage():
            return False
        painter.resetTransform()
        painter.scale(scale, scale)
        pages.paint(painter, page)
    return painter.end()
