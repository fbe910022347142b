"""Requests of the system to end the program: unsaved work is kept aside first."""

from __future__ import annotations

import logging
import signal
from contextlib import suppress
from types import FrameType
from typing import TYPE_CHECKING

from PySide6.QtCore import QCoreApplication, QObject, QTimer
from PySide6.QtGui import QGuiApplication

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow

_NAMES = ("SIGTERM", "SIGINT", "SIGHUP", "SIGBREAK")  # a system has some of them

_INTERVAL = 100
"""Milliseconds between two checks: Python runs handlers between its own instructions only, not while the
event loop sleeps.
"""


class Termination(QObject):
    """Keeps the unsaved document aside on SIGTERM, SIGINT or SIGHUP, and ends the event loop.

    ``code`` is the exit code of the program then, 128 plus the number of the signal as shells expect it; 0
    while there was none. At the end of a desktop session the document is kept aside too; the system ends
    the program itself.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__()
        self._window = window
        self._number = self.code = 0
        numbers = [getattr(signal, name) for name in _NAMES if hasattr(signal, name)]
        # What is ignored stays so: nohup has SIGHUP ignored.
        self._former = {
            number: signal.signal(number, self._note)
            for number in numbers
            if signal.getsignal(number) != signal.SIG_IGN
        }
        self._clock = QTimer(self, interval=_INTERVAL)
        self._clock.timeout.connect(self._check)
        self._clock.start()
        app = QGuiApplication.instance()
        if isinstance(app, QGuiApplication):
            app.commitDataRequest.connect(self.keep)

    def keep(self) -> None:
        """Keep the document aside, if it is not saved."""
        with suppress(Exception):  # an edit that cannot be completed must not prevent the copy
            self._window.project_controller.complete_edits()
        if self._window.session.unsaved:
            self._window.rescue()

    def close(self) -> None:
        """Give the signals back."""
        self._clock.stop()
        for number, former in self._former.items():
            signal.signal(number, former)
        app = QGuiApplication.instance()
        if isinstance(app, QGuiApplication):
            app.commitDataRequest.disconnect(self.keep)

    def _note(self, number: int, frame: FrameType | None) -> None:
        # It comes in the middle of anything: the copy is made between two events.
        self._number = number

    def _check(self) -> None:
        if self._number and not self.code:
            self.code = 128 + self._number
            logging.warning("ended by signal %d", self._number)
            self.keep()
            QCoreApplication.exit(self.code)
