"""The log file: limited in size, with repeated messages collapsed."""

from __future__ import annotations

import copy
import logging
import traceback
from collections import Counter
from contextlib import suppress
from logging.handlers import RotatingFileHandler
from pathlib import Path

MOST_BYTES = 500_000
"""Size of a log file at which a new one begins; one former file is kept."""

_WRITTEN = 3  # times that a message is written each time; then at every power of ten
_MOST_KEYS = 1000


class LimitedLog(RotatingFileHandler):
    """Write records to a file of limited size; a record that repeats is written seldom, with its count."""

    def __init__(self, path: Path) -> None:
        super().__init__(path, maxBytes=MOST_BYTES, backupCount=1, encoding="utf-8", delay=True)
        self.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
        self._seen: Counter[tuple[str, ...]] = Counter()

    def emit(self, record: logging.LogRecord) -> None:
        """Write a record, unless it was written often enough."""
        if len(self._seen) > _MOST_KEYS:
            self._seen.clear()
        key = _key(record)
        self._seen[key] += 1
        count = self._seen[key]
        if count > _WRITTEN:
            if str(count).rstrip("0") != "1":
                return
            record = copy.copy(record)
            record.msg, record.args = f"{record.getMessage()} ({count} times)", None
        super().emit(record)

    def doRollover(self) -> None:  # noqa: N802 - the name in logging
        """Start a new file, or empty this one where another window holds it open (Windows)."""
        try:
            super().doRollover()
        except OSError:
            self.stream = open(self.baseFilename, "w", encoding="utf-8")  # noqa: SIM115 - closed with the log


def trim(path: Path) -> None:
    """Set a file aside that has grown beyond the limit, in place of the one set aside before."""
    with suppress(OSError):
        if path.stat().st_size > MOST_BYTES:
            path.replace(path.with_name(f"{path.name}.1"))


def _key(record: logging.LogRecord) -> tuple[str, ...]:
    """Return what repeated records have in common: the message, the error and where it was raised."""
    message = record.getMessage()[:200]
    if not record.exc_info or record.exc_info[0] is None:
        return (message,)
    where = traceback.extract_tb(record.exc_info[2])[-1:]
    place = f"{where[0].filename}:{where[0].lineno}" if where else ""
    return message, record.exc_info[0].__name__, place
