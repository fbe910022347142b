"""What the window does when it is asked for help: keys, commands by their words, What's This."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QWhatsThis, QWidget

from app.gui.features.help.about import AboutSheet, DiagnosticsSheet
from app.gui.features.help.command_palette import Command, CommandSheet, plain
from app.gui.features.help.system_info import machine_facts
from app.gui.features.help.user_guide import first_page, fitting_page, show_page
from app.gui.features.help.whats_this import explain
from app.gui.session.app_folders import folders, show_folder
from app.gui.shortcuts import keys_of_parts
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import in_all_languages, tr
from app.i18n.licences import licences
from app.i18n.search_terms import SYNONYMS
from core import __version__

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow


class HelpDesk(QObject):
    """Adds the help menu and opens what it offers; what it tells is read from the actions themselves."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        add = window.actions_.add
        said = tr("Find any command by its words, and give it")
        self.palette = add("help", tr("Find a command…"), "Ctrl+K", said, do=self.find_command)
        window.rail.add_tool("search", self.palette)
        add("help", tr("Keyboard shortcuts"), "Ctrl+/", do=self.show_keys)
        explain(window)
        said = tr("Then click on something, and read what it is for")
        add("help", tr("What's this?"), "Shift+F1", said, do=QWhatsThis.enterWhatsThisMode)
        window.actions_.rule("help")
        add(
            "help", tr("Diagnostics"), tip=tr("Versions, graphics and folders, to copy"), do=self.show_machine
        )
        window.actions_.guide.triggered.connect(self.show_guide)
        window.actions_.first_steps.triggered.connect(self.show_first_steps)
        window.actions_.about.triggered.connect(self.show_about)
        menu = QAction(tr("Help"), window)
        set_tip(menu, tr("Keys, tour, What's This and more"))
        tool = window.rail.add_tool("question", menu)
        menu.triggered.connect(lambda: self._show_menu(tool))

    def commands(self) -> list[Command]:
        """Return every command of the menus."""
        return [_command(where, action) for where, action in self._window.actions_.all()]

    def find_command(self) -> None:
        """Search all commands by their words."""
        CommandSheet(self._window, tr("Find a command"), self.commands(), to_give=True).open()

    def show_keys(self) -> None:
        """Show every key: those of the commands, and those that parts of the window read themselves."""
        keyed = [command for command in self.commands() if command.keys]
        keys = [*keyed, *keys_of_parts()]
        CommandSheet(self._window, tr("Keyboard shortcuts"), keys, to_give=False).open()

    def show_guide(self) -> None:
        """Show the page of the guide that fits what is being done."""
        window = self._window
        shown: dict[QWidget | None, str] = {window.report_desk.page: "report", window.start_desk.page: ""}
        panels: dict[QWidget | None, str] = {window.garment: "garment", window.model: "model"}
        at = panels.get(window.inspector.panel(), window.navigation.step)
        show_page(fitting_page(shown.get(window.navigation.page, at)), window.notices)

    def show_first_steps(self) -> None:
        """Show the page for somebody who is here for the first time."""
        show_page(first_page(), self._window.notices)

    def show_machine(self) -> None:
        """Show what the program is made of, what draws for it, and where it writes."""
        sheet = DiagnosticsSheet(self._window, machine_facts(self._window), folders())
        sheet.folder_asked.connect(lambda folder: show_folder(folder, self._window.notifications.info))
        sheet.open()

    def show_about(self) -> None:
        """Say what Busk is, and under which licences."""
        AboutSheet(self._window, __version__, licences()).open()

    def _show_menu(self, place: QWidget) -> None:
        """Open the help menu beside the button that asks for it."""
        self._window.actions_.menus["help"].popup(place.mapToGlobal(QPoint(place.width() + 4, 0)))


def _command(where: str, action: QAction) -> Command:
    native = QKeySequence.SequenceFormat.NativeText
    keys = ", ".join(key.toString(native) for key in action.shortcuts())
    title = action.text().replace("&", "")
    titles, tips = in_all_languages(title), in_all_languages(action.toolTip())
    others = (SYNONYMS.get(each, "") for each in titles)
    words = " ".join((*titles, *in_all_languages(where), *tips, *others))
    give = action.trigger if action.isEnabled() else None
    return Command(title.rstrip("…"), where, keys, plain(words), give)
