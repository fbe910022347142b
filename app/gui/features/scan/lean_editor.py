"""The lean of the body in its file: two angles that can be typed, and a button that corrects it."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import button
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import tr
from app.presenters.scan import LeanView

MOST = 45.0
"""The largest lean that can be typed [degrees]."""


class AngleField(ValueEdit):
    """An angle within 45 degrees."""

    def __init__(self, name: str) -> None:
        super().__init__("°", name, signed=True, widest="+00.0")

    def _read(self, text: str) -> float:
        value = super()._read(text)
        if abs(value) > MOST:
            raise ValueError(tr("Enter an angle from −45 to 45°."))
        return value


class LeanEditor(QWidget):
    """The two angles; ``leaned`` carries both, ``up_chosen`` the direction that sets the body upright."""

    leaned = Signal(float, float)
    up_chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._view = LeanView(0.0, 0.0)
        self.forward = AngleField(tr("Lean of the body in the file, forward; negative: backward"))
        self.left = AngleField(tr("Lean of the body in the file, to its left; negative: to its right"))
        self.forward.entered.connect(lambda value: self.leaned.emit(value, self._view.left))
        self.left.entered.connect(lambda value: self.leaned.emit(self._view.forward, value))
        self.upright = button(tr("Set upright"))
        set_tip(self.upright, tr("Rotate the body until its back has the slope of an upright body"))
        self.upright.clicked.connect(lambda: self.up_chosen.emit(self._view.upright))
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(6)
        row = QHBoxLayout()
        row.setSpacing(6)
        for words, field in ((tr("Forward"), self.forward), (tr("To the left"), self.left)):
            row.addWidget(label(words, "secondary"))
            row.addWidget(field)
            row.addSpacing(8)
        row.addStretch(1)
        column.addLayout(row)
        below = QHBoxLayout()
        below.addWidget(self.upright)
        below.addStretch(1)
        column.addLayout(below)

    def show_lean(self, view: LeanView) -> None:
        """Show the angles of a body, and the button if it leans."""
        self._view = view
        self.forward.show_value(view.forward)
        self.left.show_value(view.left)
        self.upright.setVisible(bool(view.upright))
