"""Export from the window: choices, file dialog, and writing in the background."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from PySide6.QtCore import QObject

from app.gui.features.export.dialog import ExportDialog
from app.gui.features.export.worker import ExportWorker
from app.gui.session.jobs import Job
from app.gui.session.settings import get_setting, set_setting
from app.gui.widgets.dialog import ask
from app.gui.widgets.file_dialogs import ask_save, free_name, last_folder
from app.i18n.catalog import colon, tr
from app.presenters.assessment import AssessmentView
from app.presenters.export import ExportOptions, ExportSettings, ExportSource, exports, format_title
from app.presenters.export_preview import ExportPreview, prepare_export
from app.presenters.messages import render
from app.presenters.status import display_state, is_result, state_title
from core.errors import UserError
from core.files.atomic_write import still_writing_error
from core.garment.assessment import BAD
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext

_DOUBT = "export"  # what a notice of an export of an unfinished run is about


class ExportController(QObject):
    """Open the dialog of exports, preview what will be in a file, and write it.

    ``sheet`` is there while it is open.
    """

    def __init__(self, context: AppContext, assess: Callable[[Frame], AssessmentView]) -> None:
        super().__init__(context.session)
        self._context, self._assess = context, assess
        self._choices = ExportSettings(get_setting("export"))
        self.sheet: ExportDialog | None = None
        self._outcome: ExportSource | None = None
        self._job: Job | None = None
        self._works: list[ExportWorker] = []
        context.actions.export.triggered.connect(self.export_body)
        context.actions.export_any.triggered.connect(self.show)

    def show(self) -> None:
        """Show all that can be exported."""
        sheet = self.sheet = ExportDialog(self._context.window, exports())
        sheet.chosen.connect(self._choose_export)
        sheet.changed.connect(self._choose)
        sheet.save_requested.connect(self._save)
        sheet.finished.connect(self._forget)
        self._refresh()
        sheet.open()
        sheet.items[self._choices.export.what].setFocus()

    def export_body(self) -> None:
        """Prompt for a file and write the reshaped body, else with the last choices."""
        frame = self._ask_and_write("body", tr("Export body"), reshaped=True)
        doubt = self._doubt(frame) if frame is not None else ""
        if frame is not None:
            self._context.notifications.withdraw(_DOUBT)
        if doubt:
            self._context.notifications.warn(doubt, topic=_DOUBT)

    def show_frame(self, frame: Frame) -> None:
        """Show the present body, if the dialog is visible and the solver has converged."""
        if self.sheet is not None and not frame.is_running:
            self._tell()

    # -- the sheet

    def _choose_export(self, what: str) -> None:
        self._choices.choose_export(what)
        self._refresh()

    def _choose(self, key: str, value: str) -> None:
        self._choices.choose(self._choices.export.what, key, value)
        self._refresh()

    def _refresh(self) -> None:
        """Show the choices of what is to be exported, and what they come to."""
        set_setting("export", self._choices.text)
        export = self._choices.export
        if self.sheet is not None:
            settings = self._choices.settings(export.what)
            self.sheet.show_export(export, settings, self._choices.values(export.what))
            self._tell()

    def _tell(self) -> None:
        """Compute beside the window what will be in the file, and say so."""
        context, frame, sheet = self._context, self._context.session.frame, self.sheet
        context.jobs.cancel(self._job)
        if frame is None or sheet is None:
            return
        what = self._choices.export.what
        name, outcome, manner = self._file_name(what), self._outcome_of(frame), self._manner(what)
        doubt = "" if manner.before and what != "flat" else self._doubt(frame)
        sheet.show_contents(name, tr("Preparing preview…"), doubt)
        self._job = context.jobs.run(
            tr("Preparing export…"),
            lambda progress: prepare_export(what, name, outcome, manner),
            lambda ready: sheet.show_contents(name, _sentence(cast(ExportPreview, ready)), doubt),
            partial(self._show_refused, name),
        )

    def _show_refused(self, name: str, error: Exception) -> None:
        if isinstance(error, UserError) and self.sheet is not None:
            self.sheet.show_contents(name, "", render(error.text), possible=False)
        else:
            self._context.notifications.error(error)

    def _forget(self) -> None:
        self.sheet = self._outcome = None  # a body is much to hold, and quickly worked out again
        self._context.jobs.cancel(self._job)

    # -- a file

    def _save(self) -> None:
        export, sheet = self._choices.export, self.sheet
        written = self._ask_and_write(export.what, tr("Export: {what}").format(what=export.title))
        if written is not None and sheet is not None:
            sheet.accept()

    def _ask_and_write(self, what: str, title: str, reshaped: bool = False) -> Frame | None:
        """Prompt for a file and begin to write; returns what is written, or None if nothing is."""
        usual = self._choices.kind(what)
        kinds = sorted(self._choices.find(what).formats, key=lambda kind: kind != usual)
        filters = ";;".join(f"{format_title(kind)} (*.{kind})" for kind in kinds)
        path = ask_save(self._parent, title, f"{self._stem(what)}.{usual}", filters, f".{usual}")
        # A run may go on behind the dialog: what is written is what is shown when it closes.
        frame = self._context.session.frame
        if not path or frame is None:
            return None
        manner = self._manner(what, Path(path).suffix.lower().lstrip("."))
        if reshaped:
            manner = replace(manner, before=False)
        if what == "turntable" and not self._may_number(Path(path), manner):
            return None
        if any(work.path == Path(path) and work.at_work for work in self._works):
            self._context.notifications.error(still_writing_error(Path(path)), f"export {what}")
            return None
        work = ExportWorker(self._context, what, Path(path), self._outcome_of(frame), manner)
        self._works = [*(each for each in self._works if each.at_work), work]
        work.begin()
        return frame

    def _may_number(self, path: Path, manner: ExportOptions) -> bool:
        """Ask before a series of pictures takes the place of another, which the dialog has not seen."""
        from app.rendering.turntable import turntable_files  # noqa: PLC0415 (brings VTK along)

        there = [each.name for each in turntable_files(path, manner.frames) if each != path and each.exists()]
        if not there:
            return True
        question = tr("{name} already exists. Replace it?").format(name=there[0])
        return ask(self._parent, question, "", [("replace", tr("Replace"))]) == "replace"

    # -- what is known

    @property
    def _parent(self) -> Any:
        return self.sheet or self._context.window

    def _outcome_of(self, frame: Frame) -> ExportSource:
        """Return what came out: while nothing changes the same one, with all that it has worked out."""
        view, known = self._context.view, self._outcome
        material = view.viewport.scene.material
        session = self._context.session
        named = session.name, session.design.customer if session.design else ""
        looks = view.hidden_lines, material, named
        lower = None if frame.lower is None else frame.lower.control_points
        same = known is not None and known.control_points is frame.control_points
        same = same and known is not None and known.lower_points is lower
        if known is None or not same or looks != (known.hidden, known.material, known.named):
            tracks = frame.tracks
            records = tracks.get(frame.stages.design.volume) or next(iter(tracks.values()), ())
            known = self._outcome = ExportSource(
                frame.stages, frame.control_points, records, *looks, lower_points=lower
            )
        return known

    def _manner(self, what: str, kind: str = "") -> ExportOptions:
        return self._choices.manner(what, kind, self._context.view.viewport.view)

    def _stem(self, what: str) -> str:
        return f"{self._context.session.name}-{what}"

    def _doubt(self, frame: Frame) -> str:
        """Return what to mind of a reshaped body that would be written, or nothing."""
        if self._context.session.failure is not None:
            return tr("The design could not be computed. The file contains the last computed shape.")
        if frame.is_running:
            return tr("The solver is still running. The export contains the current, unconverged state.")
        if is_result(frame):
            overall = self._assess(frame)
            return f"{overall.headline}{colon()}{overall.first}" if overall.level == BAD else ""
        return tr("{state}: do not use this shape for production.").format(
            state=state_title(display_state(frame))
        )

    def _file_name(self, what: str) -> str:
        return free_name(last_folder("written"), f"{self._stem(what)}.{self._choices.kind(what)}").name


def _sentence(ready: ExportPreview) -> str:
    text = tr("{contents}, {details}") if ready.how else "{contents}"
    return text.format(contents=ready.contents, details=ready.how)
