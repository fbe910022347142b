"""The project file ``*.busk``: one zip with the design, the untouched scan and a picture, never a result."""

from __future__ import annotations

import json
import os
import re
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path

from core.design import ScanSource
from core.design_text import FORMAT, from_json, to_json
from core.document import Document
from core.errors import ProjectError, UserError
from core.progress import Progress, quiet
from core.reading.scan_file import scan_bytes

SUFFIX = ".busk"
_LARGEST_SCAN = 2_000_000_000
_LARGEST_DESIGN = 1_000_000

_UNSAFE = re.compile(r'[<>:"/\\|?*\x00-\x1f\ud800-\udfff]')
_BROKEN_ARCHIVE = (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, ValueError)


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
    member = f"scan/{_safe_name(scan.name)}"
    # The project may move to another place: inside it the scan needs no path.
    inside = _with_scan(document, "", member)
    with whole_file(target) as partial, zipfile.ZipFile(partial, "w", zipfile.ZIP_STORED) as archive:
        for name, text in _texts(inside).items():
            archive.writestr(name, text)
        archive.writestr(member, scan.data)
        if picture:
            archive.writestr("preview.png", picture)
    return _with_scan(inside, str(target), member)


def open_project(path: str | os.PathLike[str]) -> Document:
    """Read the document of a project; its scan is read from the same file. Raises ProjectError."""
    source = Path(path).absolute()
    with _archive(source) as archive:
        document = _document(archive)
        member = document.design.scan.member
        if member not in archive.namelist():
            raise ProjectError(
                f"{source.name} holds no scan.", "Open a backup, or start again from the scan."
            )
    return _with_scan(document, str(source), member)


def _texts(document: Document) -> dict[str, str]:
    """Return what is written of a document, by member."""
    others = {name: json.loads(to_json(each)) for name, each in document.designs if name != document.shown}
    if document == Document.of(document.design):
        return {"design.json": to_json(document.design)}
    # An older program would drop the variants at its next save: it must not read this.
    variants = {"shown": document.shown, "others": others}
    return {"design.json": to_json(document.design, FORMAT), "variants.json": json.dumps(variants, indent=1)}


def _document(archive: zipfile.ZipFile) -> Document:
    design = from_json(_text(archive, "design.json"))
    if "variants.json" not in archive.namelist():
        return Document.of(design)
    try:
        told = json.loads(_text(archive, "variants.json"))
        others = {str(name): from_json(json.dumps(each)) for name, each in told["others"].items()}
        designs = others | {str(told["shown"]): design}
        return Document(tuple(sorted(designs.items())), str(told["shown"])).with_design(design)
    except (UserError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as broken:
        raise ProjectError("The project's variants cannot be read.", "Open a backup.") from broken


def _with_scan(document: Document, path: str, member: str) -> Document:
    """Return the document with its scan in a file, for every variant."""
    scan = replace(document.design.scan, path=path, member=member)
    return document.with_design(replace(document.design, scan=scan))


def read_scan_file(source: ScanSource, progress: Progress = quiet) -> ScanFile:
    """Read the bytes of a scan, alone or inside a project. Raises ScanError, ProjectError, Cancelled."""
    if source.member:
        with _archive(Path(source.path)) as archive:
            return ScanFile(source.name, _member(archive, source.member, _LARGEST_SCAN))
    return ScanFile(source.name, scan_bytes(Path(source.path), progress))


def _safe_name(name: str) -> str:
    """Return a file name that every system takes, whatever system or hand the project came from."""
    return _UNSAFE.sub("_", name)[-60:].strip(". ") or "scan"


@contextmanager
def whole_file(target: Path) -> Iterator[Path]:
    """Give a name beside ``target`` to write to; it takes the target's place only when all went well.

    Raises ProjectError if the place cannot be written to.
    """
    partial = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        yield partial
        with open(partial, "rb+") as written:
            os.fsync(written.fileno())
        os.replace(partial, target)
    except OSError as problem:
        raise ProjectError(
            f"{target} cannot be written: {problem.strerror or problem}.",
            "Choose another folder or make room.",
        ) from problem
    finally:
        # Where nothing can be written nothing can be removed: the first problem is the one to tell.
        with suppress(OSError):
            partial.unlink(missing_ok=True)


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
