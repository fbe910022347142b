"""Tables of figures that leave the window: copied, or written to a file."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtGui import QGuiApplication

from app.gui.widgets.file_dialogs import ask_save
from app.i18n.catalog import tr
from core.errors import UserError
from core.export.csv_cells import ENCODING, cell
from core.files.atomic_write import atomic_path

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow

Table = Sequence[Sequence[str]]
"""Cells row by row, a heading first."""


def copy_table(window: MainWindow, table: Table) -> None:
    """Put a table on the clipboard, its cells apart by tabs as spreadsheets take them."""
    lines = ("\t".join(str(cell(each)) for each in row) for row in table)
    QGuiApplication.clipboard().setText("".join(f"{line}\n" for line in lines))
    window.notifications.done(tr("The table is copied."))


def save_table(window: MainWindow, table: Table, title: str, ending: str) -> None:
    """Ask for a place under a ``title``, and write a table there; its name ends as told."""
    path = ask_save(window, title, f"{window.session.name}-{ending}.csv", "CSV (*.csv)", ".csv")
    if not path:
        return
    about = f"table of {ending}"
    try:
        with (
            atomic_path(Path(path).absolute()) as partial,
            open(partial, "w", newline="", encoding=ENCODING) as file,
        ):
            csv.writer(file).writerows([cell(each) for each in row] for row in table)
    except UserError as error:
        window.notifications.error(error, about)
    else:
        window.notifications.file_written(about, tr("{name} written.").format(name=Path(path).name), path)
