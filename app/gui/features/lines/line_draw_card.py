"""Card of drawing a line: its choices beside what to do next."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QWidget

from app.gui.theme.stylesheet import font
from app.gui.viewport.draw_card import DrawCard
from app.gui.widgets.basic import button
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr


class LineDrawCard(DrawCard):
    """Lets a line snap to control points, be mirrored, and ``moved`` to where the body is reshaped."""

    moved = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.move_ = button(tr("Move to reshaped region"))
        self.move_.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.move_.hide()
        self.move_.clicked.connect(self.moved)
        self.snap = QCheckBox(tr("Snap to control points"))
        set_tip(self.snap, tr("Snap the line to the nearest control points instead of keeping its curve"))
        self.both = QCheckBox(tr("Mirror the line to the other side and link both"))
        self.choices.addWidget(self.move_)
        for choice in (self.snap, self.both):
            choice.setFont(font("body"))
            choice.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            self.choices.addWidget(choice)
