"""Recovery of unsaved documents, and previous versions."""

# ruff: noqa: N802 - Qt names its events and says what they are

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtGui import QImage, QPainter, QPainterPath, QPaintEvent
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QHBoxLayout, QVBoxLayout, QWidget

from app.gui.features.project.autosave import AutosaveController
from app.gui.features.project.controller import ProjectController
from app.gui.features.project.recent_files import day_of, picture_of
from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import EmptyState, OverlayCard, ToolButton, button, sentence
from app.gui.widgets.file_dialogs import may_discard
from app.gui.widgets.thumbnail_list import ThumbnailList, ThumbnailRow, ThumbnailRowPainter
from app.i18n.catalog import tr
from core.document.storage.backups import Backup, backups
from core.document.storage.project_file import open_project
from core.document.storage.recovery import RecoveredDocument, Recovery, find_unsaved
from core.errors import UserError

if TYPE_CHECKING:
    from pathlib import Path

    from app.gui.context import AppContext


class BackupsDialog(QDialog):
    """Lists backups, those saved last first."""

    def __init__(self, parent: QWidget | None, found: Sequence[Backup]) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Open backup"))
        self.resize(520, 560)
        self.rows = ThumbnailList(ThumbnailRowPainter(self))
        self.rows.setAccessibleName(tr("Previous versions"))
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
                tr(
                    "Each save keeps the previous version of the project. The latest versions "
                    "are listed here."
                )
            )
        )
        if found:
            column.addWidget(self.rows, 1)
            self.rows.setCurrentRow(0)
        else:
            self.rows.hide()
            hint = tr("Save a project twice: the first version is then listed here.")
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


_PICTURE = QSize(116, 110)


@dataclass(frozen=True, eq=False)
class RecoveryView:
    """What is offered: the document's name, when it was kept, its picture, and how many more there are."""

    name: str
    time: str
    picture: QImage | None = None
    more: int = 0


class RecoveryCard(OverlayCard):
    """Asks once, calmly; ``later`` leaves the offer to the next start."""

    restore = Signal()
    discard = Signal()
    later = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._picture = _Picture()
        self._heading, self._words = label("", "heading"), sentence()
        self._more = label("", "caption")
        # Two lines in any language: a label that wraps does not ask for the second one.
        self._words.setMinimumHeight(2 * self._words.fontMetrics().lineSpacing() + 6)
        close = ToolButton("x", tr("Decide at the next start"), size=14, room=26)
        close.clicked.connect(self.later)
        self.given_up.connect(self.later)
        self.take, self.drop = button(tr("Restore"), "primary"), button(tr("Discard"))
        self.take.clicked.connect(self.restore)
        self.drop.clicked.connect(self.discard)
        head, ways, column = QHBoxLayout(), QHBoxLayout(), QVBoxLayout()
        head.addWidget(self._heading, 1)
        head.addWidget(close, alignment=Qt.AlignmentFlag.AlignTop)
        for way in (self.take, self.drop):
            ways.addWidget(way)
        ways.addStretch(1)
        ways.addWidget(self._more)
        column.addLayout(head)
        column.addWidget(self._words, 1)
        column.addLayout(ways)
        self.row.setContentsMargins(26, 22, 24, 26)
        self.row.setSpacing(16)
        self.row.addWidget(self._picture, alignment=Qt.AlignmentFlag.AlignTop)
        self.row.addLayout(column, 1)
        self.setFixedWidth(540)
        self.hide()

    def offer(self, view: RecoveryView) -> None:
        """Show one recovered document."""
        self._heading.setText(tr("{name} was not saved").format(name=view.name))
        text = tr("Busk was not closed properly. Last autosave: {time}. Later changes are lost.")
        text = text.format(time=view.time)
        self._words.setText(text)
        self._more.setText(tr("{count} more").format(count=view.more) if view.more else "")
        self._picture.show_image(view.picture)
        self.setAccessibleName(f"{self._heading.text()}. {text}")
        self.adjustSize()
        self.show()
        self.raise_()
        self.take.setFocus(Qt.FocusReason.OtherFocusReason)


