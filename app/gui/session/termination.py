"""Requests of the system to end the program: unsaved work is kept aside first."""

from __future__ import annotations

import logging
import signal
from collections.abc import Callable
from contextlib import suppress
from types import FrameType

from PySide6.QtCore import QCoreApplication, QObject, QTimer
from PySide6.QtGui import QGuiApplication

from app.gui.session.session import Session

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

    def __init__(
        self, session: Session, complete_edits: Callable[[], object], rescue: Callable[[], object]
    ) -> None:
        super().__init__()
        self._session, self._complete_edits, self._rescue = session, complete_edits, rescue
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
            self._complete_edits()
        if self._session.unsaved:
            self._rescue()

    def close(self) -> None:
        """Restore the signal handlers."""
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
