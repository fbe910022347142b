"""Shared services of all controllers: the session, and common parts of the program."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

if TYPE_CHECKING:
    from app.gui.actions import Actions
    from app.gui.session.jobs import Jobs
    from app.gui.session.notifications import Notifications
    from app.gui.session.session import Session
    from app.gui.viewport.view_area import ViewArea

STEPS = ("scan", "landmarks", "lines", "result", "pattern")
"""The steps from scan to pattern pieces; those from lines on show the reshaped body."""

RESHAPED = ("lines", "result", "pattern")
"""The steps that show the reshaped body; the others show the original one."""


class Navigation(QObject):
    """Hold which step, inspector panel and page are shown, and announce every change.

    ``page`` takes the place of the work (view, plots and inspector); it is None while the work is shown.
    """

    step_shown = Signal(str)
    panel_shown = Signal(str)
    page_shown = Signal(object)
    panel_focused = Signal()
    step_marked = Signal(str, str, int)
    tool_started = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.step, self.panel = "", ""
        self.page: QWidget | None = None

    def show_step(self, step: str) -> None:
        """Show a step with its panel, in the place of any page."""
        self.show_page(None)
        self.step = step
        self.step_shown.emit(step)
        self.show_panel(step)

    def show_panel(self, name: str) -> None:
        """Show a panel of the inspector by its name."""
        self.panel = name
        self.panel_shown.emit(name)

    def show_page(self, page: QWidget | None) -> None:
        """Show a page in the place of the work, or with None the work."""
        if page is not self.page:
            self.page = page
            self.page_shown.emit(page)

    def close_page(self, page: QWidget) -> None:
        """Show the work again if ``page`` takes its place, and focus the panel."""
        if page is self.page:
            self.show_page(None)
            self.focus_panel()

    def focus_panel(self) -> None:
        """Move the keyboard focus to the panel that is shown."""
        self.panel_focused.emit()

    def start_tool(self) -> None:
        """Close every tool that takes the pointer in the view, before another one starts."""
        self.tool_started.emit()

    def mark_step(self, step: str, state: str, count: int = 0) -> None:
        """Set the state of a step, one of ``app.gui.step_navigation.STATES``, and its count of issues."""
        self.step_marked.emit(step, state, count)


class Selection(QObject):
    """Hold the selected line and landmark, and announce each selection, also of the same again."""

    line_selected = Signal(str)
    landmark_selected = Signal(str)

    def __init__(self, line: str = "", parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.line, self.landmark = line, ""

    def select_line(self, name: str) -> None:
        """Select a line."""
        self.line = name
        self.line_selected.emit(name)

    def select_landmark(self, name: str) -> None:
        """Select a landmark."""
        self.landmark = name
        self.landmark_selected.emit(name)


@dataclass(frozen=True)
class AppContext:
    """Hold what every feature may use. It knows no feature and not the window."""

    session: Session
    jobs: Jobs
    actions: Actions
    notifications: Notifications
    navigation: Navigation
    selection: Selection
    view: ViewArea

    @property
    def window(self) -> QWidget:
        """Return the widget that dialogs belong to."""
        return self.view.window()
