"""Requests of the system to end the program: unsaved work is kept aside first."""

from __future__ import annotations

import logging
import signal
import socket
from contextlib import suppress
from types import FrameType
from typing import TYPE_CHECKING

from PySide6.QtCore import QCoreApplication, QObject, QSocketNotifier
from PySide6.QtGui import QGuiApplication

if TYPE_CHECKING:
    from app.main_window import MainWindow

_NAMES = ("SIGTERM", "SIGINT", "SIGHUP", "SIGBREAK")  # a system has some of them


class Termination(QObject):
    """Keeps the unsaved document aside on SIGTERM, SIGINT or SIGHUP, and ends the event loop.

    ``code`` is the exit code of the program then, 128 plus the number of the signal as shells expect it; 0
    while there was none. At the end of a desktop session the document is kept aside too; the system ends
    the program itself.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__()
        self._window = window
        self.code = 0
        # Python runs handlers between its own instructions only, and the event loop may sleep for long: the
        # system's handler writes to a socket, which wakes the loop.
        self._inlet, self._outlet = socket.socketpair()
        self._inlet.setblocking(False)
        self._outlet.setblocking(False)
        self._notifier = QSocketNotifier(self._outlet.fileno(), QSocketNotifier.Type.Read, self)
        self._notifier.activated.connect(self._read)
        self._fd = signal.set_wakeup_fd(self._inlet.fileno(), warn_on_full_buffer=False)
        numbers = [getattr(signal, name) for name in _NAMES if hasattr(signal, name)]
        # What is ignored stays so: a shell ignores SIGHUP for nohup.
        self._former = {
            number: signal.signal(number, _pass)
            for number in numbers
            if signal.getsignal(number) != signal.SIG_IGN
        }
        app = QGuiApplication.instance()
        if isinstance(app, QGuiApplication):
            app.commitDataRequest.connect(self.keep)

    def keep(self) -> None:
        """Keep the document aside, if it is not saved."""
        with suppress(Exception):  # an edit that cannot be completed must not prevent the copy
            self._window.desk.take_in()
        if self._window.session.unsaved:
            self._window.rescue()

    def close(self) -> None:
        """Give the signals back."""
        self._notifier.setEnabled(False)
        signal.set_wakeup_fd(self._fd)
        for number, former in self._former.items():
            signal.signal(number, former)
        self._inlet.close()
        self._outlet.close()
        app = QGuiApplication.instance()
        if isinstance(app, QGuiApplication):
            app.commitDataRequest.disconnect(self.keep)

    def _read(self) -> None:
        with suppress(BlockingIOError):
            for number in self._outlet.recv(64):
                if number in self._former and not self.code:
                    self.code = 128 + number
                    logging.warning("ended by signal %d", number)
                    self.keep()
                    QCoreApplication.exit(self.code)


def _pass(number: int, frame: FrameType | None) -> None:
    """Leave a signal to the socket."""
