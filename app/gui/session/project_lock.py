"""A lock beside a project, so that two windows do not overwrite each other unknowingly."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QFileInfo, QLockFile

from core.files.atomic_write import safe_ending


class ProjectLock:
    """Locks one project at a time; a lock whose program is gone is taken over."""

    def __init__(self) -> None:
        self._lock: QLockFile | None = None
        self.path: Path | None = None

    def take(self, path: Path | None) -> float | None:
        """Lock a project in the place of the last one; returns since when [s since 1970] another window has
        it, if one does.

        Where no lock can be written there is none.
        """
        self.release()
        self.path = path
        if path is None:
            return None
        name = str(path.with_name(safe_ending(path.name, "lock")))
        lock = QLockFile(name)
        # A designer may have a project open all day: only the end of the program makes a lock stale.
        lock.setStaleLockTime(0)
        if lock.tryLock(0):
            self._lock = lock
        elif lock.error() == QLockFile.LockError.LockFailedError:
            return QFileInfo(name).lastModified().toSecsSinceEpoch()
        return None

    def release(self) -> None:
        """Let others have the project."""
        if self._lock is not None:
            self._lock.unlock()
            self._lock = None
