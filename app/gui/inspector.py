"""The inspector at the right of the window: one panel at a time, some of them side by side as tabs."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QHBoxLayout, QStackedWidget, QVBoxLayout, QWidget

from app.gui.widgets.basic import Segment
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr


class Inspector(QWidget):
    """Holds the panels by name; ``tabs`` are offered at the head while one of them is shown."""

    LEAST, MOST = 330, 480

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumWidth(self.LEAST)
        self.setMaximumWidth(self.MOST)
        self._panels: dict[str, QWidget] = {}
        self._titled: set[str] = set()
        self.tabs = Segment((), wide=True)
        set_tip(self.tabs, tr("Lengths, measurements, elastics and cut list, variants, history"))
        self._head = QWidget()
        row = QHBoxLayout(self._head)
        row.setContentsMargins(8, 10, 8, 0)
        row.addWidget(self.tabs)
        self._stack = QStackedWidget()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self._head)
        column.addWidget(self._stack, 1)

    def add(self, name: str, panel: QWidget, tab: str = "") -> None:
        """Take a panel in; one with the title of a ``tab`` is offered beside the others that have one."""
        self._panels[name] = panel
        self._stack.addWidget(panel)
        if tab:
            self._titled.add(name)
            self.tabs.add(name, tab)
        if len(self._panels) == 1:
            self.open(name)

    def open(self, name: str) -> None:
        """Show the panel of this name; the keyboard goes over to it, and not to a button of it."""
        has, former = QApplication.focusWidget(), self._stack.currentWidget()
        goes_over = has is not None and former is not None and former.isAncestorOf(has)
        self._stack.setCurrentWidget(self._panels[name])
        self._head.setVisible(name in self._titled)
        self.tabs.set_choice(name)
        if goes_over:
            self._panels[name].setFocus(Qt.FocusReason.OtherFocusReason)

    def panel(self) -> QWidget | None:
        """Return the panel that is shown."""
        return self._stack.currentWidget()
