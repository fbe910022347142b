"""Starts: which processes have ended at something that may take the whole program with it."""

from __future__ import annotations

import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

import platformdirs

from core.document.storage.file_lock import FolderLock
from core.files.atomic_write import private_folder

_BEGUN = "begun"


def starts_folder() -> Path:
    """Return the folder that holds a mark for each process that is, or was, at it."""
    return Path(platformdirs.user_state_path("Busk", appauthor=False)) / "starts"


class StartMarker:
    """The mark of this process, held as long as it lives. Raises OSError where none can be left."""

    def __init__(self) -> None:
        base = starts_folder()
        private_folder(base)
        self._folder = Path(tempfile.mkdtemp(dir=base))
        self._hold = FolderLock(self._folder)
        (self._folder / _BEGUN).touch()  # from here on it counts, and it is held already

    def remove(self) -> None:
        """Take the mark away: it went well."""
        with suppress(OSError):
            (self._folder / _BEGUN).unlink(missing_ok=True)
        self._hold.release()
        shutil.rmtree(self._folder, ignore_errors=True)


def failed_starts() -> list[Path]:
    """Return the marks whose process is gone; those of windows that are being opened do not count."""
    found = []
    for mark in starts_folder().glob(f"*/{_BEGUN}"):
        with suppress(OSError):
            FolderLock(mark.parent).release()
            found.append(mark.parent)
    return found


def forget_failed_starts() -> None:
    """Remove the marks whose process is gone."""
    for folder in failed_starts():
        shutil.rmtree(folder, ignore_errors=True)
