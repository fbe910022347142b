"""Files and tables that leave the window: written where the user wants them, or copied."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtGui import QGuiApplication

from app.gui.widgets.file_dialogs import ask_save
from app.i18n.catalog import tr
from core.errors import UserError
from core.export.csv_cells import Table, cell, write_table
from core.files.atomic_write import atomic_path

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
