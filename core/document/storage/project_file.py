"""The project file ``*.busk``: one zip with the design, the untouched scan and a picture, never a result."""

from __future__ import annotations

import os
import re
import stat
import zipfile
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from core.document.design import ScanSource
from core.document.document import Document
from core.document.document_limits import LARGEST_PICTURE, LARGEST_SCAN, LARGEST_TEXT, check_size
from core.document.serialization import DESIGN, VARIANTS, from_texts, to_texts
from core.document.storage.archive import member_bytes, project_archive
from core.errors import ProjectError, ScanError, UserError
from core.files.atomic_write import atomic_path
from core.messages import Message
from core.progress import Progress, quiet
from core.scan.readers.registry import scan_bytes

SUFFIX = ".busk"
_PICTURE = "preview.png"
_UNSAFE = re.compile(r'[<>:"/\\|?*\x00-\x1f\ud800-\udfff]')
_WRITABLE = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH

Stamp = tuple[int, int, int]
"""What tells one state of a file from another: when it was changed, its size and its number on the disk."""


@dataclass(frozen=True, eq=False)
class ScanFile:
    """The scan as it came: its file name and its bytes, kept so that a project can always be saved whole."""

    name: str
    data: bytes


def is_project(path: str | os.PathLike[str]) -> bool:
    """Return whether the name is that of a project."""
    return Path(path).suffix.lower() == SUFFIX


def save_project(
    path: str | os.PathLike[str], document: Document, scan: ScanFile, picture: bytes | None
) -> Document:
    """Save a project completely or not at all; return the document with its scan inside that file.

    Raises ProjectError if the file cannot be written, or could not be opened again; an existing file is then
    kept.
    """
    target = Path(path).absolute()
    member = f"scan/{safe_name(scan.name)}"
    # The project may move to another place: inside it the scan needs no path.
    inside = with_scan(document, "", member)
    texts = _checked_texts(inside)
    check_size(member, scan.data, LARGEST_SCAN)
    with (
        atomic_path(target, private=True) as partial,
        zipfile.ZipFile(partial, "w", zipfile.ZIP_STORED) as archive,
    ):
        for name, text in texts.items():
            archive.writestr(name, text)
        archive.writestr(member, scan.data)
        if picture and len(picture) <= LARGEST_PICTURE:
            archive.writestr(_PICTURE, picture)
    return with_scan(inside, str(target), member)


def open_project(path: str | os.PathLike[str]) -> Document:
    """Open a project; its scan is read from the same file. Raises ProjectError."""
    source = Path(path)
    with project_archive(source) as archive:
        names = [DESIGN, *({VARIANTS} & set(archive.namelist()))]
        document = from_texts({name: _text(archive, name) for name in names})
        member = document.design.scan.member
        if member not in archive.namelist():
            raise ProjectError(
                Message("{file} contains no scan.", file=source.name),
                Message("Open a backup or start from the scan."),
            )
    return with_scan(document, str(source.absolute()), member)


def with_scan(document: Document, path: str, member: str) -> Document:
    """Return the document with its scan in a file, for every variant."""
    scan = replace(document.design.scan, path=path, member=member)
    return document.with_design(replace(document.design, scan=scan))


def read_scan_file(source: ScanSource, progress: Progress = quiet) -> ScanFile:
    """Read the bytes of a scan, alone or inside a project. Raises ScanError, ProjectError, Cancelled."""
    if not source.path:
        raise ScanError(Message("No file specified."), Message("Choose a scan or a project."))
    if source.member:
        with project_archive(Path(source.path)) as archive:
            return ScanFile(source.name, member_bytes(archive, source.member, LARGEST_SCAN))
    return ScanFile(source.name, scan_bytes(Path(source.path), progress))


def file_stamp(path: Path | None) -> Stamp | None:
    """Return the stamp of a file, or None if there is none."""
    try:
        kind = path.stat() if path is not None else None
    except OSError:
        return None
    return (kind.st_mtime_ns, kind.st_size, kind.st_ino) if kind is not None else None


def is_protected(path: Path) -> bool:
    """Return whether a file is there that nobody may write to."""
    try:
        return not path.stat().st_mode & _WRITABLE
    except OSError:
        return False


def safe_name(name: str) -> str:
    """Return a file name that every system takes, whatever system or hand the project came from."""
    return _UNSAFE.sub("_", name)[-60:].strip(". ") or "scan"


def picture_bytes(path: Path) -> bytes | None:
    """Return the picture in a project, None where there is none that can be read."""
    with suppress(ProjectError), project_archive(path) as archive:
        return member_bytes(archive, _PICTURE, LARGEST_PICTURE)
    return None


def _text(archive: zipfile.ZipFile, name: str) -> str:
    return member_bytes(archive, name, LARGEST_TEXT).decode("utf-8", errors="replace")


def _checked_texts(document: Document) -> dict[str, bytes]:
    """Return what is written of a document by name. Raises ProjectError if it could not be opened again."""
    texts = to_texts(document)
    try:
        from_texts(texts)
    except UserError as problem:
        raise ProjectError(
            Message("The saved project cannot be opened again: {problem}", problem=problem.message),
            Message("Undo the last change, then save."),
        ) from problem
    written = {name: text.encode() for name, text in texts.items()}
    for name, data in written.items():
        check_size(name, data, LARGEST_TEXT)
    return written
