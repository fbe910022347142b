"""From the command to the open window; what takes long to import is imported while the body is being read."""

from __future__ import annotations

import gc
import os
import sys
from typing import TYPE_CHECKING

from app.application import application, log_kept
from app.asking.session import Session
from app.wording.display import has_display
from app.wording.samples import sample_design
from core.design import Design
from core.errors import UserError

if TYPE_CHECKING:
    from app.main_window import MainWindow


def run_window(file: str | None = None) -> int:
    """Open the window on a file, or on the sample, and stay until it is closed."""
    if not has_display() and "QT_QPA_PLATFORM" not in os.environ:
        raise UserError(
            "There is no display to open a window on.",
            "Use 'busk demo --out out' for the same session in pictures, or 'busk --help' for the commands.",
        )
    app = application()
    with log_kept():
        window = open_window(file if file is not None else sample_design())
        window.layout_.restore()
        window.show()
        code = app.exec()
    # What the window leaves is taken away here, in the thread that it belongs to.
    gc.collect()
    return code


def open_window(what: str | Design) -> MainWindow:
    """Return a window that is opening a file or a design."""
    # While the solver is at work, the window gets the interpreter lock sooner than after Python's usual 5 ms.
    sys.setswitchinterval(0.001)
    # The solver's thread reads the body while this one imports the 3D libraries.
    session = Session()
    if isinstance(what, Design):
        session.open_design(what)
    else:
        session.open(what)
    from app.main_window import MainWindow

    return MainWindow(session)
