"""From the command to the open window; what takes long to import is imported while the body is being read."""

from __future__ import annotations

import gc
import os
import sys
from typing import TYPE_CHECKING

from app.application import application, hand_files_to, log_kept
from app.dress.waiting import Waiting
from app.keeping.recent import file_at_start, is_first_start
from app.showing.graphics import begin_graphics, graphics_work
from app.wording.display import has_display
from app.wording.samples import sample_design
from core.design import Design
from core.errors import UserError

if TYPE_CHECKING:
    from app.main_window import MainWindow


def run_window(file: str | None = None, safe: bool = False) -> int:
    """Open the window on a file, on the sample or on the start page, and stay until it is closed.

    ``safe`` has the 3D view painted without the graphics driver.
    """
    if not has_display() and "QT_QPA_PLATFORM" not in os.environ:
        raise UserError(
            "There is no display to open a window on.",
            "Use 'busk demo --out out' for the same session in pictures, or 'busk --help' for the commands.",
        )
    app = application()
    # Before anything that takes long: whoever has asked for a window sees that it comes.
    waiting = Waiting.shown()
    with log_kept():
        why = begin_graphics(safe)
        first = file is None and is_first_start()
        window = open_window(file if file is not None else _at_start())
        window.tell_graphics(why)
        window.layout_.restore()
        window.show()
        waiting.close()
        window.recovery_desk.look()
        if first:
            window.start_desk.tour.begin_when_settled()
        hand_files_to(window.desk.open_file)
        code = app.exec()
        hand_files_to(None)
        graphics_work()
    # What the window leaves is taken away here, in the thread that it belongs to.
    gc.collect()
    return code


def _at_start() -> str | Design | None:
    """Return what to open unasked: the sample at first, later the last file if that is wished, or nothing."""
    return sample_design() if is_first_start() else file_at_start() or None


def open_window(what: str | Design | None) -> MainWindow:
    """Return a window that is opening a file or a design, or shows the start page."""
    # While the solver is at work, the window gets the interpreter lock sooner than after Python's usual 5 ms.
    sys.setswitchinterval(0.001)
    from app.asking.session import Session

    # The solver's thread reads the body while this one imports the 3D libraries.
    session = Session()
    if isinstance(what, Design):
        session.open_design(what)
    elif what is not None:
        session.open(what)
    from app.main_window import MainWindow

    window = MainWindow(session)
    if what is None:
        window.start_desk.show_page()
    return window
