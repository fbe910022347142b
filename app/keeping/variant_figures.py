"""The desk of the table of variants: kept up to date while it is seen, copied, written to a file."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer
from PySide6.QtGui import QGuiApplication

from app.keeping.dialogs import ask_save
from app.panels.variants import VariantsPanel
from app.presenting.run import PLOT_INTERVAL
from app.presenting.variants import as_table, variants_view
from app.wording.words import tr
from core.errors import UserError
from core.project import whole_file

if TYPE_CHECKING:
    from app.main_window import MainWindow

_TABLE = "table of variants"


class VariantFigures(QObject):
    """Fills the panel of variants; those that are not worked on are solved meanwhile."""

    def __init__(self, window: MainWindow, panel: VariantsPanel) -> None:
        super().__init__(window)
        self._window, self._panel = window, panel
        # The body is what has to follow the hand: figures may come later.
        self._clock = QTimer(self, interval=PLOT_INTERVAL, singleShot=True)
        self._clock.timeout.connect(self.refresh)
        panel.opened.connect(self.refresh)
        panel.beside_asked.connect(window.variant_desk.show_side_by_side)
        panel.copy_asked.connect(self.copy)
        panel.table_asked.connect(self.export)

    def follow(self) -> None:
        """Bring the table up to date soon, if it is seen."""
        if self._panel.isVisible() and not self._clock.isActive():
            self._clock.start()

    def refresh(self) -> None:
        """Bring the table up to date, and have solved what is not."""
        desk, document = self._window.variant_desk, self._window.session.document
        variants = desk.frames()
        if document is None or len(variants) < 2:
            self._panel.set_view(None)
            return
        self._panel.set_view(variants_view(variants, document.shown))
        desk.solve_others()

    def copy(self) -> None:
        """Put the table on the clipboard, its cells apart by tabs as spreadsheets take them."""
        if self._panel.view is not None:
            rows = ("\t".join(row) for row in as_table(self._panel.view))
            QGuiApplication.clipboard().setText("\n".join(rows) + "\n")
            self._window.notices.show_notice("ok", tr("The table is copied."))

    def export(self) -> None:
        """Ask for a place and write the table there."""
        window, view = self._window, self._panel.view
        name = f"{window.session.name}-variants.csv"
        path = ask_save(window, tr("Save the table of variants"), name, "CSV (*.csv)", ".csv")
        if not path or view is None:
            return
        try:
            # With the mark that tells spreadsheets that letters beyond English follow.
            with (
                whole_file(Path(path).absolute()) as partial,
                open(partial, "w", newline="", encoding="utf-8-sig") as file,
            ):
                csv.writer(file).writerows(as_table(view))
        except UserError as error:
            window.desk.show_failure(error, _TABLE)
        else:
            window.desk.show_written(_TABLE, tr("{name} written.").format(name=Path(path).name))
