"""Place of notices: over the 3D view, or above a page in place of it."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QStackedWidget, QVBoxLayout, QWidget

from app.gui.widgets.overlay_layout import APART, GAP

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow

_LEAST = 440
"""Width that notices need beside the tools at the upper edge of the view [px]."""


class NotificationArea(QObject):
    """Keeps the notices on what is shown; on the view they never change its size."""

    def __init__(self, window: MainWindow, pages: QStackedWidget, work: QWidget, head: QVBoxLayout) -> None:
        super().__init__(window)
        self._window, self._pages, self._work, self._head = window, pages, work, head
        self._on_view = False
        window.view.installEventFilter(self)
        window.view.compare.installEventFilter(self)
        pages.currentChanged.connect(self.carry)

    def carry(self) -> None:
        """Place the notices on the view, or above the page that is shown in the place of the work."""
        view, notices = self._window.view, self._window.notices
        on_view = self._pages.currentWidget() is self._work
        if on_view == self._on_view:
            return
        self._on_view, shown = on_view, not notices.isHidden()
        if on_view:
            self._head.removeWidget(notices)
            self._fit()
            view.place(notices, "top")
        else:
            view.floating.remove(notices)
            notices.set_room(None, self._window.height())
            self._head.insertWidget(0, notices)
        notices.setVisible(shown)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Handle the size of the view and of the tools beside the notices."""
        if event.type() in (QEvent.Type.Resize, QEvent.Type.Show, QEvent.Type.Hide):
            self._fit()
        return False

    def _fit(self) -> None:
        if not self._on_view:
            return
        view = self._window.view
        whole = view.width() - 2 * GAP
        beside = whole - view.compare.sizeHint().width() if not view.compare.isHidden() else whole
        self._window.notices.set_room(beside - APART if beside >= _LEAST else whole, view.height())
