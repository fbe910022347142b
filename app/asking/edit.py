"""One edit of the document, as the undo stack keeps it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtGui import QUndoCommand

from core.document import Document

if TYPE_CHECKING:
    from app.asking.editing import Editing

PAUSE = 1.0
"""Seconds between two edits of one thing after which they are two in the history; a wheel turns faster."""


class Edit(QUndoCommand):
    """One edit: the document before and after. The first redo after a drag keeps the run that the preview
    began.

    Edits of the same ``what``, such as one line's length, that follow one another quickly become one.
    """

    def __init__(
        self, session: Editing, before: Document, after: Document, text: str, shown: bool, what: str = ""
    ) -> None:
        super().__init__(text)
        self._session = session
        self.before = before
        self.after = after
        self._former: list[tuple[Document, str]] = []
        self._shown = shown
        self._what = what
        self._made = time.monotonic()

    def id(self) -> int:
        """Return a number that edits have in common that may become one."""
        return hash(self._what) & 0x3FFFFFFF if self._what else -1

    def mergeWith(self, other: QUndoCommand) -> bool:  # noqa: N802 - Qt's name
        """Take in the edit that follows, if it goes on with this one."""
        if not isinstance(other, Edit) or other._what != self._what or other._made - self._made > PAUSE:
            return False
        self._former.append((self.after, self.text()))
        self.after, self._made = other.after, other._made
        self.setText(other.text())
        # There and back again is no edit.
        self.setObsolete(self.after == self.before)
        return True

    def step_back(self) -> bool:
        """Be as before the last edit that was taken in; returns whether there is one to give up."""
        if not self._former:
            return False
        self.after, text = self._former.pop()
        self.setText(text)
        return True

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
