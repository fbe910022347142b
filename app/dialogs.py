"""The few dialogs of the window: files, and the question before changes are lost."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.words import tr
from core import __version__

SCANS = "*.ply *.obj *.stl"


def ask_open(parent: QWidget) -> str:
    """Return the file that the user wants to open, or an empty text."""
    kinds = f"{tr('Projects and scans')} (*.busk {SCANS});;{tr('Projects')} (*.busk);;{tr('Scans')} ({SCANS})"
    path, _ = QFileDialog.getOpenFileName(parent, tr("Open"), "", kinds)
    return path


def ask_save(parent: QWidget, title: str, name: str, kinds: str, ending: str) -> str:
    """Return where to save, with an ending, or an empty text."""
    path, _ = QFileDialog.getSaveFileName(parent, title, name, kinds)
    return path if not path or Path(path).suffix else f"{path}{ending}"


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


def about_busk(parent: QWidget) -> None:
    """Say what Busk is, and under which licence."""
    title = tr("Busk {version}").format(version=__version__)
    purpose = tr("See how a foundation garment reshapes a body.")
    terms = tr("Apache-2.0. Nothing leaves this computer.")
    QMessageBox.about(parent, tr("About Busk"), f"{title}\n\n{purpose}\n{terms}")
