"""What is asked before something could be lost for good."""

from __future__ import annotations

from PySide6.QtWidgets import QMessageBox, QWidget

from app.wording.words import tr


def ask_overwrite(parent: QWidget, name: str) -> str:
    """Return what to do with a project that was changed by others: "overwrite", "elsewhere" or "stay"."""
    box = QMessageBox(parent)
    box.setIcon(QMessageBox.Icon.Warning)
    box.setWindowTitle("Busk")
    box.setText(tr("{name} was changed outside this window.").format(name=name))
    box.setInformativeText(
        tr("Saving replaces that version. Busk tries to keep it under File, Open a backup.")
    )
    save_as = box.addButton(tr("Save as…"), QMessageBox.ButtonRole.AcceptRole)
    replace = box.addButton(tr("Replace"), QMessageBox.ButtonRole.DestructiveRole)
    box.addButton(QMessageBox.StandardButton.Cancel)
    box.setDefaultButton(save_as)
    box.exec()
    pressed = box.clickedButton()
    return "elsewhere" if pressed is save_as else "overwrite" if pressed is replace else "stay"


def may_discard(parent: QWidget, name: str) -> bool:
    """Ask whether what was kept of a document after a crash may go for good."""
    question = tr("Discard the changes that were kept of {name}? They cannot be had back.").format(name=name)
    return QMessageBox.question(parent, "Busk", question) == QMessageBox.StandardButton.Yes
