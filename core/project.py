"""The project file ``*.busk``: one zip with the design, the untouched scan and a picture, never a result."""

from __future__ import annotations

import errno
import os
import re
import threading
import time
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from glob import escape
from pathlib import Path

from core.design import ScanSource
from core.document import Document
from core.document_text import DESIGN, VARIANTS, from_texts, to_texts
from core.errors import ProjectError
from core.progress import Progress, quiet
from core.reading.scan_file import scan_bytes

SUFFIX = ".busk"
_LARGEST_SCAN = 2_000_000_000
_LARGEST_DESIGN = 1_000_000

_ABANDONED = 600.0
"""Seconds after which nobody writes any more to a file that is not whole."""

_LOCK = threading.Lock()
_AT_WORK: set[str] = set()
"""What this program is writing: two at once under one name would take each other's place unsaid."""

_UNSAFE = re.compile(r'[<>:"/\\|?*\x00-\x1f\ud800-\udfff]')
_FULL = (errno.ENOSPC, errno.EDQUOT)
_BROKEN_ARCHIVE = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError)


Stamp = tuple[int, int, int]
"""What tells one state of a file from another: when it was changed, its size and its number on the disk."""


@dataclass(frozen=True, eq=False)
class ScanFile:
    """The scan as it came: its file name and its bytes, kept so that a project can always be saved whole."""

    name: str
    data: bytes


def is_project(path: str | os.PathLike[str]) -> bool:
    """Tell whether the name is that of a project."""
    return Path(path).suffix.lower() == SUFFIX


def save_project(
    path: str | os.PathLike[str], document: Document, scan: ScanFile, picture: bytes | None
) -> Document:
    """Write the project whole or not at all, and return the document with its scan inside that file.

    Raises ProjectError if the file cannot be written; what was there before then stays.
    """
    target = Path(path).absolute()
    member = f"scan/{safe_name(scan.name)}"
    # The project may move to another place: inside it the scan needs no path.
    inside = with_scan(document, "", member)
    with whole_file(target) as partial, zipfile.ZipFile(partial, "w", zipfile.ZIP_STORED) as archive:
        for name, text in to_texts(inside).items():
            archive.writestr(name, text)
        archive.writestr(member, scan.data)
        if picture:
            archive.writestr("preview.png", picture)
    return with_scan(inside, str(target), member)


def open_project(path: str | os.PathLike[str]) -> Document:
    """Read the document of a project; its scan is read from the same file. Raises ProjectError."""
    source = Path(path)
    with _archive(source) as archive:
        names = [DESIGN, *({VARIANTS} & set(archive.namelist()))]
        document = from_texts({name: _text(archive, name) for name in names})
        member = document.design.scan.member
        if member not in archive.namelist():
            raise ProjectError(
                f"{source.name} holds no scan.", "Open a backup, or start again from the scan."
            )
    return with_scan(document, str(source.absolute()), member)


def with_scan(document: Document, path: str, member: str) -> Document:
    """Return the document with its scan in a file, for every variant."""
    scan = replace(document.design.scan, path=path, member=member)
    return document.with_design(replace(document.design, scan=scan))


def read_scan_file(source: ScanSource, progress: Progress = quiet) -> ScanFile:
    """Read the bytes of a scan, alone or inside a project. Raises ScanError, ProjectError, Cancelled."""
    if source.member:
        with _archive(Path(source.path)) as archive:
            return ScanFile(source.name, _member(archive, source.member, _LARGEST_SCAN))
    return ScanFile(source.name, scan_bytes(Path(source.path), progress))


def stamp_of(path: Path | None) -> Stamp | None:
    """Return the stamp of a file, or None if there is none."""
    try:
        stat = path.stat() if path is not None else None
    except OSError:
        return None
    return (stat.st_mtime_ns, stat.st_size, stat.st_ino) if stat is not None else None


def safe_name(name: str) -> str:
    """Return a file name that every system takes, whatever system or hand the project came from."""
    return _UNSAFE.sub("_", name)[-60:].strip(". ") or "scan"


@contextmanager
def whole_file(target: Path) -> Iterator[Path]:
    """Give a name beside ``target`` to write to; it takes the target's place only when all went well.

    Raises ProjectError if the place cannot be written to, told as it was named, or is being written to
    already.
    """
    place = os.path.normcase(os.path.realpath(target))
    with _LOCK:
        if place in _AT_WORK:
            raise still_written(target.absolute())
        _AT_WORK.add(place)
    try:
        yield from _whole_file(target)
    finally:
        with _LOCK:
            _AT_WORK.discard(place)


def still_written(target: Path) -> ProjectError:
    """Return what to say when a file is to be written that is on its way already."""
    return ProjectError(f"{target.name} is still being written.", "Wait a moment, or choose another name.")


def _whole_file(named: Path) -> Iterator[Path]:
    target = named.absolute()
    partial = target.with_name(f".{target.name}.{os.getpid()}.part")
    _sweep(target)
    try:
        yield partial
        with open(partial, "rb+") as written:
            os.fsync(written.fileno())
        os.replace(partial, target)
    except OSError as problem:
        raise ProjectError(
            f"{named} cannot be written: {problem.strerror or problem}.",
            "Choose another folder or make room." if problem.errno in _FULL else "Choose another folder.",
        ) from problem
    finally:
        # Where nothing can be written nothing can be removed: the first problem is the one to tell.
        with suppress(OSError):
            partial.unlink(missing_ok=True)


def _sweep(target: Path) -> None:
    """Remove what a program that was killed in the middle of writing has left beside ``target``."""
    with suppress(OSError):
        for left in target.parent.glob(f".{escape(target.name)}.*.part"):
            if time.time() - left.stat().st_mtime > _ABANDONED:
                left.unlink()


@contextmanager
def _archive(path: Path) -> Iterator[zipfile.ZipFile]:
    try:
        with zipfile.ZipFile(path) as archive:
            yield archive
    except FileNotFoundError:
        raise ProjectError(f"There is no project {path}.", "Check the name, or choose another one.") from None
    except OSError as problem:
        raise ProjectError(
            f"{path.name} cannot be read: {problem.strerror or problem}.", "Check the file, or open a backup."
        ) from problem
    except _BROKEN_ARCHIVE as problem:
        raise ProjectError(
            f"{path.name} is not a whole Busk project.", "Open a backup, or start again from the scan."
        ) from problem


def _text(archive: zipfile.ZipFile, name: str) -> str:
    return _member(archive, name, _LARGEST_DESIGN).decode("utf-8", errors="replace")


def _member(archive: zipfile.ZipFile, name: str, largest: int) -> bytes:
    try:
        size = archive.getinfo(name).file_size
    except KeyError:
        raise ProjectError("This file is no Busk project.", "Open a .busk file or a scan.") from None
    if size > largest:
        raise ProjectError(
            f"{name} in this project claims to be {size / 1e6:.0f} MB.", "It is broken: open a backup."
        )
    return archive.read(name)
