"""Work beside the window's thread; its answer comes back as a signal in that thread."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable

from PySide6.QtCore import QObject, Signal


class Background(QObject):
    """Runs plain functions in threads; ``finished`` carries (key, result) of those that came to an end.

    ``failed`` carries the key of one that did not: the log tells why.
    """

    finished = Signal(object, object)
    failed = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._threads: list[threading.Thread] = []
        self._open = True

    def run(self, key: object, work: Callable[[], object]) -> None:
        """Begin ``work``; ``key`` tells the receiver what the result belongs to."""

        def at_work() -> None:
            try:
                result = work()
            except Exception:
                logging.exception("background work failed")
                if self._open:
                    self.failed.emit(key)
                return
            if self._open:
                self.finished.emit(key, result)

        self._threads = [thread for thread in self._threads if thread.is_alive()]
        thread = threading.Thread(target=at_work, name="busk-background", daemon=True)
        self._threads.append(thread)
        thread.start()

    def close(self) -> None:
        """Let no answer come any more, and wait for what is at work."""
        self._open = False
        for thread in self._threads:
            thread.join()
