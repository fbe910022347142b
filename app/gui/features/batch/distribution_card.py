"""Distribution of a column of the results, which is chosen from a menu by groups."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QFrame, QVBoxLayout

from app.gui.features.batch.setup import PullField
from app.gui.plots.histogram import Histogram
from app.gui.theme.stylesheet import label, set_tag
from app.gui.widgets.basic import sentence
from app.gui.widgets.menu import Menu
from app.i18n.catalog import tr
from app.presenters.batch_distribution import USUAL, Distribution, PlottedColumn

WIDTH = 300
"""Width of the card [px]."""


class DistributionCard(QFrame):
    """Shows the distribution of ``column``; ``chosen`` when it is another one."""

    chosen = Signal()

    def __init__(self) -> None:
        super().__init__()
        set_tag(self, "kind", "card")
        self.setFixedWidth(WIDTH)
        self.column: PlottedColumn | None = None
        self.field, self.plot, self.summary = PullField(tr("Column")), Histogram(), sentence("", "caption")
        column = QVBoxLayout(self)
        column.setContentsMargins(14, 12, 14, 12)
        column.setSpacing(8)
        column.addWidget(label(tr("Distribution"), "name"))
        column.addWidget(self.field)
        column.addWidget(self.plot, 1)
        column.addWidget(self.summary)
        self.show_distribution(None)

    def set_columns(self, columns: Sequence[PlottedColumn]) -> None:
        """Offer columns; the chosen one stays, if it is among them."""
        former = self.column.name if self.column is not None else USUAL
        by_name = {each.name: each for each in columns}
        self.column = by_name.get(former) or by_name.get(USUAL) or next(iter(columns), None)
        menu = self.field.menu_
        menu.clear()
        menus: dict[str, Menu] = {}
        group = QActionGroup(menu)
        for each in columns:
            inside = menus.get(each.group) or menus.setdefault(each.group, menu.add_submenu(each.group))
            action = group.addAction(each.title)
            action.setCheckable(True)
            action.setChecked(each is self.column)
            action.triggered.connect(lambda _=False, each=each: self._choose(each))
            inside.addAction(action)
        self.field.setEnabled(bool(columns))
        self._show_column()

    def show_distribution(self, shown: Distribution | None) -> None:
        """Show the distribution of the chosen column, or that there are no values."""
        self.plot.show_distribution(shown, tr("No values yet"))
        self.summary.setText("\n".join(shown.summary) if shown else "")

    def _choose(self, column: PlottedColumn) -> None:
        self.column = column
        self._show_column()
        self.chosen.emit()

    def _show_column(self) -> None:
        column = self.column
        text = column.heading if column is not None else ""
        self.field.show_text(text, f"{column.group}: {text}" if column is not None else "")
