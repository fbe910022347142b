"""The batch run in the status bar: how far it is; a click shows its window."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QWidget

from app.gui.status_bar import ProgressBar
from app.gui.theme.stylesheet import font
from app.gui.widgets.basic import button
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr


class BatchIndicator(QWidget):
    """Hidden while no run goes on; ``press`` is its button."""

    def __init__(self) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(6)
        self.press, self._bar = button("", "pick"), ProgressBar()
        self.press.setFont(font("caption"))
        set_tip(self.press, tr("Show the batch run"))
        self._bar.setFixedWidth(60)
        row.addWidget(self.press)
        row.addWidget(self._bar)
        self.hide()

    def show_run(self, text: str, fraction: float | None) -> None:
        """Show how far the run is; an empty text ends it."""
        self.press.setText(text)
        self._bar.set_fraction(fraction)
        self.setVisible(bool(text))
