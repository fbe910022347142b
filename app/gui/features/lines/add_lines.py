"""Custom lines: added, ready made or through control points."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.gui.features.lines.panel import LinesPanel
from app.gui.features.lines.path_dialog import ask_own_line
from app.gui.widgets.menu import Menu, pull_down
from app.i18n.catalog import tr
from app.presenters.lines import LINE_COLOURS, pair_title
from app.presenters.messages import line_title
from core.control_mesh.template import read_template
from core.document.line_notation import ready_made_lines
from core.document.lines import CustomLine

if TYPE_CHECKING:
    from app.gui.context import AppContext


class AddLinesController(QObject):
    """Add custom lines to the design, and select the line that was added."""

    def __init__(self, context: AppContext, panel: LinesPanel) -> None:
        super().__init__(context.session)
        self._context, self._head = context, panel.head
        self.menu = Menu(context.window)
        panel.add_requested.connect(self.show_menu)
        context.actions.own_line.triggered.connect(self.ask)
        for name, action in context.actions.add_lines.items():
            action.triggered.connect(lambda _=False, name=name: self.add(name))

    def show_menu(self) -> None:
        """Show a menu of lines that can be added, below its button."""
        do = self._context.actions
        if not self.menu.actions():
            self.menu.addActions([do.draw_line, do.own_line])
            self.menu.addSeparator()
            self.menu.addActions(list(do.add_lines.values()))
        pull_down(self.menu, self._head.add)

    def add(self, kind: str) -> None:
        """Add a pair of ready-made lines of a kind; one that is there stays as it is, and is selected."""
        design = self._context.session.design
        if design is None:
            return
        pair = ready_made_lines(read_template(design.template))[kind]
        present = {line.name for line in design.own_lines}
        missing = tuple(line for line in pair if line.name not in present)
        if missing:
            self.take(missing)
        else:
            self._context.navigation.show_step("lines")
            self._context.selection.select_line(pair[0].name)

    def ask(self) -> None:
        """Let a line be drawn, and add it."""
        session = self._context.session
        if session.design is not None:
            names = {*LINE_COLOURS, *(line.name for line in session.design.own_lines)}
            line = ask_own_line(self._context.window, read_template(session.design.template), names)
            if line is not None:
                self.take((line,))

    def take(self, lines: tuple[CustomLine, ...]) -> None:
        """Add lines, and select the first."""
        session = self._context.session
        if session.design is None:
            return
        first = lines[0].name
        title = pair_title(first, session.design) if len(lines) > 1 else line_title(first, session.design)
        session.add_own_lines(lines, tr("{line} added").format(line=title))
        self._context.navigation.show_step("lines")
        self._context.selection.select_line(lines[0].name)
