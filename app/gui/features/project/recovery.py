"""What is there to be had back: documents of windows that did not close in order, and former versions."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject
from PySide6.QtGui import QImage

from app.gui.features.project.autosave import AutosaveController
from app.gui.features.project.backups_dialog import ask_backup
from app.gui.features.project.controller import ProjectController
from app.gui.features.project.recent_files import day_of
from app.gui.features.project.recovery_card import RecoveryCard, RecoveryView
from app.gui.widgets.file_dialogs import may_discard
from app.i18n.catalog import tr
from core.document.storage.project_file import open_project
from core.document.storage.recovery import RecoveredDocument, Recovery, find_unsaved
from core.errors import UserError

if TYPE_CHECKING:
    from pathlib import Path

    from app.gui.context import AppContext


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
        said = tr("Have a former version of a project back")
        context.actions.add("file", tr("Open a backup…"), tip=said, do=self.open_backup)

    def look(self) -> None:
        """Look for what was left behind, at the start."""
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
        """Go on in the folder of a document that was restored: it is safe there all the time.

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
            said = tr("What was not saved is offered again at the next start.")
            self._context.notifications.info(said)
        self._at_start = False

    def discard(self) -> None:
        """Remove what is offered, if that is meant."""
        if may_discard(self._context.window, self._offers[0][0].name):
            self._offers.pop(0)[1].remove()
            self._offer()

    def open_backup(self) -> None:
        """Ask for a former version and open it, unsaved, in the place of the project."""
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

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
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
            sentence = tr("What was kept of an earlier session cannot be read.")
            hint = tr("It was put aside in {folder}.").format(folder=folder)
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
