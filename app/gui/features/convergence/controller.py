"""The run of the solver: plotted with its edits, saved, and slowed down to be followed by eye."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSettings

from app.gui.file_export import write_file, write_whole
from app.gui.plots.convergence_panel import ConvergencePanel
from app.gui.plots.figure_export import figure_bytes
from app.gui.widgets.basic import ToolButton
from app.gui.widgets.file_dialogs import ask_save
from app.i18n.catalog import tr
from app.presenters.plots import Event, exact_answer, lower_run, lower_table_of, table_of, tracks
from core.document.design import Design
from core.files.atomic_write import atomic_path
from core.pipeline.frame import RegionFrame
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext

TURNS_PER_SECOND = 8.0
"""Pace at which turns can be followed by eye."""


class ConvergenceController(QObject):
    """Plot the run of frames, mark edits on the plots, and save them."""

    def __init__(self, context: AppContext, panel: ConvergencePanel) -> None:
        super().__init__(context.session)
        self._context, self._panel = context, panel
        self._marked: Design | None = None
        self._below = False  # whether lines of the lower trunk alone are worn
        self._first: dict[str, object] = {}
        self._events: dict[str, list[Event]] = {"bust": [], "lower": []}
        text = tr("Step through the iterations slowly")
        self.slow = context.actions.add("solve", tr("Slow motion"), "T", text, checkable=True)
        tool = ToolButton("slow-turns", size=16, room=26, action=self.slow)
        tool.setAccessibleName(tr("Slow motion"))
        panel.tools.insertWidget(1, tool)
        context.session.design_changed.connect(lambda design: panel.set_control(design.volume))
        panel.control_chosen.connect(context.session.choose_control)
        panel.export_requested.connect(self.export)
        panel.quantity_chosen.connect(self.keep_quantity)
        self.slow.toggled.connect(self.set_slow)
        panel.folded.connect(lambda folded: context.actions.strip.setChecked(not folded))
        context.actions.strip.toggled.connect(lambda on: panel.set_folded(not on))
        settings = QSettings()
        for plot in panel.all_plots:
            plot.set_quantity(str(settings.value(f"plot/{plot.objectName()}", "")))

    def show_frame(self, frame: Frame) -> None:
        """Plot the run of a frame."""
        lower, design = lower_run(frame), frame.stages.design
        below = not design.lines and design.lower is not None and bool(design.lower.lines)
        if below != self._below:  # what is worn comes first; a choice made by hand stays until that changes
            self._below = below
            self._panel.show_region("lower" if below else "bust")
        self._panel.set_run(tracks(frame), frame.stages.design.volume, exact_answer(frame), lower)

    def set_slow(self, slow: bool) -> None:
        """Make turns at a pace that can be followed, or as fast as they go."""
        self._context.session.set_pace(TURNS_PER_SECOND if slow else None)

    def keep_quantity(self) -> None:
        """Record what the plots show."""
        for plot in self._panel.all_plots:
            QSettings().setValue(f"plot/{plot.objectName()}", plot.quantity.name)

    def mark_edit(self, frame: Frame) -> None:
        """Record the iteration of the present design, once a frame shows it."""
        design = frame.stages.design
        regions = {"bust": frame, "lower": frame.lower}
        runs = {name: each for name, each in regions.items() if each is not None}
        fresh = [name for name, run in runs.items() if _begin(run) is not self._first.get(name)]
        for name in fresh:
            self._first[name], self._events[name] = _begin(runs[name]), []
        if design is not self._context.session.design or (design is self._marked and not fresh):
            return
        former, self._marked = self._marked, design
        if fresh or former is None or not design.is_equivalent(former):
            for name, run in runs.items():
                marks = self._events[name]
                # Of two regions one that an edit does not concern goes on, or rests.
                if len(runs) == 1 or not marks or marks[-1].turn != run.changed_at:
                    marks.append(Event(float(run.changed_at), self._last_edit()))
            self._panel.set_events(self._events["bust"], self._events["lower"])

    def export(self, kind: str) -> None:
        """Prompt for a file and write the iterations as a table, or the plots as an image."""
        context, frame = self._context, self._context.session.frame
        if frame is None:
            return
        title, kinds = {
            "csv": (tr("Export iterations"), "CSV (*.csv)"),
            "png": (tr("Export image"), "PNG (*.png)"),
            "svg": (tr("Export drawing"), "SVG (*.svg)"),
        }[kind]
        name = f"{context.session.name}-turns.{kind}"
        path = ask_save(context.window, title, name, kinds, f".{kind}")
        if not path:
            return
        if kind == "csv":
            lower = frame.lower if self._panel.shows_lower else None
            table = table_of(frame) if lower is None else lower_table_of(lower)
            write_file(context.notifications, title, path, lambda to: _write_table(to, *table))
        else:
            figure = figure_bytes(kind, self._panel.plots, self._panel.legend)
            write_file(context.notifications, title, path, write_whole(figure))

    def _last_edit(self) -> str:
        return self._context.session.undo_stack.undoText() or tr("Opened")


def _begin(run: Frame | RegionFrame) -> object:
    """Return what is another object once new records have begun."""
    return next(iter(run.tracks.values()))[0]


def _write_table(path: Path, heading: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    # With the mark that tells spreadsheets that letters beyond English follow.
    with (
        atomic_path(path.absolute()) as partial,
        open(partial, "w", newline="", encoding="utf-8-sig") as file,
    ):
        writer = csv.writer(file)
        writer.writerow(heading)
        writer.writerows(rows)
