"""The card on the view in which the result is asked for: wishes, the answer, what would change."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.dress.parts import FloatingPanel, ToolButton
from app.dress.theme import label
from app.wording.words import tr


class AskCard(FloatingPanel):
    """``left`` at its cross."""

    left = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        column, head = QVBoxLayout(), QHBoxLayout()
        head.addWidget(label(tr("Ask for the result"), "heading"), 1)
        close = ToolButton("x", tr("Leave without a change (Esc)"), size=14, room=26)
        close.clicked.connect(self.left)
        head.addWidget(close)
        column.addLayout(head)
        self.row.setContentsMargins(28, 20, 24, 28)
        self.row.addLayout(column)
        self.hide()
