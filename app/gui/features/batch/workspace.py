"""The work on batch runs: setup, the process that computes, and bodies opened from the results."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Qt, Signal

from app.batch.batch_design import BatchDesign
from app.batch.design_file import other_results_error
from app.batch.extra import missing_error, missing_packages
from app.batch.inputs import list_scans
from app.batch.one_body import design_on_body
from app.batch.schema import PAGE
from app.batch.stored_rows import has_results, scan_file, written_file
from app.gui.features.batch.designs import STORED, DesignChoice
from app.gui.features.batch.dialog import BatchDialog
from app.gui.features.batch.results import BatchResults
from app.gui.features.batch.run import DONE, FAILED, STOPPED, BatchRun, RunRequest
from app.gui.features.batch.table import BatchModel
from app.gui.session.app_folders import open_outside, show_folder
from app.gui.session.jobs import Job
from app.gui.widgets.file_dialogs import ask_folder, ask_scans, free_name
from app.i18n.catalog import listed, tr
from app.presenters.batch import FAILURES, BatchRow, failures_text, progress_text, scans_text
from core.document.design import Design
from core.document.document import Document
from core.document.storage.project_file import safe_name
from core.errors import UserError
from core.messages import Message

if TYPE_CHECKING:
    from app.gui.context import AppContext


class BatchWorkspace(QObject):
    """Connect the window of batch runs with the run, the results and the open document.

    ``progressed`` carries how far a run is, in a few words, and its share, empty when it has ended.
    ``may_leave`` confirms unsaved changes of the open document.
    """

    progressed = Signal(str, object)

    def __init__(self, context: AppContext, may_leave: Callable[[], bool]) -> None:
        super().__init__(context.session)
        self._context, self._may_leave = context, may_leave
        self.run, self.model = BatchRun(self), BatchModel()
        self.dialog = BatchDialog(self.model)
        self.choice = DesignChoice(context, self.dialog.setup)
        self.results = BatchResults(context, self.dialog)
        self._counting: Job | None = None
        self._own_out = self._adopts = False
        self._connect()
        self._follow()
        self._check_packages()

    def _connect(self) -> None:
        run, dialog, setup = self.run, self.dialog, self.dialog.setup
        run.changed.connect(self._show_run)
        run.rows_added.connect(self.results.add)
        run.rows_added.connect(lambda _: self._follow())  # the folder of results is there now
        run.ended.connect(self._end)
        setup.folder_requested.connect(self._ask_folder)
        setup.files_requested.connect(self._ask_files)
        setup.out_requested.connect(self._ask_out)
        setup.results_requested.connect(self._ask_results)
        setup.changed.connect(self._follow)
        dialog.dropped.connect(self.choose_scans)
        dialog.run_requested.connect(self.start)
        dialog.stop_requested.connect(run.stop)
        dialog.table.chosen.connect(self.open_row)
        dialog.open_requested.connect(self._open_current)
        dialog.page_requested.connect(self._open_page)
        dialog.show_folder_requested.connect(self._show_folder)
        dialog.report_requested.connect(self._open_report)
        self.choice.changed.connect(self._offer_out)
        self.choice.failed.connect(self._refuse)
        self.results.loaded.connect(self._take_designs)

    # -- the window

    def show(self) -> None:
        """Show the window, as it was when it was closed."""
        dialog = self.dialog
        self.choice.follow()
        self._follow()
        dialog.setWindowState(dialog.windowState() & ~Qt.WindowState.WindowMinimized)
        dialog.show()
        dialog.raise_()
        dialog.activateWindow()

    def close(self) -> None:
        """Stop the run and close the window."""
        self.run.close()
        self.dialog.close()
        self.dialog.deleteLater()

    def _check_packages(self) -> None:
        missing = missing_packages()
        if missing:
            self._refuse(missing_error(listed(missing)), tone="warn")

    # -- the setup

    def choose_scans(self, scans: Sequence[str]) -> None:
        """Choose files and folders with scans; their number is counted beside the window."""
        if not scans:
            return
        setup = self.dialog.setup
        setup.set_scans(scans)
        self._offer_out()
        self._context.jobs.cancel(self._counting)
        out = setup.out
        self._counting = self._context.jobs.run(
            tr("Listing scans…"),
            lambda _: len(list_scans(scans, out)),
            lambda count: setup.set_scans(scans, scans_text(int(str(count)))),
            self._refuse,
        )

    def choose_out(self, out: Path) -> None:
        """Choose the folder of results; those in it are shown."""
        self._own_out = True
        self._set_out(out)

    def _ask_folder(self) -> None:
        path = ask_folder(self.dialog, tr("Folder of scans"))
        self.choose_scans([path] if path else [])

    def _ask_files(self) -> None:
        self.choose_scans(ask_scans(self.dialog, tr("Scans")))

    def _ask_out(self) -> None:
        path = ask_folder(self.dialog, tr("Folder of results"), "written")
        if path:
            self.choose_out(Path(path))

    def _ask_results(self) -> None:
        path = ask_folder(self.dialog, tr("Open results"), "written")
        if path and not has_results(Path(path)):
            self._refuse(
                UserError(
                    Message("{folder} holds no results of a batch run.", folder=path),
                    Message("Choose the folder of a batch run."),
                )
            )
        elif path:
            self.open_results(Path(path))

    def open_results(self, folder: Path) -> None:
        """Show the results in a folder, and choose their design: Run continues them."""
        self._adopts = True
        self.choose_out(folder)

    def _take_designs(self, designs: list[BatchDesign]) -> None:
        """Offer the designs of results that were read; they are chosen if the results were opened."""
        if self._adopts or not self.choice.designs():
            self.choice.keep(designs)
        else:
            self.choice.offer(designs)
        self._adopts = False
        self._follow()

    def _offer_out(self) -> None:
        """Offer a folder beside the scans, named after them and the design, until another one is chosen."""
        scans = self.dialog.setup.scans
        if scans and not self._own_out and self.choice.kind != STORED and self.choice.name:
            first = Path(scans[0])
            folder = first if first.is_dir() else first.parent
            name = safe_name(f"{folder.name} {self.choice.name} batch".strip())
            self._set_out((folder.parent if first.is_dir() else folder) / name)
        self._follow()

    def _set_out(self, out: Path) -> None:
        self.dialog.setup.set_out(out)
        self.results.show_folder(out)
        self._follow()

    def _follow(self) -> None:
        """Allow what is possible with the present setup."""
        dialog = self.dialog
        out, scans = dialog.setup.out, dialog.setup.scans
        ready = bool(scans and out and self.choice.designs()) and not missing_packages()
        dialog.run.setEnabled(ready)
        dialog.show_outputs(
            page=out is not None and (out / PAGE).is_file(), folder=out is not None and out.is_dir()
        )

    # -- the run

    def start(self, *, retry: bool = False) -> None:
        """Start the run, or continue it; a folder with the results of another design is refused.

        With ``retry`` bodies that failed or ran out of time are computed again.
        """
        dialog = self.dialog
        setup, designs = dialog.setup, self.choice.designs()
        if setup.out is None or not setup.scans or not designs:
            return
        dialog.notices.clear()
        if self.results.is_of_other(setup.out, designs):
            problem = other_results_error(setup.out).message
            actions = ((tr("Use new folder"), self.use_new_folder),)
            dialog.notices.show_notice(
                "bad", problem, Message("Choose another folder."), actions, lasting=True
            )
            return
        self.results.begin(setup.out, designs)
        self.choice.keep(designs)
        request = RunRequest(setup.scans, designs, setup.out, setup.workers, setup.files, retry)
        try:
            self.run.start(request)
        except (UserError, OSError) as problem:
            self._refuse(problem)

    def use_new_folder(self) -> None:
        """Choose a folder of results that is not there yet."""
        out = self.dialog.setup.out
        if out is not None:
            self.dialog.notices.clear()
            self.choose_out(free_name(out.parent, out.name))

    def _show_run(self) -> None:
        run, dialog = self.run, self.dialog
        text = tr("Starting…")
        if run.total:
            text = progress_text(run.done, run.total, run.rate, run.seconds_left)
        if run.is_stopping:
            text = tr("Stopping…")
        running = run.is_running
        brief = tr("Batch: starting…")
        if run.total:
            brief = tr("Batch: {done} of {total}").format(done=run.done, total=run.total)
        self.progressed.emit(brief if running else "", run.fraction)
        dialog.show_state(running=running, stopping=run.is_stopping)
        dialog.show_progress(text, run.fraction, running=running)

    def _end(self, how: str) -> None:
        dialog = self.dialog
        texts = {
            DONE: tr("Run finished."),
            STOPPED: tr("Run stopped. The results so far are kept; Run continues."),
            FAILED: "",
        }
        dialog.show_progress(texts[how], None, running=False)
        if how == FAILED:
            dialog.notices.show_notice("bad", *self.run.error, lasting=True)
        if how == DONE:
            self._offer_retry()
        else:
            self.results.load()
        self._follow()
        if not dialog.isVisible():
            tone = "bad" if how == FAILED else "ok"
            text, hint = self.run.error if how == FAILED else (tr("Batch run finished."), "")
            self._context.notifications.show(tone, text, hint, [(tr("Show results"), self.show)])

    def _offer_retry(self) -> None:
        """Offer to repeat what can end otherwise: bodies that failed or ran out of time."""
        count = sum(row.level in FAILURES for row in self.model.rows.values())
        if count:
            actions = ((tr("Repeat them"), lambda: self.start(retry=True)),)
            self.dialog.notices.show_notice("warn", failures_text(count), "", actions, lasting=True)

    # -- the results

    def open_row(self, row: BatchRow) -> None:
        """Open the body of a row with the design of the run, after unsaved changes are confirmed."""
        out, design = self.dialog.setup.out, self.results.design_of(row)
        file = scan_file(out, row.scan) if out is not None else None
        if file is None or design is None:
            self._refuse(
                UserError(
                    Message("{file} cannot be found.", file=row.scan),
                    Message("Move the scan to its former folder."),
                )
            )
            return
        if not self._may_leave():
            return
        path = file.absolute()
        self._context.jobs.run(
            tr("Opening {name}…").format(name=path.name),
            lambda _: design_on_body(design, path),
            self._open,
            self._refuse,
            waited=True,
        )

    def _open(self, design: Any) -> None:
        """Open a design without a file of its own: a project whose body it is on stays as it is."""
        window, session = self._context.window, self._context.session
        if design.scan.member:
            session.open_document(Document.single(design), unsaved=True)
            once = Qt.ConnectionType.SingleShotConnection
            session.opened.connect(lambda _: self._count_as_saved(design), once)
        else:
            session.open_design(design)
        window.raise_()
        window.activateWindow()

    def _count_as_saved(self, design: Design) -> None:
        """Ask nothing when it is left: the design is that of the results, the project is unchanged."""
        if self._context.session.design is design:
            self._context.session.undo_stack.setClean()

    def _open_current(self) -> None:
        row = self.dialog.table.current
        if row is not None:
            self.open_row(row)

    def _open_page(self) -> None:
        out = self._out
        if out is not None and not open_outside(out / PAGE):
            self._inform(tr("The page could not be opened."), str(out / PAGE))

    def _open_report(self) -> None:
        row = self.dialog.table.current
        if row is not None and self._out is not None and row.report:
            report = written_file(self._out, "report", row.report)
            if report is None or not (report.is_file() and open_outside(report)):
                self._inform(tr("The report could not be opened."), row.report)

    def _show_folder(self) -> None:
        if self._out is not None:
            show_folder(self._out, self._inform)

    # -- what is shown

    @property
    def _out(self) -> Path | None:
        return self.dialog.setup.out

    def _inform(self, text: str, hint: str) -> None:
        self.dialog.notices.show_notice("info", text, hint, lasting=True)

    def _refuse(self, problem: Exception, tone: str = "bad") -> None:
        if not isinstance(problem, UserError):
            self._context.notifications.error(problem)
            return
        self.dialog.notices.clear()
        self.dialog.notices.show_notice(tone, problem.message, problem.hint, lasting=True)
