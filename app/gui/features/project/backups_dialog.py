"""The dialog in which a former version of a project is chosen."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path

from PySide6.QtWidgets import QDialog, QDialogButtonBox, QVBoxLayout, QWidget

from app.gui.features.project.recent_files import day_of, picture_of
from app.gui.widgets.basic import EmptyState, sentence
from app.gui.widgets.thumbnail_list import ThumbnailList, ThumbnailRow, ThumbnailRowPainter
from app.i18n.catalog import tr
from core.document.storage.backups import Backup, backups


class BackupsDialog(QDialog):
    """Lists backups, those saved last first."""

    def __init__(self, parent: QWidget | None, found: Sequence[Backup]) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Open a backup"))
        self.resize(520, 560)
        self.rows = ThumbnailList(ThumbnailRowPainter(self))
        self.rows.setAccessibleName(tr("Former versions"))
        self.rows.show_rows([_row_of(backup) for backup in found])
        self.rows.itemActivated.connect(self.accept)
        self.rows.itemDoubleClicked.connect(self.accept)
        buttons = QDialogButtonBox.StandardButton
        box = QDialogButtonBox(buttons.Open | buttons.Cancel)
        box.button(buttons.Open).setText(tr("Open"))
        box.button(buttons.Open).setEnabled(bool(found))
        box.button(buttons.Cancel).setText(tr("Cancel"))
        box.accepted.connect(self.accept)
        box.rejected.connect(self.reject)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(10)
        column.addWidget(
            sentence(
                tr("Each time a project is saved, the version before it is kept. The last ones are here.")
            )
        )
        if found:
            column.addWidget(self.rows, 1)
            self.rows.setCurrentRow(0)
        else:
            self.rows.hide()
            hint = tr("Save a project a second time: its first version will be here.")
            column.addWidget(EmptyState("clock-counter-clockwise", tr("No backups yet"), hint))
            column.addStretch(1)
        column.addWidget(box)


def ask_backup(parent: QWidget, project: Path | None) -> Backup | None:
    """Return the former version that the user wants back, those of the open ``project`` offered first."""
    found = sorted(backups(), key=lambda backup: backup.project != project)
    dialog = BackupsDialog(parent, found)
    chosen = dialog.exec() == QDialog.DialogCode.Accepted and dialog.rows.currentRow() >= 0
    dialog.deleteLater()
    return found[dialog.rows.currentRow()] if chosen else None


def _row_of(backup: Backup) -> ThumbnailRow:
    day = day_of(backup.time, time.time())
    return ThumbnailRow(backup.project.stem, day, (str(backup.project.parent),), picture_of(backup.path))
