"""One edit of the document, as the undo stack keeps it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtGui import QUndoCommand

from core.document import Document

if TYPE_CHECKING:
    from app.asking.editing import Editing


class Edit(QUndoCommand):
    """One edit: the document before and after. The first redo after a drag keeps the run that the preview
    began.
    """

    def __init__(self, session: Editing, before: Document, after: Document, text: str, shown: bool) -> None:
        super().__init__(text)
        self._session = session
        self.before = before
        self.after = after
        self._shown = shown

    def redo(self) -> None:
        """Make the edit."""
        if self._shown:
            self._shown = False
            self._session.settle_preview(self.after)
        else:
            self._session.take(self.after)

    def undo(self) -> None:
        """Take it back."""
        self._session.take(self.before)
