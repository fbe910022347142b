"""Card of a drawing tool: what to do next, keep, undo and cancel."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import FloatingPanel, ToolButton, button, sentence
from app.i18n.catalog import tr

WIDTH = 232
"""Width of the sentences [px]."""


class DrawCard(FloatingPanel):
    """Shows what to do; ``accepted``, ``back`` and ``closed`` at its buttons; ``choices`` has room."""

    accepted = Signal()
    back = Signal()
    closed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        column = QVBoxLayout()
        column.setSpacing(4)
        head = QHBoxLayout()
        self._title = label("", "heading")
        head.addWidget(self._title, 1)
        close = ToolButton("x", tr("Cancel without changes (Esc)"), size=14, room=26)
        close.clicked.connect(self.closed)
        head.addWidget(close)
        self._what, self._keys = sentence(""), sentence("", "caption")
        self._words = self._what, self._keys
        for words in self._words:
            words.setFixedWidth(WIDTH)
        self.choices = QVBoxLayout()
        self.choices.setSpacing(4)
        self.keep, self.undo = button(tr("Done"), "primary"), button(tr("Undo step"), "quiet")
        for each in (self.keep, self.undo):
            each.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # a click leaves the keys to the tool that draws
        self.keep.clicked.connect(self.accepted)
        self.undo.clicked.connect(self.back)
        column.addLayout(head)
        for part in self._words:
            column.addWidget(part)
        column.addLayout(self.choices)
        column.addSpacing(4)
        column.addLayout(self._foot())
        self.row.setContentsMargins(28, 20, 24, 28)
        self.row.addLayout(column)
        self.hide()

    def _foot(self) -> QHBoxLayout:
        foot = QHBoxLayout()
        foot.setSpacing(8)
        foot.addStretch(1)
        foot.addWidget(self.undo)
        foot.addWidget(self.keep)
        return foot

    def say(self, title: str, what: str, keys: str) -> None:
        """Show a title, what to do or how the line lies, and the keys that do it."""
        self._title.setText(title)
        self._what.setText(what)
        self._keys.setText(keys)
        for words in self._words:
            words.setFixedHeight(
                words.heightForWidth(WIDTH)
            )  # a panel is sized without regard to wrapped text
        self.adjustSize()
