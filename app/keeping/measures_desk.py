"""The desk of the table of measures: worked out where it is seen, copied, written to a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.keeping.tables import copy_table, save_table
from app.panels.result import ResultPanel
from app.presenting.measures import as_table, measure_views
from app.presenting.verdict import doubt_of
from app.wording.words import tr
from core.live import Frame

if TYPE_CHECKING:
    from app.main_window import MainWindow


class MeasuresDesk(QObject):
    """Fills the panel of measures."""

    def __init__(self, window: MainWindow, panel: ResultPanel) -> None:
        super().__init__(window)
        self._window, self._panel = window, panel
        self._frame: Frame | None = None
        panel.opened.connect(self.refresh)
        panel.copy_asked.connect(lambda: copy_table(window, as_table(panel.rows)))
        panel.table_asked.connect(
            lambda: save_table(window, as_table(panel.rows), tr("Save the table of measures"), "measures")
        )

    def show_frame(self, frame: Frame) -> None:
        """Show the measures of a frame."""
        self._frame = frame
        self.refresh()

    def refresh(self) -> None:
        """Bring the table up to date, if it is seen; unseen it would cost each frame the same."""
        if self._frame is not None and self._panel.isVisible():
            self._panel.set_rows(measure_views(self._frame), doubt_of(self._frame))
