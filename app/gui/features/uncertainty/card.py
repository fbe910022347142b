"""Uncertainty card: meaning of ±, sources and omissions."""

from __future__ import annotations

from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label, set_tag
from app.gui.widgets.basic import hairline, sentence
from app.gui.widgets.folded_list import folded_list
from app.i18n.catalog import tr
from app.presenters.uncertainty import UncertaintyView


class UncertaintyCard(QWidget):
    """What ± means, what another choice of the model makes, and two folds."""

    def __init__(self, sources: tuple[str, ...], left_out: tuple[str, ...]) -> None:
        super().__init__()
        self.meaning, self.contact = sentence("", "caption"), sentence("", "caption")
        column = QVBoxLayout(self)
        column.setContentsMargins(4, 4, 4, 4)
        column.setSpacing(4)
        column.addWidget(hairline())
        column.addWidget(label(tr("Uncertainties"), "heading"))
        column.addWidget(self.meaning)
        column.addWidget(self.contact)
        self.folds = [
            folded_list(column, tr("Sources of uncertainty"), sources),
            folded_list(column, tr("Not included"), left_out),
        ]
        self.show_view(UncertaintyView(""))

    def show_view(self, view: UncertaintyView) -> None:
        """Show what is known of the ±."""
        for words, text in ((self.meaning, view.meaning), (self.contact, view.contact)):
            words.setText(text)
            words.setVisible(bool(text))
            set_tag(words, "tone", "faint" if view.faint else "")
