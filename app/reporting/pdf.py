"""The sheet as a PDF file, with its type inside."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QMarginsF
from PySide6.QtGui import QPageLayout, QPageSize, QPainter, QPdfWriter

from app.reporting.pages import Pages
from app.reporting.paper import UNITS
from core.errors import ProjectError
from core.project import whole_file

_DOTS = 1200  # of the writer to an inch


def write_pdf(path: str | Path, pages: Pages, title: str) -> None:
    """Write the pages of a sheet, whole or not at all. Raises UserError if they cannot be written."""
    target = Path(path).absolute()
    with whole_file(target) as partial:
        writer = QPdfWriter(str(partial))
        writer.setTitle(title)
        writer.setCreator("Busk")
        writer.setResolution(_DOTS)
        writer.setPageLayout(
            QPageLayout(
                QPageSize(QPageSize.PageSizeId.A4), QPageLayout.Orientation.Portrait, QMarginsF(0, 0, 0, 0)
            )
        )
        painter = QPainter()
        if not painter.begin(writer):
            raise ProjectError(f"{target} cannot be written.", "Choose another folder.")
        scale = _DOTS / 25.4 / UNITS
        for page in range(pages.count):
            if page:
                writer.newPage()
            painter.resetTransform()
            painter.scale(scale, scale)
            pages.paint(painter, page)
        painter.end()
