"""Files and tables that leave the window: written where the user wants them, or copied."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QMarginsF, QSizeF
from PySide6.QtGui import QGuiApplication, QPageLayout, QPageSize, QPainter
from PySide6.QtPrintSupport import QPrintDialog, QPrinter

from app.gui.widgets.file_dialogs import ask_save
from app.i18n.catalog import tr
from app.report.painter import UNITS
from app.report.pdf_file import PaintedPages
from core.errors import ProjectError, UserError
from core.export.csv_cells import Table, cell, write_table
from core.files.atomic_write import atomic_path
from core.messages import Message

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.session.notifications import Notifications


def write_file(
    notifications: Notifications, topic: str, path: str, write: Callable[[Path], object], sentence: str = ""
) -> None:
    """Write a file, and show that it was written, in a ``sentence`` with its {name}, or why it was not."""
    try:
        write(Path(path).absolute())
    except UserError as error:
        notifications.error(error, topic)
    else:
        sentence = sentence or tr("{name} saved.")
        notifications.file_written(topic, sentence.format(name=Path(path).name), path)


def write_whole(data: bytes) -> Callable[[Path], object]:
    """Return what writes ``data`` to a file, all of it or nothing."""

    def write(path: Path) -> None:
        with atomic_path(path) as partial:
            partial.write_bytes(data)

    return write


def copy_table(context: AppContext, table: Table) -> None:
    """Copy a table to the clipboard, its cells apart by tabs as spreadsheets take them."""
    lines = ("\t".join(str(cell(each)) for each in row) for row in table)
    QGuiApplication.clipboard().setText("".join(f"{line}\n" for line in lines))
    context.notifications.done(tr("Table copied."))


def save_table(context: AppContext, table: Table, title: str, ending: str) -> None:
    """Prompt for a file under a ``title``, and write a table there, with the given suffix."""
    name = f"{context.session.name}-{ending}.csv"
    path = ask_save(context.window, title, name, "CSV (*.csv)", ".csv")
    if path:
        write_file(context.notifications, f"table of {ending}", path, lambda to: write_table(to, table))


def print_pages(context: AppContext, pages: PaintedPages, name: str) -> None:
    """Ask for a printer, and print pages at their true size as the document ``name``."""
    printer = QPrinter(QPrinter.PrinterMode.HighResolution)
    printer.setDocName(name)
    size, upright = (
        QPageSize(QSizeF(*pages.size), QPageSize.Unit.Millimeter),
        QPageLayout.Orientation.Portrait,
    )
    printer.setPageLayout(QPageLayout(size, upright, QMarginsF(0, 0, 0, 0)))
    printer.setFullPage(True)
    if not QPrintDialog(printer, context.window).exec():
        return
    painter = QPainter()
    if not painter.begin(printer):
        texts = Message("The pages could not be printed."), Message("Choose another printer.")
        context.notifications.error(ProjectError(*texts), "print")
        return
    wished = range(pages.count)
    if printer.printRange() == QPrinter.PrintRange.PageRange:
        wished = wished[max(printer.fromPage() - 1, 0) : printer.toPage() or None]
    for page in wished:
        if page != wished[0]:
            printer.newPage()
        painter.resetTransform()
        scale = printer.resolution() / 25.4 / UNITS
        painter.scale(scale, scale)
        pages.paint(painter, page)
    painter.end()
    context.notifications.withdraw("print")
