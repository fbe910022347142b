"""Pictures of the view for others: saved, copied, printed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QRect, QSize, Qt
from PySide6.QtGui import QGuiApplication, QImage, QPageLayout, QPainter
from PySide6.QtPrintSupport import QPrintDialog, QPrinter

from app.gui.file_export import write_file, write_whole
from app.gui.session.project_thumbnail import png_of
from app.gui.widgets.file_dialogs import ask_save
from app.i18n.catalog import tr
from core.errors import ProjectError
from core.messages import Message

if TYPE_CHECKING:
    from app.gui.context import AppContext

FINER = 2.0
"""Pixels of a picture for each one of the screen, in both directions."""


class ImageExportController(QObject):
    """Add to the menu of files what is done with a picture of what the view shows."""

    def __init__(self, context: AppContext) -> None:
        super().__init__(context.session)
        self._context = context
        context.view.tools.picture_requested.connect(self.save)
        do = context.actions
        do.rule("file")
        text = tr("Copy the view to the clipboard at high resolution")
        do.add("file", tr("Copy image"), "Ctrl+Shift+C", text, do=self.copy, of_document=True)
        text = tr("Print the view on one page")
        do.add("file", tr("Print image…"), tip=text, do=self.print_out, of_document=True)

    def save(self) -> None:
        """Prompt for a file and write the view."""
        name = f"{self._context.session.name}.png"
        path = ask_save(self._context.window, tr("Export image"), name, "PNG (*.png)", ".png")
        if path:
            write_file(self._context.notifications, "picture", path, write_whole(png_of(self._picture())))

    def copy(self) -> None:
        """Copy what the view shows to the clipboard."""
        QGuiApplication.clipboard().setImage(self._picture())
        self._context.notifications.done(tr("Image copied."))

    def print_out(self) -> None:
        """Prompt for a printer and print the view."""
        printer = QPrinter(QPrinter.PrinterMode.HighResolution)
        printer.setDocName(self._context.session.name)
        printer.setPageOrientation(QPageLayout.Orientation.Landscape)
        if not QPrintDialog(printer, self._context.window).exec():
            return
        picture, page = self._picture(), printer.pageLayout().paintRectPixels(printer.resolution())
        painter = QPainter()
        if not painter.begin(printer):
            texts = Message("The image could not be printed."), Message("Choose another printer.")
            self._context.notifications.error(ProjectError(*texts), "print")
            return
        painter.drawImage(fitted(picture.size(), page.size()), picture)
        painter.end()
        self._context.notifications.withdraw("print")

    def _picture(self) -> QImage:
        picture = self._context.view.picture(FINER)
        # Other programs take its pixels for pixels.
        picture.setDevicePixelRatio(1.0)
        return picture


def fitted(picture: QSize, page: QSize) -> QRect:
    """Return where a picture lies on a page: as large as goes, in its middle across, at its head [px]."""
    size = picture.scaled(page, Qt.AspectRatioMode.KeepAspectRatio)
    return QRect((page.width() - size.width()) // 2, 0, size.width(), size.height())
