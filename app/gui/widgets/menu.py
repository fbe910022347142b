"""Menus with rounded corners, and with tooltips of plain text."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QAction, QHelpEvent, QResizeEvent
from PySide6.QtWidgets import QMenu, QWidget

from app.gui.widgets.tooltip import round_corners, show_tip

_RADIUS = 9.0  # as in style.qss


class Menu(QMenu):
    """A menu, or a submenu, in the style of the cards of the window."""

    def __init__(self, parent: QWidget | None = None, title: str = "") -> None:
        super().__init__(title, parent)
        self.setWindowFlags(
            self.windowFlags() | Qt.WindowType.FramelessWindowHint | Qt.WindowType.NoDropShadowWindowHint
        )
        self.setAttribute(Qt.WidgetAttribute.WA_TranslucentBackground)

    def add_submenu(self, title: str) -> Menu:
        """Return a new menu at the foot of this one."""
        result = Menu(self, title)
        self.addMenu(result)
        return result

    def event(self, event: QEvent) -> bool:
        """Show the tooltip of the entry under the pointer, where it has one of its own."""
        if not isinstance(event, QHelpEvent) or event.type() != QEvent.Type.ToolTip:
            return super().event(event)
        action = self.actionAt(event.pos())
        tip = (
            "" if action is None or action.toolTip() == QAction(action.text()).toolTip() else action.toolTip()
        )
        show_tip(event.globalPos(), tip, self)
        return True

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the corners round."""
        super().resizeEvent(event)
        round_corners(self, _RADIUS)


def pull_down(menu: QMenu, under: QWidget) -> None:
    """Open a menu under a button, which is lit no longer once the menu has gone."""

    def unlit() -> None:
        under.setAttribute(Qt.WidgetAttribute.WA_UnderMouse, False)
        under.update()

    menu.aboutToHide.connect(unlit, Qt.ConnectionType.SingleShotConnection)
    menu.popup(under.mapToGlobal(QPoint(0, under.height() + 2)))
