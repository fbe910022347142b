"""Painted pages as a PDF file, whole or not at all."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from PySide6.QtCore import QBuffer, QIODevice, QMarginsF, QSizeF
from PySide6.QtGui import QPageLayout, QPageSize, QPainter, QPdfWriter

from app.report.painter import UNITS
from core.errors import ProjectError
from core.files.atomic_write import atomic_path
from core.messages import Message

_DOTS = 1200  # of the writer to an inch


class PaintedPages(Protocol):
    """``count`` pages of one ``size`` [mm], each painted with ``painter.UNITS`` to a millimetre."""

    @property
    def count(self) -> int:
        """Return the number of pages."""

    @property
    def size(self) -> tuple[float, float]:
        """Return width and height of each page [mm]."""

    def paint(self, painter: QPainter, page: int) -> None:
        """Paint a page, counted from 0."""


def write_pdf(path: str | Path, pages: PaintedPages, title: str) -> None:
    """Write pages as a PDF, whole or not at all. Raises UserError if they cannot be written."""
    target, data = Path(path), QBuffer()
    data.open(QIODevice.OpenModeFlag.WriteOnly)
    if not _paint(_writer(data, title, pages.size), pages):
        raise ProjectError(
            Message("{target} cannot be written: the pages could not be drawn.", target=str(target)),
            Message("Choose another folder."),
        )
    # Painted in memory first: of a disk that gets full Qt says nothing, half a sheet would count as written.
    with atomic_path(target) as partial:
        partial.write_bytes(data.data().data())


def _writer(data: QBuffer, title: str, size: tuple[float, float]) -> QPdfWriter:
    writer = QPdfWriter(data)
    writer.setTitle(title)
    writer.setCreator("Busk")
    writer.setResolution(_DOTS)
    paper = QPageSize(QSizeF(*size), QPageSize.Unit.Millimeter)
    writer.setPageLayout(QPageLayout(paper, QPageLayout.Orientation.Portrait, QMarginsF(0, 0, 0, 0)))
    return writer


def _paint(writer: QPdfWriter, pages: PaintedPages) -> bool:
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
