"""A hold on a folder that ends with the process that has it, however that ends."""

from __future__ import annotations

import os
import sys
from pathlib import Path

if sys.platform == "win32":
    import msvcrt

    def _lock(file: int) -> None:
        msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
else:
    import fcntl

    def _lock(file: int) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


class FolderLock:
    """Holds a folder by a lock on the file "lock" in it. Raises OSError if someone holds it already.

    The lock is the system's, not the file: a process that was killed holds nothing, and none that happens to
    have got its number is taken for it. (The package filelock makes a lasting file of it where the system has
    no such lock; QLockFile goes by that number.)
    """

    def __init__(self, folder: Path) -> None:
        self._file = os.open(folder / "lock", os.O_RDWR | os.O_CREAT, 0o600)
        try:
            _lock(self._file)
        except OSError:
            os.close(self._file)
            raise

    def release(self) -> None:
        """Release the folder."""
        os.close(self._file)