class _Picture(QWidget):
    """A picture with round corners; it takes no room where there is none."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedSize(_PICTURE)
        self._image: QImage | None = None

    def show_image(self, image: QImage | None) -> None:
        self._image = image
        self.setVisible(image is not None)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        if self._image is None:
            return
        painter = QPainter(self)
        painter.setRenderHints(QPainter.RenderHint.Antialiasing | QPainter.RenderHint.SmoothPixmapTransform)
        shape = QPainterPath()
        shape.addRoundedRect(self.rect(), 8, 8)
        painter.setClipPath(shape)
        painter.drawImage(self.rect(), self._image)


class RecoveryController(QObject):
    """Offer what was left behind, the newest first; what is neither restored nor discarded stays."""

    def __init__(self, context: AppContext, project: ProjectController, autosave: AutosaveController) -> None:
        super().__init__(context.session)
        self._context, self._project, self._autosave = context, project, autosave
        self._offers: list[tuple[RecoveredDocument, Recovery]] = []
        self._broken: list[Path] = []
        self._at_start = True
        self.card = RecoveryCard(context.window)
        self.card.restore.connect(self.restore)
        self.card.discard.connect(self.discard)
        self.card.later.connect(self.close)
        context.window.installEventFilter(self)
        text = tr("Open a previous version of a project")
        context.actions.add("file", tr("Open backup…"), tip=text, do=self.open_backup)

    def look(self) -> None:
        """Find recovery data, at the start."""
        # Nobody has chosen what the window opens with.
        self._at_start = self._context.navigation.page is None
        self._offers, self._broken = find_unsaved()
        self._tell_broken()
        self._offer()

    def restore(self) -> None:
        """Open the document that is offered, unsaved as it was."""
        if self._project.may_leave():
            self._context.session.restore(self._offers[0][0])

    def show_opened(self) -> None:
        """Continue in the folder of a restored document.

        Who opens something else instead is not to have the offer in the way any longer.
        """
        # What is opened at the start takes the notices of before away.
        self._tell_broken()
        self._broken = []
        if self._offers and self._context.session.document is self._offers[0][0].document:
            self._autosave.adopt(self._offers.pop(0)[1])
            self._offer()
        elif self._offers and not self._at_start:
            self.close()
            text = tr("Unsaved changes are offered for recovery at the next start.")
            self._context.notifications.info(text)
        self._at_start = False

    def discard(self) -> None:
        """Remove what is offered, if that is meant."""
        if may_discard(self._context.window, self._offers[0][0].name):
            self._offers.pop(0)[1].remove()
            self._offer()

    def open_backup(self) -> None:
        """Prompt for a previous version and open it, unsaved, in place of the project."""
        backup = ask_backup(self._context.window, self._context.session.path)
        if backup is None or not self._project.may_leave():
            return
        try:
            document = open_project(backup.path)
        except UserError as error:
            self._context.notifications.error(error)
            return
        self._context.session.open_document(document, backup.project, unsaved=True)

    def close(self) -> None:
        """Leave what was not decided to the next start."""
        while self._offers:
            self._offers.pop()[1].leave()
        self.card.hide()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keep the card in its place at the head of the context."""
        if watched is self._context.window and event.type() == QEvent.Type.Resize:
            self._place()
        return False

    def set_aside(self, aside: bool) -> None:
        """Hide the card while handles that it may cover are dragged to set targets; then show it again."""
        self.card.setVisible(bool(self._offers) and not aside)
        self.card.raise_()

    def _tell_broken(self) -> None:
        for folder in self._broken:
            sentence = tr("The recovery data of a previous session is damaged.")
            hint = tr("The data was moved to {folder}.").format(folder=folder)
            self._context.notifications.warn(sentence, hint)

    def _offer(self) -> None:
        if not self._offers:
            self.card.hide()
            return
        kept, _ = self._offers[0]
        picture = QImage.fromData(kept.picture) if kept.picture else QImage()
        day = day_of(kept.time, time.time())
        shown = None if picture.isNull() else picture
        self.card.offer(RecoveryView(kept.name, day, shown, len(self._offers) - 1))
        self._place()

    def _place(self) -> None:
        self.card.move((self._context.window.width() - self.card.width()) // 2, 48)
