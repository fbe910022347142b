"""The values of variants, in a table and over their bodies: shown, copied, written."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from app.gui.features.variants.controller import VariantsController
from app.gui.features.variants.panel import VariantsPanel
from app.gui.file_export import copy_table, save_table
from app.i18n.catalog import tr
from app.presenters.assessment import AssessmentView
from app.presenters.plots import PLOT_INTERVAL
from app.presenters.variants import as_table, variant_titles, variants_view
from core.garment.pressure_list import PressureList
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext


class VariantTableController(QObject):
    """Fill the panel of variants; those that are not worked on are solved meanwhile.

    What stands over the bodies of variants side by side is kept up to date as well.
    """

    def __init__(
        self,
        context: AppContext,
        panel: VariantsPanel,
        variants: VariantsController,
        pressures_of: Callable[[Frame], PressureList | None],
        assess: Callable[[Frame], AssessmentView],
    ) -> None:
        super().__init__(context.session)
        self._context, self._panel, self._variants = context, panel, variants
        self._pressures_of, self._assess = pressures_of, assess
        # The body is what has to follow the hand: figures may come later.
        self._clock = QTimer(self, interval=PLOT_INTERVAL, singleShot=True)
        self._clock.timeout.connect(self.refresh)
        panel.opened.connect(self.refresh)
        context.session.design_changed.connect(lambda _: self.follow())
        variants.solved.connect(self.follow)
        panel.beside_requested.connect(variants.flip_side_by_side)
        panel.copy_requested.connect(self.copy)
        panel.table_requested.connect(self.export)

    def follow(self) -> None:
        """Update the values soon, if visible."""
        if (self._panel.isVisible() or self._are_beside) and not self._clock.isActive():
            self._clock.start()

    def refresh(self) -> None:
        """Update the values, and solve unsolved variants."""
        document = self._context.session.document
        variants = self._variants.frames()
        if document is None or len(variants) < 2:
            self._panel.set_view(None)
            return
        if self._are_beside and len(self._context.view.panes.titles) == len(variants):
            self._context.view.panes.set_titles(variant_titles(variants, self._assess))
        if self._panel.isVisible():
            known = self._pressures_of, self._assess
            self._panel.set_view(variants_view(variants, document.shown, *known))
            self._variants.solve_others()

    @property
    def _are_beside(self) -> bool:
        return self._context.view.beside.way == "variants"

    def copy(self) -> None:
        """Copy the table to the clipboard."""
        if self._panel.view is not None:
            copy_table(self._context, as_table(self._panel.view))

    def export(self) -> None:
        """Prompt for a file and write the table."""
        if self._panel.view is not None:
            title = tr("Export table of variants")
            save_table(self._context, as_table(self._panel.view), title, "variants")
