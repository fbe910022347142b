"""The report: made in the background once the run has converged, shown, saved, printed."""

from __future__ import annotations

import datetime
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, cast

import numpy as np
from PySide6.QtCore import QObject
from PySide6.QtGui import QImage

from app.gui.features.report.page import ReportPage
from app.gui.file_export import print_pages, write_file
from app.gui.session.jobs import Job
from app.gui.session.settings import get_setting
from app.gui.widgets.file_dialogs import ask_save
from app.i18n.catalog import language, tr
from app.presenters.lines import line_colours
from app.presenters.messages import render
from app.rendering.ambient_occlusion import bake_occlusion
from app.report.document import ReportDocument
from app.report.pages import Pages, pages_of
from app.report.pdf_file import write_pdf
from core.errors import UserError
from core.export.csv_cells import ENCODING
from core.export.report_data import Heading, Report, make_report
from core.export.report_data_file import report_csv, report_json
from core.files.atomic_write import write_text
from core.geometry.mesh import Floats
from core.messages import Message
from core.pipeline.converged import converged_frame
from core.pipeline.live_solver import Frame
from core.progress import Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from core.pattern.garment import Pattern

    _Computed = tuple[Report, Frame, Pattern | Message | None, Floats]

WithUncertainties = Callable[[Report, Frame | None, Frame | None], Report]
"""Returns a sheet of a frame, with its uncertainties by the whole run of that."""

STILL = 0.005
"""Control points that moved less are where they were [mm]: a run at rest that goes on moves so far."""


