"""The few dialogs of the window: files, and the question before changes are lost."""

from __future__ import annotations

import re
from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QWidget

from app.gui.widgets.last_folders import free_name, last_folder, remember_folder
from app.gui.widgets.message_box import ask
from app.i18n.catalog import tr
from app.presenters.scan import PATTERNS

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


def ask_table(parent: QWidget, title: str) -> str:
    """Return the table that the user wants to bring in, or an empty text."""
    kinds = "CSV (*.csv *.tsv *.txt)"
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
    question = tr("{name} is there already. Replace it?").format(name=name)
    return ask(parent, question, "", [("replace", tr("Replace"))]) == "replace"


def ask_about_changes(parent: QWidget | None, name: str) -> str:
    """Return what to do with unsaved changes: "save", "discard" or "stay"."""
    question, said = tr("Save the changes to {name}?").format(name=name), tr("Otherwise they are lost.")
    return ask(parent, question, said, [("save", tr("Save")), ("discard", tr("Don't save"))]) or "stay"
