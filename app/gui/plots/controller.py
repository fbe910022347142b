"""The plots at work: where edits were made, what is saved of them, and turns slow enough to be seen."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSettings

from app.gui.plots.figure_export import figure_bytes
from app.gui.widgets.basic import ToolButton
from app.gui.widgets.file_dialogs import ask_save
from app.i18n.catalog import tr
from app.presenters.plots import Event, exact_answer, table_of, tracks
from core.document.design import Design
from core.errors import UserError
from core.files.atomic_write import atomic_path
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow

TURNS_PER_SECOND = 8.0
"""Pace at which turns can be followed by eye."""


class PlotDesk(QObject):
    """Follows the frames to mark edits on the plots, and does what the strip is asked for."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._marked: Design | None = None
        self._first: object = None
        self._events: list[Event] = []
        said = tr("Make each turn slowly enough to see it, as the paper shows them; the verdict waits")
        self.slow = window.actions_.add("solve", tr("Turn by turn"), "T", said, checkable=True)
        tool = ToolButton("slow-turns", size=16, room=26, action=self.slow)
        tool.setAccessibleName(tr("Turn by turn"))
        window.strip.tools.insertWidget(1, tool)
        window.session.design_changed.connect(lambda design: window.strip.set_control(design.volume))
        settings = QSettings()
        for plot in window.strip.plots:
            plot.set_quantity(str(settings.value(f"plot/{plot.objectName()}", "")))

    def show_frame(self, frame: Frame) -> None:
        """Plot the run of a frame."""
        self._window.strip.set_run(tracks(frame), frame.stages.design.volume, exact_answer(frame))

    def set_slow(self, slow: bool) -> None:
        """Make turns at a pace that can be followed, or as fast as they go."""
        self._window.session.set_pace(TURNS_PER_SECOND if slow else None)

    def keep_quantity(self) -> None:
        """Remember what the plots show."""
        for plot in self._window.strip.plots:
            QSettings().setValue(f"plot/{plot.objectName()}", plot.quantity.name)

    def mark_edit(self, frame: Frame) -> None:
        """Note at which turn the design on the screen came to be, once a frame shows it."""
        design = frame.stages.design
        records = next(iter(frame.tracks.values()))
        fresh = records[0] is not self._first
        if fresh:
            self._first = records[0]
            self._events = []
        if design is not self._window.session.design or (design is self._marked and not fresh):
            return
        former, self._marked = self._marked, design
        if fresh or former is None or not design.is_equivalent(former):
            self._events.append(Event(float(frame.changed_at), self._last_edit()))
            self._window.strip.set_events(self._events)

    def export(self, kind: str) -> None:
        """Ask for a place and write the turns as a table, or the plots as a picture or a drawing."""
        window, frame = self._window, self._window.session.frame
        if frame is None:
            return
        title, kinds = {
            "csv": (tr("Save the turns"), "CSV (*.csv)"),
            "png": (tr("Save a picture"), "PNG (*.png)"),
            "svg": (tr("Save a drawing"), "SVG (*.svg)"),
        }[kind]
        path = ask_save(window, title, f"{window.session.name}-turns.{kind}", kinds, f".{kind}")
        if not path:
            return
        try:
            if kind == "csv":
                _write_table(Path(path), frame)
            else:
                figure = figure_bytes(kind, window.strip.plots, window.strip.legend)
                with atomic_path(Path(path).absolute()) as partial:
                    partial.write_bytes(figure)
        except UserError as error:
            window.notifications.error(error, title)
        else:
            window.notifications.file_written(title, tr("{name} written.").format(name=Path(path).name), path)

    def _last_edit(self) -> str:
        return self._window.session.undo_stack.undoText() or tr("As it was opened")


def _write_table(path: Path, frame: Frame) -> None:
    heading, rows = table_of(frame)
    # With the mark that tells spreadsheets that letters beyond English follow.
    with (
        atomic_path(path.absolute()) as partial,
        open(partial, "w", newline="", encoding="utf-8-sig") as file,
    ):
        writer = csv.writer(file)
        writer.writerow(heading)
        writer.writerows(rows)