class ReportController(QObject):
    """Show the report in the place of the work; while it is seen it follows the design.

    ``with_uncertainties`` returns a sheet with the uncertainties of its frame, once they are known.
    """

    def __init__(self, context: AppContext, with_uncertainties: WithUncertainties) -> None:
        super().__init__(context.session)
        self._context, self._with_uncertainties = context, with_uncertainties
        self.page = ReportPage()
        self.pages: Pages | None = None
        self.handout: ReportDocument | None = None
        self._frame: Frame | None = None  # the one that the sheet is of
        self._asked: Frame | None = None  # the one that a sheet is being made of
        self._job: Job | None = None
        self._refused = ""  # why there is no sheet of the frame that was asked for
        self._language = ""
        self._laid: tuple[ReportDocument | None, str] = (None, "")
        self._whole: Frame | None = None  # its figures are of
        self._occlusion: tuple[object, Floats] | None = None
        sentence = tr("Preview, save or print sizes, cut lengths, measurements, contact pressures and images")
        do = context.actions
        self.action = do.add("file", tr("Report…"), "Ctrl+P", sentence, do=self.open, of_document=True)
        self.page.closed.connect(self.leave)
        self.page.customer_changed.connect(self._name)
        self.page.language_chosen.connect(self._speak)
        self.page.requested.connect(self._give)
        context.session.design_changed.connect(lambda _: self.follow())
        context.session.failed.connect(lambda _: self.follow())

    # -- what is asked

    @property
    def is_open(self) -> bool:
        """Return whether the sheet stands in the place of the work."""
        return self._context.navigation.page is self.page

    def open(self) -> None:
        """Show the sheet of the design that is shown."""
        self._language = self._language or language()
        self._context.navigation.show_page(self.page)
        self.page.paper.setFocus()
        self.follow()

    def leave(self) -> None:
        """Show the work again."""
        if self.is_open:
            self._context.jobs.cancel(self._job)
            self._job, self._asked, self._refused = None, None, ""
            self._context.navigation.close_page(self.page)

    def close(self) -> bool:
        """Show the work again; returns whether the sheet took its place."""
        was_open = self.is_open
        self.leave()
        return was_open

    def forget(self) -> None:
        """Release the sheet of a document that has gone: nobody is to see it under the next one."""
        document = self._context.session.document
        # Before the page hides: a name that was being typed is not that of the next customer.
        self.page.customer.setText(document.customer if document is not None else "")
        self._context.jobs.cancel(self._job)
        self._frame = self._asked = self._job = self.handout = self.pages = self._occlusion = None
        self._laid = None, ""
        self.page.show_pages(None)
        self.leave()

    def _name(self, customer: str) -> None:
        design = self._context.session.design
        if design is None or design.customer == customer:
            return
        sentence = tr("Customer {name}").format(name=customer) if customer else tr("No customer")
        self._context.session.change({"customer": customer}, sentence)
        if self.handout is not None:
            self._take(self.handout)  # at once: it may be given away with the next word

    def _speak(self, code: str) -> None:
        self._language = code
        self._show()

    # -- what is shown

    def follow(self) -> None:
        """Update the report, if visible: its heading at once, its values after convergence."""
        context, frame = self._context, self._context.session.frame
        if frame is None or not self.is_open:
            return
        if self._is_of(frame):
            if self.handout is not None:
                self._take(self.handout)
            return
        if self._asked is not None and _alike(self._asked, frame):
            return
        context.jobs.cancel(self._job)
        self._job, self._asked, self._refused = None, None, ""
        self._show()
        if context.session.is_converged:
            self._make(frame)

    def _is_of(self, frame: Frame) -> bool:
        if self._frame is None or self.handout is None or self._asked is not None:
            return False
        former, now = self.handout.report.heading, self._heading()
        sizes_alike = (former.system, former.allowance_mm) == (now.system, now.allowance_mm)
        return sizes_alike and self._context.session.is_converged and _alike(self._frame, frame)

    def _make(self, frame: Frame) -> None:
        """Compute the sheet beside the window, then draw its pictures piece by piece."""
        context, heading = self._context, self._heading()
        self._asked = frame
        body, known = frame.stages.body, self._occlusion

        def work(progress: Progress) -> tuple[Report, Frame, Pattern | Message | None, Floats]:
            # From rest, as the command line and who opens the project again: turns that went on from a former
            # design end a hair beside, and would be plotted as if the garment began there.
            design = frame.stages.design
            whole = converged_frame(design, frame.stages, lambda what, share: progress(what, 0.1 * share))
            sheet = make_report(whole, whole.tracks.get(design.volume, ()), heading, progress)
            baked = known[1] if known is not None and known[0] is body else bake_occlusion(body.mesh)
            from app.presenters.pattern_files import pattern_or_reason  # noqa: PLC0415 (brings shapely along)

            pattern = pattern_or_reason(whole.stages, whole.vertices)
            return sheet, whole, pattern, baked

        def draw(found: object) -> None:
            from app.report.images import render_images  # noqa: PLC0415 (brings VTK along)

            sheet, whole, pattern, baked = cast(
                "tuple[Report, Frame, Pattern | Message | None, Floats]", found
            )
            self._occlusion, self._whole = (body, baked), whole
            document = ReportDocument(sheet, {}, self._colours(frame), pattern)
            finish, left = partial(done, document), self._leave_off
            drawing, pieces = tr("Drawing report images"), render_images(whole, baked)
            self._job = context.jobs.run_pieces(drawing, pieces, finish, lambda _: finish({}), left=left)

        def done(plain: ReportDocument, pictures: Mapping[str, QImage]) -> None:
            self._frame, self._asked, self._job = frame, None, None
            self._take(replace(plain, pictures=pictures))

        self._job = context.jobs.run(tr("Creating report…"), work, draw, self._fail, left=self._leave_off)

    def _leave_off(self) -> None:
        self._job = self._asked = None
        self._refused = tr("Report stopped. Return to the report page to create it.")
        self._show()

    def _fail(self, error: Exception) -> None:
        self._job = None
        if isinstance(error, UserError):
            self._refused = render(error.text)
        else:
            self._context.notifications.error(error)
            self._refused = tr("The report could not be created.")
        self._show()

    def _take(self, handout: ReportDocument) -> None:
        """Show a sheet under its present heading; its sizes are those that it was made with."""
        made = handout.report.heading
        heading = replace(self._heading(), system=made.system, allowance_mm=made.allowance_mm)
        sheet = replace(self._with_uncertainties(handout.report, self._frame, self._whole), heading=heading)
        self.handout = replace(handout, report=sheet)
        self._show()

    def _show(self) -> None:
        """Show the sheet as far as it is known, and what is under way."""
        design, frame = self._context.session.design, self._context.session.frame
        stale = frame is None or not self._is_of(frame)
        if self._laid != (self.handout, self._language):
            # Not with every frame of a run: it takes as long as some of them.
            self._laid = self.handout, self._language
            self.pages = pages_of(self.handout, self._language) if self.handout is not None else None
        words = (self._refused or self._waits_for()) if stale else ""
        self.page.show_choices(design.customer if design else "", self._language)
        self.page.show_pages(self.pages, words, stale=stale)

    def _waits_for(self) -> str:
        """Return why there is no sheet yet."""
        if self._context.session.failure is not None:
            return tr("The shape could not be computed: no report is available for this design.")
        if self._context.session.is_converged:
            return tr("Creating report…")
        if self._context.session.is_at_rest:
            return tr("Apply or cancel the pending targets before creating a report.")
        return tr("The report is created when the solver has converged.")

    def _heading(self) -> Heading:
        document = self._context.session.document
        assert document is not None
        return Heading(
            self._context.session.name,
            datetime.date.today().isoformat(),
            document.customer,
            document.shown if len(document.designs) > 1 else "",
            get_setting("size_system"),
            document.design.worn_tight_mm,
        )

    def _colours(self, frame: Frame) -> dict[str, str]:
        return line_colours([line.name for line in frame.stages.drawn_lines], frame.stages.design)

    # -- what leaves the window

    def _give(self, what: str) -> None:
        data, table = self._save_data, self._save_table
        {"pdf": self._save_pdf, "print": self._print, "json": data, "csv": table}[what]()

    def _save_pdf(self) -> None:
        pages = self.pages
        if (path := self._asked_for(tr("Save report"), ".pdf", "PDF (*.pdf)")) and pages is not None:
            self._write(path, lambda: write_pdf(path, pages, self._context.session.name))

    def _save_data(self) -> None:
        self._save_text(tr("Export report data"), ".json", "JSON (*.json)")

    def _save_table(self) -> None:
        self._save_text(tr("Export report values"), ".csv", "CSV (*.csv)")

    def _save_text(self, title: str, ending: str, kinds: str) -> None:
        path = self._asked_for(title, ending, kinds)
        if not path or self.handout is None:
            return
        form, code = (report_csv, ENCODING) if ending == ".csv" else (report_json, "utf-8")
        text = form(self.handout.report)
        self._write(path, lambda: write_text(Path(path).absolute(), text, code))

    def _asked_for(self, title: str, ending: str, kinds: str) -> str:
        name = f"{self._context.session.name}-{tr('report')}{ending}"
        return ask_save(self._context.window, title, name, kinds, ending)

    def _write(self, path: str, write: Callable[[], None]) -> None:
        write_file(self._context.notifications, "sheet", path, lambda _: write())

    def _print(self) -> None:
        if self.pages is not None:
            print_pages(self._context, self.pages, self._context.session.name)


def _alike(one: Frame, other: Frame) -> bool:
    """Return whether two frames have one sheet: all but the customer is the same."""
    designs = (replace(each.stages.design, customer="") for each in (one, other))
    same = len(set(map(repr, designs))) == 1
    return same and np.allclose(one.control_points, other.control_points, rtol=0.0, atol=STILL)
