"""The few dialogs of the window: files, and the question before changes are lost."""

from __future__ import annotations

import re
from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.wording.scan_formats import PATTERNS
from app.wording.words import tr

_ENDING = re.compile(r"\*(\.\w+)")


def ask_open(parent: QWidget) -> str:
    """Return the file that the user wants to open, or an empty text."""
    both, projects, scans = tr("Projects and scans"), tr("Projects"), tr("Scans")
    kinds = f"{both} (*.busk {PATTERNS});;{projects} (*.busk);;{scans} ({PATTERNS})"
    path, _ = QFileDialog.getOpenFileName(parent, tr("Open"), "", kinds)
    return path


def ask_save(parent: QWidget, title: str, name: str, kinds: str, ending: str) -> str:
    """Return where to save, or an empty text.

    A name without one of the endings in ``kinds`` gets that of the chosen kind, else ``ending``.
    """
    path, kind = QFileDialog.getSaveFileName(parent, title, name, kinds)
    if not path or Path(path).suffix.lower() in _ENDING.findall(kinds):
        return path
    whole = Path(path + next(iter(_ENDING.findall(kind)), ending))
    # The dialog has only asked about the name as it was typed.
    return str(whole) if not whole.exists() or _may_replace(parent, title, whole.name) else ""


def _may_replace(parent: QWidget, title: str, name: str) -> bool:
    question = tr("{name} is there already. Replace it?").format(name=name)
    return QMessageBox.question(parent, title, question) == QMessageBox.StandardButton.Yes


def ask_about_changes(parent: QWidget, name: str) -> str:
    """Return what to do with unsaved changes: "save", "discard" or "stay"."""
    box = QMessageBox(parent)
    box.setIcon(QMessageBox.Icon.Question)
    box.setWindowTitle("Busk")
    box.setText(tr("Save the changes to {name}?").format(name=name))
    box.setInformativeText(tr("Otherwise they are lost."))
    buttons = QMessageBox.StandardButton
    box.setStandardButtons(buttons.Save | buttons.Discard | buttons.Cancel)
    box.setDefaultButton(buttons.Save)
    answer = box.exec()
    return {buttons.Save.value: "save", buttons.Discard.value: "discard"}.get(answer, "stay")
