"""The garment: the cut list of a body that rests, shown, copied, written to a file."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.gui.features.garment.panel import GarmentPanel
from app.gui.file_export import copy_table, save_table
from app.i18n.catalog import number, tr
from app.presenters.cut_list import CutListView, as_table, cut_list_view
from app.presenters.messages import render
from app.presenters.status import invalid_reason
from core.errors import LineError
from core.garment.cut_list import cut_list_of
from core.garment.pressure_list import PressureList
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext


class GarmentController(QObject):
    """Fill the cut list where it is seen, once a run rests: while the body moves there is nothing to cut."""

    def __init__(
        self, context: AppContext, panel: GarmentPanel, pressures: Callable[[], PressureList | None]
    ) -> None:
        super().__init__(context.session)
        self._context, self._panel, self._pressures = context, panel, pressures
        self._frame: Frame | None = None
        self._shown: Frame | None = None
        panel.opened.connect(self.refresh)
        panel.selected.connect(context.selection.select_line)
        panel.lines_requested.connect(lambda: context.navigation.show_panel("lines"))
        panel.tissue.entered.connect(self._set_tissue)
        panel.copy_requested.connect(lambda: copy_table(context, self._as_table()))
        panel.table_requested.connect(
            lambda: save_table(context, self._as_table(), tr("Export cut list"), "cut-list")
        )

    def follow(self, frame: Frame) -> None:
        """Show the pieces of a frame, or that those shown are of a former one."""
        self._frame = frame
        if self._panel.isVisible():
            self.refresh()

    def forget(self) -> None:
        """Release the list of a document that has gone: its rows are none of the next one's."""
        self._shown = None

    def refresh(self) -> None:
        """Update the list."""
        frame = self._frame
        if frame is None or frame is self._shown:
            return
        rests = self._context.session.is_converged
        if rests or self._shown is None:
            self._show(frame)
        if rests:
            self._shown = frame
        else:
            self._panel.set_stale()

    def _show(self, frame: Frame) -> None:
        try:
            cuts = cut_list_of(frame)
        except LineError as problem:
            self._panel.set_view(CutListView(()), render(problem.message))
        else:
            self._panel.set_view(cut_list_view(frame, cuts), invalid_reason(frame))

    def _set_tissue(self, stiffness: float) -> None:
        text = tr("Tissue stiffness {value} N/m").format(value=number(stiffness, 0))
        self._context.session.change({"tissue_stiffness": stiffness}, text)

    def _as_table(self) -> list[list[str]]:
        frame = self._shown
        if frame is None:
            return []
        cuts = cut_list_of(frame)
        return as_table(frame.stages, cuts, self._pressures())
