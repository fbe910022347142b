"""A landmark that is chosen from a menu."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Signal
from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QSizePolicy

from app.gui.widgets.menu import Menu, pull_down
from app.gui.widgets.option_field import OptionCombo
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr


class LandmarkCombo(OptionCombo):
    """Shows a landmark and opens the menu of all; ``chosen`` names another one.

    With ``none`` in words none of them can be chosen too: an empty name.
    """

    chosen = Signal(str)

    def __init__(self, title: str, none: str = "") -> None:
        super().__init__()
        self._none = none
        self._titles: Mapping[str, str] = {}
        self._menu = Menu(self)
        self.setAccessibleName(title)
        set_tip(self, tr("Choose a landmark, or click it on the body"))
        self.setMinimumHeight(28)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.clicked.connect(lambda: pull_down(self._menu, self))

    def set_marks(self, titles: Mapping[str, str]) -> None:
        """Offer these landmarks, by name with their titles."""
        self._titles = titles
        self._menu.clear()
        group = QActionGroup(self._menu)
        offered = {"": self._none, **titles} if self._none else titles
        for name, title in offered.items():
            action = group.addAction(title)
            action.setCheckable(True)
            action.setData(name)
            action.triggered.connect(lambda _=False, name=name: self.chosen.emit(name))
            self._menu.addAction(action)

    def show_mark(self, name: str) -> None:
        """Show a landmark, or that there is none yet."""
        title = self._titles.get(name, self._none or tr("not chosen yet"))
        self.setText(title)
        self.setAccessibleDescription(title)
        for action in self._menu.actions():
            action.setChecked(action.data() == name)
