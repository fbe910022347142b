"""From the command to the open window: first it is painted, then come the body and the 3D libraries."""

from __future__ import annotations

import gc
import os
import sys
from functools import partial
from typing import TYPE_CHECKING

from app.gui.application import application, hand_files_to, log_kept
from app.gui.features.project.recent_files import file_at_start, is_first_start
from app.gui.session.termination import Termination
from app.gui.viewport.opengl import begin_graphics, graphics_work
from app.gui.widgets.first_paint import when_painted
from app.presenters.samples import dressed_sample
from app.rendering.display import has_display
from core.document.design import Design
from core.errors import UserError
from core.messages import Message

if TYPE_CHECKING:
    from PySide6.QtWidgets import QApplication

    from app.gui.main_window import MainWindow


def run_window(file: str | None = None, safe: bool = False) -> int:
    """Open the window on a file, on the sample or on the start page, and stay until it is closed.

    ``safe`` has the 3D view painted without the graphics driver.
    """
    if not has_display() and "QT_QPA_PLATFORM" not in os.environ:
        raise UserError(
            Message("No display available for the window."),
            Message(
                "Use 'busk demo --out out' for an off-screen session, or 'busk --help' for the commands."
            ),
        )
    app = application()
    with log_kept():
        why = begin_graphics(safe)
        first = file is None and is_first_start()
        what = file if file is not None else _at_start()
        window = make_window()
        window.tell_graphics(why)
        if what is None:
            window.start_controller.show_page()
        window.layout_.restore()
        when_painted(window, partial(_go_on, window, what))
        window.show()
        window.recovery_controller.look()
        if first:
            window.start_controller.tour.begin_when_settled()
        code = _run(app, window)
        hand_files_to(None)
        graphics_work()
    # What the window leaves is taken away here, in the thread that it belongs to.
    gc.collect()
    return code


def _run(app: QApplication, window: MainWindow) -> int:
    """Run the event loop until the window is closed or a signal ends the program; returns the exit code."""
    termination = Termination(window.session, window.project_controller.complete_edits, window.rescue)
    code = app.exec()
    termination.close()
    if termination.code:
        window.end()
    return code


def _at_start() -> str | Design | None:
    """Return what to open unasked: the sample at first, later the last file if that is wished, or nothing."""
    return dressed_sample() if is_first_start() else file_at_start() or None


def _go_on(window: MainWindow, what: str | Design | None) -> None:
    """Do what takes long, now that the window is there: read the body, load the 3D libraries."""
    _open(window, what)
    hand_files_to(window.project_controller.open_file)
    window.view.prepare(window.garbage_collection.spare, window.crash_handler.note)


def open_window(what: str | Design | None) -> MainWindow:
    """Return a window, not shown yet, that is opening a file or a design, or has the start page."""
    window = make_window()
    if what is None:
        window.start_controller.show_page()
    _open(window, what)
    return window


def make_window() -> MainWindow:
    """Return a window on nothing."""
    # While the solver is at work, the window gets the interpreter lock sooner than after Python's usual 5 ms.
    sys.setswitchinterval(0.001)
    from PySide6.QtWidgets import QApplication

    from app.gui.main_window import MainWindow
    from app.gui.session.session import Session

    app = QApplication.instance()
    assert isinstance(app, QApplication)
    style = app.styleSheet()
    app.setStyleSheet("")  # Else every part is styled once more whenever it is put into another.
    try:
        return MainWindow(Session())
    finally:
        app.setStyleSheet(style)


def _open(window: MainWindow, what: str | Design | None) -> None:
    if isinstance(what, Design):
        window.session.open_design(what)
    elif what is not None:
        window.session.open(what)
