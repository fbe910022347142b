"""The line maker: lines of the designer's own are added, ready made or point by point, and removed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint

from app.dialogs import ask_own_line
from app.present import line_title
from app.words import tr
from core.design import OwnLine
from core.errors import UserError
from core.own_lines import own_line, ready_made
from core.template import read_template

if TYPE_CHECKING:
    from app.main_window import MainWindow


class LineMaker(QObject):
    """Brings wishes for own lines to the session, and selects the line that has come."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window

    def show_menu(self) -> None:
        """Offer what can be added, under the button that asks for it."""
        button = self._window.lines.add
        self._window.actions_.add_menu.popup(button.mapToGlobal(QPoint(0, button.height() + 2)))

    def add(self, kind: str) -> None:
        """Add a pair of ready-made lines of a kind."""
        design = self._window.session.design
        if design is not None:
            self._take(ready_made(read_template(design.template))[kind])

    def ask(self) -> None:
        """Ask for control points and add the line through them."""
        design = self._window.session.design
        text = ask_own_line(self._window) if design is not None else ""
        if text and design is not None:
            try:
                self._take((own_line(text, read_template(design.template)),))
            except UserError as error:
                self._window.desk.show_failure(error)

    def remove(self, name: str) -> None:
        """Remove a line."""
        self._window.desk.select_line("mid-bust")
        self._window.session.remove_own_line(name, line_title(name))

    def _take(self, lines: tuple[OwnLine, ...]) -> None:
        titles = tr(" and ").join(line_title(line.name) for line in lines)
        self._window.session.add_own_lines(lines, tr("{line} added").format(line=titles))
        self._window.desk.go_to("lines")
        self._window.desk.select_line(lines[0].name)
