"""What all newtons rest on: the stiffness of skin and tissue, an estimate that can be set."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import hairline, sentence
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import number, tr
from core.document.elastic import TISSUE_LIMITS, TISSUE_STIFFNESS


class TissueCard(QWidget):
    """Stiffness of tissue [N/m] with what is said of it and of the figures; ``entered`` carries another."""

    entered = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self.field = _TissueField()
        self.field.entered.connect(self.entered)
        self.notes = sentence("", "caption")
        self.notes.setTextFormat(Qt.TextFormat.RichText)
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 4, 8, 4)
        column.setSpacing(4)
        row = QHBoxLayout()
        words = label(tr("Stiffness of skin and tissue"), "secondary")
        set_tip(words, self.field.toolTip())
        row.addWidget(words, 1)
        row.addWidget(self.field)
        column.addWidget(hairline())
        column.addLayout(row)
        column.addWidget(self.notes)

    def show_tissue(self, stiffness: float, notes: Sequence[str]) -> None:
        """Show the stiffness, and what holds for all figures."""
        self.field.show_value(stiffness)
        self.notes.setText("".join(f'<p style="margin:0 0 4px 0">{escape(note)}</p>' for note in notes))


class _TissueField(ValueEdit):
    """A stiffness within what tissue may have."""

    def __init__(self) -> None:
        super().__init__("N/m", tr("Stiffness of skin and tissue"), digits=0, widest="2000")
        tip = tr(
            "Force per metre of width and strain, {low} to {high}; at first {usual}, from skin alone."
            " It was not measured on this body: all newtons go with it, and how far elastics pull it in."
        )
        low, high = TISSUE_LIMITS
        set_tip(self, tip.format(low=f"{low:g}", high=f"{high:g}", usual=f"{TISSUE_STIFFNESS:g}"))

    def _read(self, text: str) -> float:
        value, (low, high) = super()._read(text.replace("N/m", "")), TISSUE_LIMITS
        if not low <= value <= high:
            words = tr("Choose {low} to {high} N/m: an estimate, skins alone have 160 to 1150.")
            raise ValueError(words.format(low=number(low, 0), high=f"{high:g}"))
        return value
