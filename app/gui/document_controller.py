"""The desk: what the window does when the session speaks or the user asks for a file."""

from __future__ import annotations

import logging
import time
import traceback
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from app.gui.features.project.recent_files import remember_file
from app.gui.session.app_folders import show_folder, shown_folder
from app.gui.session.project_thumbnail import project_picture
from app.gui.widgets.file_dialogs import ask_about_changes, ask_open, ask_save
from app.gui.widgets.last_folders import remember_folder
from app.gui.widgets.loss_dialogs import ask_overwrite
from app.gui.widgets.notification_bar import FAULT, FILES, REFUSED, SCAN
from app.i18n.catalog import tr
from app.presenters.lines import titled
from app.presenters.plots import PLOT_INTERVAL, exact_answer, tracks
from app.presenters.samples import lifted_sample
from app.presenters.status import facts, fault_words, solver_fault_words
from core.document.design import Design
from core.document.storage.project_file import is_protected
from core.errors import UserError
from core.pipeline.live_solver import Frame
from core.pipeline.warnings import kept_volume, warnings

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow


class Desk(QObject):
    """Brings answers of the session to the parts of the window, and requests with a dialog to the session."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._session = window.session
        self._frame: Frame | None = None
        self._fell_back_to: Design | None = None
        self._chosen, self._index = "", 0
        self._faulty = False
        self._plotted: Frame | None = None
        self._plot_due = 0.0
        self._plot_clock = QTimer(self, interval=PLOT_INTERVAL, singleShot=True)
        self._plot_clock.timeout.connect(self.plot_now)
        window.actions_.strip.setChecked(True)
        window.actions_.inspector.setChecked(True)
        self.go_to("lines")
        self.show_title()

    # -- the session speaks

    def show_opened(self, frame: Frame) -> None:
        """Show a document that has just been opened."""
        window = self._window
        window.actions_.enable_document()
        window.notices.clear()
        self.show_title()
        pages = {window.model: "lines", window.worn_desk.page: "result"}  # they are of the body before
        if (page := window.inspector.panel()) in pages:
            window.inspector.open(pages[page])
        if self._is_chosen_scan(frame.stages.design):
            self.go_to("scan")
        self.select_line(window.view.selected_line)
        window.layout_.enter()
        window.scan_desk.show_opened(frame.stages)
        window.status.set_saved("")  # what was said is of the document before
        for sentence in warnings(frame.stages):
            window.notices.show_notice("warn", sentence, lasting=True, about=SCAN)

    def show_frame(self, frame: Frame) -> None:
        """Show how far the solver has come."""
        design = frame.stages.design
        if self._fell_back_to not in (None, design) and design is self._session.design:
            self.forget_failures()
        if self._faulty and self._session.failure is None:
            self._faulty = False
            self._window.notices.withdraw(FAULT)
        if self._frame is None or frame.stages.landmarks is not self._frame.stages.landmarks:
            self._window.scan_desk.show_found(frame.stages)
        if self._frame is not None and frame.stages.control is not self._frame.stages.control:
            self._window.notices.keep_only(SCAN, warnings(frame.stages))
        turning = frame.at_work and self._frame is not None and frame.stages.model is self._frame.stages.model
        self._frame = frame
        self._window.view.show_frame(frame)
        if not turning or time.monotonic() >= self._plot_due:
            self.plot_now()
        elif not self._plot_clock.isActive():
            self._plot_clock.start()

    def note_step(self, index: int) -> None:
        """Withdraw failures of what is undone; those of another edit go with its first frame."""
        former, self._index = self._index, index
        # What was refused is taken back to the design that was there when this was reported: that stays.
        if index < former and self._session.design is not self._fell_back_to:
            self.forget_failures()

    def forget_failures(self) -> None:
        """Withdraw failures of a design that is no longer the one in hand."""
        self._fell_back_to = None
        self._window.notices.withdraw(REFUSED)

    def show_design(self, design: Design) -> None:
        """Show what was decided."""
        do = self._window.actions_
        do.controls[design.volume].setChecked(True)
        do.templates[design.template].setChecked(True)
        self._window.strip.set_control(design.volume)
        self._window.model.set_values(vars(design))
        self._window.door.set_values(vars(design))
        self.show_title()

    def show_failure(self, error: Exception, about: str = "") -> None:
        """Say what went wrong; what is on the screen stays.

        A file that is not written names what it is ``about``: it is told until ``show_written`` of that.
        """
        self._fell_back_to, notices = self._session.design, self._window.notices
        if self._session.failure is not None:
            self._plotted = None
            self.plot_now()
        if isinstance(error, UserError):
            # What was refused before was asked for before: the last refusal is the one that counts.
            about = about or REFUSED
            notices.withdraw(about)
            message = titled(error.message, self._session.design)
            notices.show_notice("bad", message, error.hint, lasting=True, about=about)
            if self._frame is not None:
                self._window.scan_desk.show_found(self._frame.stages)
            return
        logging.error("unexpected fault", exc_info=error)
        trace = "".join(traceback.format_exception(error))
        failure = self._session.failure
        self._faulty = failure is not None and failure.error is error
        if self._faulty:
            said, about = solver_fault_words(error), FAULT
        else:
            said, about = fault_words(error), about or REFUSED
        again = [(tr("Try again"), self._session.go_on)] if self._faulty else []
        notices.show_notice("bad", *said, again, lasting=True, details=trace, about=about)

    def show_left(self, words: str) -> None:
        """Say that work which nobody waits for was stopped, and how it comes again."""
        said = tr("Stopped: {work}").format(work=words)
        self._window.notices.show_notice("info", said, tr("It begins again when you look at it next."))

    def show_written(self, about: str, sentence: str, path: str) -> None:
        """Say that a file has been written, and where, and no longer that it cannot be."""
        folder, notices = Path(path).absolute().parent, self._window.notices
        notices.withdraw(about)
        show = tr("Show folder"), partial(show_folder, folder, notices)
        notices.show_notice("ok", sentence, shown_folder(folder), [show])

    def show_not_saved(self, error: Exception) -> None:
        """Say why the project could not be saved, until it can."""
        self.show_failure(error, FILES)

    def show_saving(self, at_work: bool) -> None:
        """Say that the project is being saved, or no longer."""
        self._window.status.set_saved(tr("Saving…") if at_work else "")

    def show_saved(self, path: str) -> None:
        """Say when the project was saved."""
        remember_file(path)
        self._window.notices.withdraw(FILES)
        without = self._window.ask_desk.around.tries_on
        said = tr("Saved {time} without what is asked for") if without else tr("Saved {time}")
        self._window.status.set_saved(said.format(time=time.strftime("%H:%M")))
        self.show_title()

    def show_title(self) -> None:
        """Show the document's name, with a mark while it is unsaved."""
        unsaved = not self._session.undo_stack.isClean()
        name = self._session.name
        self._window.top.set_title(name, unsaved)
        self._window.setWindowTitle(f"{name}{'*' if unsaved else ''} - Busk" if name else "Busk")

    # -- the user asks

    def go_to(self, step: str) -> None:
        """Show a step: scan and landmarks on the body at rest, lines and result on the reshaped one."""
        if self._window.actions_.alone.isChecked():
            self._window.layout_.show_alone(False)
        self._window.layout_.show_work()
        self._window.rail.set_current(step)
        self._window.actions_.steps[step].setChecked(True)
        self._window.inspector.open(step)
        view, worn = self._window.view, step in ("lines", "result")
        if not worn:
            self._window.ask_desk.leave()  # its handles and its answer are of the reshaped body
        view.set_after(worn)
        view.set_layer("bands", worn)
        view.set_layer("landmarks", step == "landmarks")
        view.set_layer(
            "colours", not worn
        )  # nipples and seams help to place landmarks; lines show best on clay

    def show_model(self) -> None:
        """Show how the model works in the place of the lines; what it does is seen beside it."""
        self.go_to("lines")
        self._window.inspector.open("model")
        self._window.layout_.enter()

    def select_line(self, name: str) -> None:
        """Select a line in the list and on the body."""
        self._window.lines.select(name)
        self._window.garment.select(name)
        self._window.view.select_line(name)

    def select_landmark(self, name: str) -> None:
        """Select a landmark in the list and on the body."""
        self._window.landmarks.select(name)
        self._window.view.pins.select(name)

    def open(self) -> None:
        """Ask for a file and open it."""
        self.open_file(ask_open(self._window))

    def open_file(self, path: str) -> None:
        """Open a project, or a scan, which shows the Scan step: unit and front are to be looked at."""
        if path and self.may_leave():
            remember_folder("opened", path)
            self._chosen = path
            self._session.open(path)

    def open_sample(self, name: str) -> None:
        """Open one of the sample bodies."""
        if self.may_leave():
            self._session.open_design(lifted_sample(name))

    def save(self) -> bool:
        """Save the project, asking for a place the first time; returns whether it is being saved."""
        self.take_in()
        path = self._session.path
        if path is None:
            return self.save_as()
        if (protected := is_protected(path)) or self._session.changed_elsewhere:
            answer = ask_overwrite(self._window, self._session.name, protected)
            if answer != "overwrite":
                return answer == "elsewhere" and self.save_as()
        return self._session.save(str(path), self._preview())

    def save_as(self) -> bool:
        """Ask for a place and save the project there; returns whether it is being saved."""
        self.take_in()
        kinds = f"{tr('Projects')} (*.busk)"
        name = str(self._session.path or f"{self._session.name}.busk")
        path = ask_save(self._window, tr("Save as"), name, kinds, ".busk")
        return bool(path) and self._session.save(path, self._preview())

    def may_leave(self) -> bool:
        """Ask about unsaved changes; returns whether the document may be left. A save is waited for."""
        self.take_in()
        if self._session.finish_saving():
            return True
        answer = ask_about_changes(self._window, self._session.name)
        return self.save() and self._session.finish_saving() if answer == "save" else answer == "discard"

    def close(self) -> None:
        """Stop the clock of the plot."""
        self._plot_clock.stop()

    def _is_chosen_scan(self, design: Design) -> bool:
        """Tell, once, whether a design is the scan that the user has just chosen, and no project."""
        chosen, self._chosen = self._chosen, ""
        scan = design.scan
        return bool(chosen) and not scan.member and Path(scan.path) == Path(chosen).absolute()

    def take_in(self) -> None:
        """Make edits of what was decided a moment ago: of a pin moved by keys, of a name being typed."""
        self._window.landmark_desk.put_down()
        self._window.report_desk.page.tell_name()

    def _preview(self) -> bytes:
        """Return a small picture of the view, for the project file."""
        level = self._window.verdict_desk.of(self._frame).level if self._frame is not None else ""
        return project_picture(self._window.view.viewport.picture(labels=False), level)

    def plot_now(self) -> None:
        """Bring plots and figures up to date, if there is a frame that they have not shown."""
        frame = self._frame
        if frame is None or frame is self._plotted:
            return
        self._plotted = frame
        self._plot_due = time.monotonic() + PLOT_INTERVAL / 1000.0
        self._window.model.set_gain(frame.stages.gain, frame.stages.gain_limit)
        self._window.lines_desk.show_frame(frame)
        self._window.status.set_volume(*kept_volume(frame))
        self._window.status.set_facts(facts(frame, self._session.failure is None))
        main = frame.stages.design.volume
        strip = self._window.strip
        self._window.verdict_desk.show_frame(frame)
        strip.set_run(tracks(frame), main, exact_answer(frame))
        self._window.measures_desk.show_frame(frame)
