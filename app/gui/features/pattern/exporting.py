"""Export of pieces: previewed, printed and written as files; blocks and cloths are opened and saved."""

from __future__ import annotations

import datetime
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject

from app.gui.file_export import print_pages, write_file
from app.gui.session.jobs import Job
from app.gui.widgets.file_dialogs import ask_file, ask_save
from app.i18n.catalog import language, listed, tr
from app.presenters.messages import line_title, render
from app.report.pdf_file import write_pdf
from core.errors import UserError
from core.export.report_data import Heading
from core.garment.assessment import assess
from core.pattern.block_library import read_block, write_block
from core.pattern.cloth_csv import read_cloth, write_template
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.pattern.controller import PatternController
    from app.gui.features.pattern.export_dialog import PatternExportDialog
    from app.presenters.pattern_files import CutPattern
    from app.report.pattern_sheets import PatternSheets
    from core.pattern.layout import Tiling

_ABOUT = "pattern"  # what notices of files are about


class PatternExport(QObject):
    """Opens the export dialog, and reads and writes blocks and tables of cloths."""

    def __init__(self, context: AppContext, controller: PatternController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        self.dialog: PatternExportDialog | None = None
        self._job: Job | None = None
        self._cut: CutPattern | None = None
        self._pages: PatternSheets | None = None
        panel = controller.panel
        panel.export_requested.connect(self.show)
        panel.block_file_requested.connect(self.open_block)
        panel.save_block_requested.connect(self.save_block)
        panel.piece_card.cloth_table_requested.connect(self.open_cloth)
        panel.piece_card.stretch_test_requested.connect(self.save_stretch_test)
        controller.changed.connect(self._refresh)

    # -- pieces

    def show(self) -> None:
        """Show the export dialog."""
        from app.gui.features.pattern.export_dialog import PatternExportDialog  # noqa: PLC0415 (brings shapely)

        dialog = self.dialog = PatternExportDialog(self._context.window)
        dialog.changed.connect(self._refresh)
        dialog.save_requested.connect(self._save)
        dialog.print_requested.connect(self._print)
        dialog.finished.connect(self._forget)
        self._refresh()
        dialog.open()

    def _forget(self) -> None:
        self._context.jobs.cancel(self._job)
        self.dialog = self._job = self._cut = self._pages = None

    def _refresh(self) -> None:
        """Lay the present pieces out on the chosen paper, in the background."""
        dialog, result, plan = self.dialog, self._controller.result, self._controller.plan
        if dialog is None:
            return
        self._context.jobs.cancel(self._job)
        self._job = self._cut = self._pages = None
        if result is None or plan is None or not self._controller.is_current():
            dialog.show_pages(None, tr("The preview is created when the solver has converged."))
            return
        strips, paper = dialog.strips.isChecked(), dialog.paper
        dialog.show_pages(None, tr("Preparing preview…"))
        dialog.show_doubt("")

        def work(progress: Progress) -> object:
            from app.presenters.pattern_files import cut_pattern, tiling_of  # noqa: PLC0415 (brings shapely)

            frame = result.request.frame
            cut = cut_pattern(result.pattern, plan, frame, frame.vertices, strips=strips)
            return cut, tiling_of(cut, paper)

        words = tr("Preparing preview…")
        self._job = self._context.jobs.run(words, work, self._show_pages, self._fail)

    def _show_pages(self, laid_out: object) -> None:
        from app.report.pattern_sheets import pattern_sheets  # noqa: PLC0415 (brings shapely)

        self._cut, tiling = cast("tuple[CutPattern, Tiling]", laid_out)
        self._pages = pattern_sheets(tiling, self._heading(), language())
        if self.dialog is not None:
            self.dialog.show_pages(self._pages)
            self.dialog.show_doubt("\n".join(filter(None, self._doubts(self._cut))))

    def _doubts(self, cut: CutPattern) -> Iterator[str]:
        """Yield what to mind before cutting."""
        yield self._controller.doubt()
        if not cut.pattern.fits_cloths:
            yield tr("Some pieces exceed the limit of their cloth. Do not cut them.")
        if cut.uncut:
            names = listed(line_title(name, cut.stages.design) for name in cut.uncut)
            yield tr("No strip for: {lines}. See the cut list for the reason.").format(lines=names)

    def _fail(self, error: Exception) -> None:
        if isinstance(error, UserError):
            words = render(error.text)
        else:
            words = tr("The preview could not be created.")
            self._context.notifications.error(error)
        if self.dialog is not None:
            self.dialog.show_pages(None, words)

    def _heading(self) -> Heading:
        document = self._context.session.document
        assert document is not None
        variant = document.shown if len(document.designs) > 1 else ""
        today = datetime.date.today().isoformat()
        return Heading(self._context.session.name, today, document.customer, variant)

    def _save(self) -> None:
        dialog, cut, pages = self.dialog, self._cut, self._pages
        if dialog is None or cut is None or pages is None:
            return
        from app.presenters.pattern_files import ENDINGS, kind_titles, write_pattern  # noqa: PLC0415

        kind, ending = dialog.kind, ENDINGS[dialog.kind]
        title = kind_titles()[kind][0]
        name = f"{self._controller.stem()}-{tr('pieces')}{ending}"
        path = ask_save(dialog, tr("Export pieces"), name, f"{title} (*{ending})", ending)
        if not path:
            return
        heading, result = pages.heading, self._controller.result
        found = {}
        if kind == "json" and result is not None:
            found = {"assessment": assess(result.request.frame).as_data()}

        def write(target: Path) -> None:
            if kind == "pdf":
                write_pdf(target, pages, heading.project)
            else:
                write_pattern(target, kind, cut, heading, found)

        write_file(self._context.notifications, _ABOUT, path, write)
        dialog.accept()

    def _print(self) -> None:
        if self._pages is not None and self.dialog is not None:
            print_pages(self._context, self._pages, self._context.session.name)

    # -- blocks and cloths

    def open_block(self) -> None:
        """Make the pieces by a block of one's own."""
        path = ask_file(self._context.window, tr("Open block"), "JSON (*.json)")
        if not path:
            return
        try:
            self._controller.choose_block(read_block(Path(path)))
        except (UserError, OSError) as error:
            self._context.notifications.error(error, _ABOUT)

    def save_block(self) -> None:
        """Save the block with all that was changed in it."""
        plan = self._controller.plan
        if plan is None:
            return
        name = f"{self._controller.stem()}.json"
        path = ask_save(self._context.window, tr("Save block as…"), name, "JSON (*.json)", ".json")
        if path:
            stem = Path(path).stem
            block = plan.block if stem == plan.block.name else replace(plan.block, name=stem, title=stem)
            write_file(self._context.notifications, _ABOUT, path, lambda to: write_block(to, block))

    def open_cloth(self) -> None:
        """Cut the selected piece from a cloth of one's own, of which there is a table."""
        path = ask_file(self._context.window, tr("Cloth from table…"))
        if not path:
            return
        try:
            self._controller.editing.use_cloth(read_cloth(Path(path)))
        except (UserError, OSError) as error:
            self._context.notifications.error(error, _ABOUT)

    def save_stretch_test(self) -> None:
        """Save the table in which the 10 cm test of a cloth is entered."""
        name = tr("cloth") + ".csv"
        title = tr("Save table of the 10 cm test…")
        path = ask_save(self._context.window, title, name, "CSV (*.csv)", ".csv")
        if path:
            write_file(self._context.notifications, _ABOUT, path, write_template)
