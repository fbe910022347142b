"""The desk of the figures of variants, in a table and over their bodies: followed, copied, written."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from app.gui.features.variants.panel import VariantsPanel
from app.gui.widgets.table_export import copy_table, save_table
from app.i18n.catalog import tr
from app.presenters.plots import PLOT_INTERVAL
from app.presenters.variants import as_table, variant_titles, variants_view

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow


class VariantFigures(QObject):
    """Fills the panel of variants; those that are not worked on are solved meanwhile.

    What stands over the bodies of variants side by side is kept up to date as well.
    """

    def __init__(self, window: MainWindow, panel: VariantsPanel) -> None:
        super().__init__(window)
        self._window, self._panel = window, panel
        # The body is what has to follow the hand: figures may come later.
        self._clock = QTimer(self, interval=PLOT_INTERVAL, singleShot=True)
        self._clock.timeout.connect(self.refresh)
        panel.opened.connect(self.refresh)
        panel.beside_asked.connect(window.variant_desk.flip_side_by_side)
        panel.copy_asked.connect(self.copy)
        panel.table_asked.connect(self.export)

    def follow(self) -> None:
        """Bring the figures up to date soon, if they are seen."""
        if (self._panel.isVisible() or self._are_beside) and not self._clock.isActive():
            self._clock.start()

    def refresh(self) -> None:
        """Bring the figures up to date, and have solved what is not."""
        desk, document = self._window.variant_desk, self._window.session.document
        variants = desk.frames()
        if document is None or len(variants) < 2:
            self._panel.set_view(None)
            return
        if self._are_beside and len(self._window.view.panes.titles) == len(variants):
            self._window.view.panes.set_titles(variant_titles(variants, self._window.verdict_desk.of))
        if self._panel.isVisible():
            known = self._window.pressure_desk.of, self._window.verdict_desk.of
            self._panel.set_view(variants_view(variants, document.shown, *known))
            desk.solve_others()

    @property
    def _are_beside(self) -> bool:
        return self._window.view.beside.way == "variants"

    def copy(self) -> None:
        """Put the table on the clipboard."""
        if self._panel.view is not None:
            copy_table(self._window, as_table(self._panel.view))

    def export(self) -> None:
        """Ask for a place and write the table there."""
        if self._panel.view is not None:
            title = tr("Save the table of variants")
            save_table(self._window, as_table(self._panel.view), title, "variants")
