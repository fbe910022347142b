"""Writing a file whole or not at all: through links, with its access rights, under a name of its own."""

from __future__ import annotations

import errno
import os
import secrets
import stat
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from glob import escape
from pathlib import Path

from core.errors import ProjectError, reason_of
from core.files.regular_file import NOT_A_FILE
from core.messages import Message

PRIVATE_FILE, PRIVATE_FOLDER = 0o600, 0o700
"""Access rights of personal data: its owner's alone."""

_USUAL = 0o666
"""Access rights of any other new file, of which the system takes those that its user does not give."""

_ABANDONED = 600.0
"""Seconds after which nobody writes any more to a file that is not whole."""

_STEM = 40
"""Letters of a target's name in that of its partial file, so few that no system refuses its length."""

_HINTS = {
    errno.ENOSPC: Message("Choose another folder or free up disk space."),
    errno.EDQUOT: Message("Choose another folder or free up disk space."),
    errno.ENAMETOOLONG: Message("Choose a shorter name."),
    errno.EINVAL: Message("Choose another name."),
}

_LOCK = threading.Lock()
_AT_WORK: set[str] = set()
"""What this program is writing: two at once under one name would take each other's place unsaid."""


@contextmanager
def atomic_path(target: Path, private: bool = False) -> Iterator[Path]:
    """Yield a path beside ``target`` to write to; it replaces the target only on success.

    Of a symbolic link the file that it names is written. A file that is there keeps its access rights; a new
    one that is ``private`` is its owner's alone. Raises ProjectError if the place cannot be written to, told
    as it was named, or is being written to already.
    """
    place = os.path.normcase(os.path.realpath(target))
    with _LOCK:
        if place in _AT_WORK:
            raise still_writing_error(target.absolute())
        _AT_WORK.add(place)
    try:
        yield from _whole_file(target, private)
    finally:
        with _LOCK:
            _AT_WORK.discard(place)


def write_text(target: Path, text: str, encoding: str = "utf-8", private: bool = False) -> None:
    """Write a text as a whole file; of the name of some file it may hold letters that no text has, which are
    replaced. Raises ProjectError, see ``atomic_path``.
    """
    with atomic_path(target, private) as partial:
        partial.write_bytes(text.encode(encoding, errors="replace"))


def still_writing_error(target: Path) -> ProjectError:
    """Return what to say when a file is to be written that is on its way already."""
    return ProjectError(
        Message("{file} is still being written.", file=target.name),
        Message("Try again later, or choose another name."),
    )


def private_folder(folder: Path) -> Path:
    """Make a folder, where there is none, and leave it to its owner alone. Raises OSError."""
    folder.mkdir(PRIVATE_FOLDER, parents=True, exist_ok=True)
    if stat.S_IMODE(folder.stat().st_mode) & ~PRIVATE_FOLDER:
        with suppress(OSError):  # of a folder of somebody else, or where there are no access rights
            folder.chmod(PRIVATE_FOLDER)
    return folder


def resolve_links(path: Path) -> Path:
    """Return the file that a path means: at the end of its symbolic links, whether it is there or not."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path.absolute()


def remove_abandoned(folder: Path, name: str = "") -> None:
    """Remove what programs that were killed in the middle of writing have left of files of this ``name``."""
    with suppress(OSError):
        for left in folder.glob(f".{escape(name[:_STEM])}*.part"):
            if time.time() - left.lstat().st_mtime > _ABANDONED:
                left.unlink()


def safe_ending(name: str, ending: str) -> str:
    """Return the name of a hidden file beside one of this name, never longer than systems take."""
    whole = f".{name}.{ending}"
    return whole if len(os.fsencode(whole)) <= 255 else f".{name[:_STEM]}.{ending}"


def _whole_file(named: Path, private: bool) -> Iterator[Path]:
    partial = None
    try:
        target = resolve_links(named)
        former = _former(target)
        remove_abandoned(target.parent, target.name)
        partial = _new_partial(target, PRIVATE_FILE if private or former else _USUAL)
        yield partial
        _finish(partial, former)
        os.replace(partial, target)
    except OSError as problem:
        raise ProjectError(
            Message("{file} cannot be written: {problem}.", file=str(named), problem=reason_of(problem)),
            _HINTS.get(problem.errno or 0, Message("Choose another folder.")),
        ) from problem
    finally:
        # Where nothing can be written nothing can be removed: the first problem is the one to tell.
        if partial is not None:
            with suppress(OSError):
                partial.unlink(missing_ok=True)


def _former(target: Path) -> os.stat_result | None:
    """Return what is known of the file that is there, None if there is none. Raises OSError."""
    try:
        former = target.lstat()
    except FileNotFoundError:
        return None
    if stat.S_ISDIR(former.st_mode):
        raise IsADirectoryError(errno.EISDIR, NOT_A_FILE)
    if not stat.S_ISREG(former.st_mode):  # a pipe, a device, or links in a circle
        raise OSError(errno.EINVAL, NOT_A_FILE)
    return former


def _new_partial(target: Path, rights: int) -> Path:
    """Return an empty file beside ``target`` that was not there before, under a name nobody can guess."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0)
    partial = target.with_name(f".{target.name[:_STEM]}.{secrets.token_hex(8)}.part")
    os.close(os.open(partial, flags, rights))
    return partial


def _finish(partial: Path, former: os.stat_result | None) -> None:
    """Let what was written reach the disk, with the access rights of the ``former`` file. Raises OSError."""
    with open(partial, "rb+") as written:
        os.fsync(written.fileno())
        if former is not None and hasattr(os, "fchmod"):
            rights = stat.S_IMODE(former.st_mode)
            if os.fstat(written.fileno()).st_gid != former.st_gid:
                try:
                    os.fchown(written.fileno(), -1, former.st_gid)
                except OSError:
                    rights &= ~0o070  # what its group could do, another group must not
            os.fchmod(written.fileno(), rights)
