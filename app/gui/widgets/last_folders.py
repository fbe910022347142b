"""Where files were read and written last, so that a dialog begins there."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, count
from pathlib import Path

from PySide6.QtCore import QSettings, QStandardPaths

_INSTEAD = {"opened": ("projects",), "projects": (), "written": ("projects",)}
"""Kinds of files by what was done with them, each with those whose folder does until it has its own."""


def last_folder(kind: str) -> Path:
    """Return the folder that files of this kind were in last, at first the user's documents.

    ``kind`` is "opened" (scans, projects), "projects" (saved) or "written" (bodies, pictures, tables).
    """
    documents = QStandardPaths.writableLocation(QStandardPaths.StandardLocation.DocumentsLocation)
    stored = (str(QSettings().value(f"folder/{each}", "")) for each in (kind, *_INSTEAD[kind]))
    folders = (Path(each) for each in chain(stored, [documents]) if each)
    return next((folder for folder in folders if _is_there(folder)), Path.home())


def remember_folder(kind: str, path: str) -> None:
    """Remember the folder that a file of this kind lies in."""
    QSettings().setValue(f"folder/{kind}", str(Path(path).absolute().parent))


def free_name(folder: Path, name: str) -> Path:
    """Return a path in ``folder`` at which nothing is yet: ``name``, else with the next number behind it."""
    return next(path for path in _numbered(folder / name) if not path.exists())


def _numbered(path: Path) -> Iterator[Path]:
    yield path
    for number in count(2):
        yield path.with_name(f"{path.stem} {number}{path.suffix}")


def _is_there(folder: Path) -> bool:
    try:
        return folder.is_dir()
    except OSError:
        return False
