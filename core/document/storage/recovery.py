"""Recovery: what is not saved yet is kept in a folder of the running window, to be found after a crash.

A folder holds the document as texts, the untouched scan once, and a small picture. It belongs to a window as
long as that holds it; what is found unheld was left behind by a crash.
"""

from __future__ import annotations

import json
import shutil
import tempfile
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import platformdirs

from core.document.document import Document
from core.document.document_limits import LARGEST_PICTURE, LARGEST_TEXT
from core.document.json_values import parsed, value_of
from core.document.serialization import from_texts, to_texts
from core.document.storage.file_lock import FolderLock
from core.document.storage.project_file import ScanFile, Stamp, safe_name, with_scan
from core.errors import ProjectError, UserError, reason_of
from core.files.atomic_write import atomic_path, private_folder, write_text
from core.files.regular_file import read_regular, read_text
from core.messages import Message

_DOCUMENT, _PICTURE, _ASIDE = "document.json", "picture.png", ".broken"


def recovery_folder() -> Path:
    """Return the folder that holds those of all windows."""
    return Path(platformdirs.user_state_path("Busk", appauthor=False)) / "recovery"


@dataclass(frozen=True)
class RecoveredDocument:
    """A document that was not saved, its scan where it is kept: the ``project`` it was opened from, if any,
    and its ``stamp`` as it was known then, when it was kept (``time`` [s] since 1970) and a PNG ``picture``.
    """

    document: Document
    name: str
    project: Path | None
    time: float
    picture: bytes | None
    stamp: Stamp | None = None


@dataclass(frozen=True)
class _Told:
    """What a folder tells of a document beside its texts."""

    name: str
    time: float
    scan: str
    size: int
    project: str | None = None
    stamp: Stamp | None = None


class Recovery:
    """The recovery folder of one window, held by it. Raises OSError if another one holds it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._hold = FolderLock(folder)
        self._scan: ScanFile | None = None
        self._place: Path | None = None

    @classmethod
    def new(cls) -> Recovery:
        """Return a folder of its own for a window. Raises ProjectError if there can be none."""
        base = recovery_folder()
        try:
            private_folder(base)
            return cls(Path(tempfile.mkdtemp(prefix=time.strftime("%Y%m%d-%H%M%S-"), dir=base)))
        except OSError as problem:
            raise _unkept(base, problem) from problem

    def save(
        self,
        document: Document,
        scan: ScanFile,
        name: str,
        project: Path | None,
        picture: bytes | None = None,
        stamp: Stamp | None = None,
    ) -> None:
        """Keep a document; of what was kept before nothing goes until this is whole. Raises ProjectError."""
        try:
            place = self._keep_scan(document, scan)
            if picture:
                with atomic_path(self.folder / _PICTURE, private=True) as partial:
                    partial.write_bytes(picture)
            told = {
                "name": name,
                "project": str(project) if project is not None else None,
                "stamp": stamp,
                "time": time.time(),
                "scan": place.relative_to(self.folder).as_posix(),
                "size": place.stat().st_size,
                "texts": to_texts(with_scan(document, "", "")),
            }
            write_text(self.folder / _DOCUMENT, json.dumps(told), private=True)
        except (OSError, ProjectError) as problem:
            raise _unkept(self.folder, problem) from problem
        self._sweep(place.parent)

    def clear(self) -> None:
        """Keep no document any more: it is saved. The scan stays, a restored document may lie on it."""
        with suppress(OSError):
            (self.folder / _DOCUMENT).unlink(missing_ok=True)

    def leave(self) -> None:
        """Leave all that is kept to the next window that starts."""
        self._hold.release()

    def remove(self) -> None:
        """Let nothing be left: the window closes in order."""
        self.clear()
        self._hold.release()
        shutil.rmtree(self.folder, ignore_errors=True)

    def _keep_scan(self, document: Document, scan: ScanFile) -> Path:
        """Return where the bytes of the scan are kept, written once."""
        path = Path(document.design.scan.path)
        if not document.design.scan.member and path.is_relative_to(self.folder) and path.exists():
            return path
        if self._place is None or scan is not self._scan:
            free = next(n for n in range(1, 10**6) if not (self.folder / f"scan{n}").exists())
            place = self.folder / f"scan{free}" / safe_name(scan.name)
            private_folder(place.parent)
            with atomic_path(place, private=True) as partial:
                partial.write_bytes(scan.data)
            self._scan, self._place = scan, place
        return self._place

    def _sweep(self, kept: Path) -> None:
        for old in self.folder.glob("scan*"):
            if old != kept:
                shutil.rmtree(old, ignore_errors=True)


def find_unsaved() -> tuple[list[tuple[RecoveredDocument, Recovery]], list[Path]]:
    """Take hold of what windows left behind that did not close in order, the newest first.

    Folders with nothing to lose are removed. What cannot be read is put aside: where, is returned beside.
    """
    found, broken = [], []
    for folder in sorted(recovery_folder().glob("*/")):
        if folder.suffix == _ASIDE:
            continue
        try:
            recovery = Recovery(folder)
        except OSError:
            continue  # its window is at work, or it is not ours to take
        try:
            found.append((load_unsaved(folder), recovery))
        except FileNotFoundError:
            recovery.remove()
        except UserError:
            recovery.leave()
            with suppress(OSError):
                broken.append(folder.replace(folder.with_suffix(_ASIDE)))
    return sorted(found, key=lambda each: -each[0].time), broken


def load_unsaved(folder: Path) -> RecoveredDocument:
    """Read what a folder keeps. Raises FileNotFoundError if that is nothing, ProjectError if it is broken."""
    try:
        text = read_text(folder / _DOCUMENT, 5 * LARGEST_TEXT)  # two texts, spelled as one
    except FileNotFoundError:
        raise
    except (OSError, ValueError) as problem:
        raise _unreadable(folder) from problem
    try:
        values = parsed(text)
        texts = dict(values.pop("texts"))
        return _kept(folder, value_of(_Told, values, "document"), from_texts(texts))
    except (ValueError, KeyError, TypeError, AttributeError, OSError, UserError) as problem:
        raise _unreadable(folder) from problem


def _kept(folder: Path, told: _Told, document: Document) -> RecoveredDocument:
    scan, picture = folder / told.scan, folder / _PICTURE
    if scan.stat().st_size != told.size:
        raise ValueError("the scan is incomplete")
    return RecoveredDocument(
        with_scan(document, str(scan), ""),
        told.name,
        Path(told.project) if told.project else None,
        told.time,
        read_regular(picture, LARGEST_PICTURE) if picture.exists() else None,
        told.stamp,
    )


def _unkept(folder: Path, problem: Exception) -> ProjectError:
    # What could not be written has been told of a file that nobody has chosen: its cause is what counts.
    cause = problem.__cause__ or problem
    return ProjectError(
        Message(
            "Changes cannot be autosaved in {folder}: {reason}.",
            folder=str(folder),
            reason=reason_of(cause),
        ),
        Message("Free up disk space, or save often."),
    )


def _unreadable(folder: Path) -> ProjectError:
    return ProjectError(
        Message("The recovery data in {folder} is damaged.", folder=str(folder)), Message("Open a backup.")
    )
