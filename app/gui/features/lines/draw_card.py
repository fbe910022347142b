"""The card that goes with a line while it is drawn: what to do next, how well it lies, keep or leave."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label
from app.gui.widgets.basic import FloatingPanel, ToolButton, button, sentence
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

WIDTH = 232
"""Width of the sentences [px]."""


class DrawCard(FloatingPanel):
    """Says what to do; ``accepted``, ``back``, ``closed`` and ``moved`` at its buttons."""

    accepted = Signal()
    back = Signal()
    closed = Signal()
    moved = Signal()

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
        self.both = QCheckBox(tr("Mirror the line to the other side and link both"))
        self.snap = QCheckBox(tr("Snap to control points"))
        set_tip(self.snap, tr("Snap the line to the nearest control points instead of keeping its curve"))
        for choice in (self.both, self.snap):
            choice.setFont(font("body"))
            choice.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.move_ = button(tr("Move to reshaped region"))
        self.move_.hide()
        self.move_.clicked.connect(self.moved)
        self.keep, self.undo = button(tr("Keep line"), "primary"), button(tr("Undo step"), "quiet")
        for each in (self.keep, self.undo, self.move_):
            each.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # a click leaves the keys to the hand that draws
        self.keep.clicked.connect(self.accepted)
        self.undo.clicked.connect(self.back)
        column.addLayout(head)
        for part in (self._what, self.move_, self._keys, self.snap, self.both):
            column.addWidget(part)
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
