"""Writing: a file is written in a passing thread, so that the window does not wait for a disk."""

from __future__ import annotations

import threading
from collections.abc import Callable

from PySide6.QtCore import QObject, Signal

from core.errors import as_exception

Done = Callable[[Exception | None], None]
"""What follows, in the window's thread: it hears why nothing was written, or None if all went well."""


class BackgroundSave(QObject):
    """Writes one file after the other."""

    _over = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._thread: threading.Thread | None = None
        self._done: Done | None = None
        self._faults: list[Exception | None] = []
        self._over.connect(self._end)

    @property
    def at_work(self) -> bool:
        """Return whether something is being written."""
        return self._thread is not None

    def run(self, write: Callable[[], object], done: Done) -> None:
        """Start writing; ``done`` is called afterwards."""
        self.wait()
        self._done = done
        self._thread = threading.Thread(target=self._work, args=(write,), name="busk-writing", daemon=True)
        try:
            self._thread.start()
        except RuntimeError:  # memory for a thread is missing: the window waits, and nothing is lost
            self._work(write)

    def wait(self) -> None:
        """Wait until nothing is written any more, and do what follows."""
        if self._thread is not None:
            _join(self._thread)
            self._end()

    def _work(self, write: Callable[[], object]) -> None:
        fault: Exception | None = None
        try:
            write()
        except BaseException as error:  # who waits for the file must not wait for ever
            fault = as_exception(error)
        self._faults.append(fault)
        self._over.emit()

    def _end(self) -> None:
        # Who has waited was quicker than the signal.
        if not self._faults or self._thread is None or self._done is None:
            return
        _join(self._thread)
        fault, done = self._faults.pop(), self._done
        self._thread = self._done = None
        done(fault)


def _join(thread: threading.Thread) -> None:
    if thread.ident is not None:  # it was started
        thread.join()
