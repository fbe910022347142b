"""Reading regular files only, and never more of them than was agreed: a pipe or a device may not end."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

from core.messages import Message

TOO_LARGE = Message("the file is too large")
NOT_A_FILE = Message("not a file")
"""Reasons why something cannot be read: a folder, a pipe and a device are not files."""


def open_regular(path: str | os.PathLike[str]) -> int:
    """Open a file for reading, and return its descriptor. Raises OSError, at once where it is not a file."""
    _check(os.stat(path))
    # Should a pipe have taken its place meanwhile, it must not be waited for.
    flags = os.O_RDONLY | getattr(os, "O_BINARY", 0) | getattr(os, "O_NONBLOCK", 0)
    descriptor = os.open(path, flags)
    try:
        _check(os.fstat(descriptor))
    except OSError:
        os.close(descriptor)
        raise
    return descriptor


def read_regular(path: str | os.PathLike[str], most: int) -> bytes:
    """Return what a file of ``most`` bytes at most holds. Raises OSError, also if there are more."""
    with open(open_regular(path), "rb") as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise OSError(errno.EFBIG, TOO_LARGE)
    return data


def read_text(path: Path, most: int, encoding: str = "utf-8", errors: str = "strict") -> str:
    """Return the text of a file, see ``read_regular``. Raises UnicodeDecodeError if it is no such text."""
    return read_regular(path, most).decode(encoding, errors)


def _check(kind: os.stat_result) -> None:
    if stat.S_ISDIR(kind.st_mode):
        raise IsADirectoryError(errno.EISDIR, NOT_A_FILE)
    if not stat.S_ISREG(kind.st_mode):
        raise OSError(errno.EINVAL, NOT_A_FILE)
