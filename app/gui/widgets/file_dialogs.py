"""Dialogs about files: open, save, replace, discard; each begins in the folder used last."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain, count
from pathlib import Path

from PySide6.QtCore import QSettings, QStandardPaths
from PySide6.QtWidgets import QFileDialog, QWidget

from app.gui.widgets.dialog import ask
from app.i18n.catalog import tr
from app.presenters.scan import PATTERNS

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
    """Record the folder that a file of this kind lies in."""
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


_ENDING = re.compile(r"\*(\.\w+)")


def ask_open(parent: QWidget) -> str:
    """Return the file that the user wants to open, or an empty text."""
    both, projects, scans = tr("Projects and scans"), tr("Projects"), tr("Scans")
    kinds = f"{both} (*.busk {PATTERNS});;{projects} (*.busk);;{scans} ({PATTERNS})"
    path, _ = QFileDialog.getOpenFileName(parent, tr("Open"), str(last_folder("opened")), kinds)
    return path


def ask_scan(parent: QWidget, title: str) -> str:
    """Return the scan that the user wants to compare with, or an empty text."""
    kinds = f"{tr('Scans')} ({PATTERNS})"
    path, _ = QFileDialog.getOpenFileName(parent, title, str(last_folder("opened")), kinds)
    return path


def ask_project(parent: QWidget, title: str) -> str:
    """Return the project that the user wants to use, or an empty text."""
    kinds = f"{tr('Projects')} (*.busk)"
    path, _ = QFileDialog.getOpenFileName(parent, title, str(last_folder("projects")), kinds)
    return path


def ask_scans(parent: QWidget, title: str) -> list[str]:
    """Return the scans, or lists of scans as CSV, that the user wants to compute; none if there are none."""
    kinds = f"{tr('Scans')} ({PATTERNS} *.csv)"
    paths, _ = QFileDialog.getOpenFileNames(parent, title, str(last_folder("opened")), kinds)
    if paths:
        remember_folder("opened", paths[0])
    return paths


def ask_folder(parent: QWidget, title: str, kind: str = "opened") -> str:
    """Return a folder that the user chooses, or an empty text; ``kind`` is that of ``last_folder``."""
    path = QFileDialog.getExistingDirectory(parent, title, str(last_folder(kind)))
    if path:
        remember_folder(kind, path)
    return path


TABLES = "CSV (*.csv *.tsv *.txt)"


def ask_file(parent: QWidget, title: str, kinds: str = TABLES) -> str:
    """Return the file of these kinds that the user wants to bring in, or an empty text."""
    path, _ = QFileDialog.getOpenFileName(parent, title, str(last_folder("written")), kinds)
    if path:
        remember_folder("written", path)
    return path


def ask_save(parent: QWidget, title: str, name: str, kinds: str, ending: str) -> str:
    """Return where to save, or an empty text; a ``name`` with its folder is offered as it is.

    A name without one of the endings in ``kinds`` gets that of the chosen kind, else ``ending``.
    """
    what = "projects" if ending == ".busk" else "written"
    offered = name if Path(name).is_absolute() else str(free_name(last_folder(what), name))
    path, kind = QFileDialog.getSaveFileName(parent, title, offered, kinds)
    if path and Path(path).suffix.lower() not in _ENDING.findall(kinds):
        whole = Path(path + next(iter(_ENDING.findall(kind)), ending))
        # The dialog has only asked about the name as it was typed.
        path = str(whole) if not whole.exists() or _may_replace(parent, whole.name) else ""
    if path:
        remember_folder(what, path)
    return path


def _may_replace(parent: QWidget, name: str) -> bool:
    question = tr("{name} already exists. Replace it?").format(name=name)
    return ask(parent, question, "", [("replace", tr("Replace"))]) == "replace"


def ask_about_changes(parent: QWidget | None, name: str) -> str:
    """Return what to do with unsaved changes: "save", "discard" or "stay"."""
    question, text = tr("Save the changes to {name}?").format(name=name), tr("Unsaved changes will be lost.")
    return ask(parent, question, text, [("save", tr("Save")), ("discard", tr("Don't save"))]) or "stay"


def ask_overwrite(parent: QWidget, name: str, protected: bool = False) -> str:
    """Return what to do with a project that was changed by others: "overwrite", "elsewhere" or "stay".

    ``protected``: it was not, but its file is write-protected.
    """
    question = tr("{name} was changed outside this window.").format(name=name)
    if protected:
        question = tr("{name} is write-protected.").format(name=name)
    text = tr("Saving overwrites the file. If possible, a copy is kept under File, Open backup.")
    answers = [("elsewhere", tr("Save as…")), ("overwrite", tr("Replace"))]
    return ask(parent, question, text, answers) or "stay"


def may_discard(parent: QWidget, name: str) -> bool:
    """Confirm that recovery data may be deleted."""
    question = tr("Discard the recovered changes to {name}?").format(name=name)
    text = tr("This cannot be undone.")
    return ask(parent, question, text, [("discard", tr("Discard"))]) == "discard"
