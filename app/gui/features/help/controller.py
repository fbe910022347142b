"""Help: keys, commands by their words, What's this, the guide, diagnostics."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QWhatsThis, QWidget

from app.gui.features.help.about import AboutDialog, DiagnosticsDialog
from app.gui.features.help.command_palette import Command, CommandPalette, normalized
from app.gui.features.help.system_info import system_info
from app.gui.features.help.user_guide import first_page, fitting_page, show_page
from app.gui.features.help.whats_this import explain
from app.gui.session.app_folders import folders, show_folder
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import in_all_languages, tr
from app.i18n.licences import licences
from app.i18n.search_terms import SYNONYMS
from core import __version__

if TYPE_CHECKING:
    from app.gui.context import AppContext


class HelpController(QObject):
    """Add the help menu and open what it offers; commands and keys are read from the actions themselves.

    ``parts`` are explained by What's this, see ``whats_this``; ``pages`` names those of the guide for pages
    that take the place of the work. ``menu`` is for a button that shows the help menu.
    """

    def __init__(
        self,
        context: AppContext,
        parts: Mapping[str, QWidget],
        keys_of_parts: Callable[[], Iterable[Command]],
        pages: Mapping[QWidget, str],
    ) -> None:
        super().__init__(context.session)
        self._context, self._keys_of_parts, self._pages = context, keys_of_parts, pages
        add = context.actions.add
        text = tr("Search and run commands")
        self.palette = add("help", tr("Find command…"), "Ctrl+K", text, do=self.find_command)
        add("help", tr("Keyboard shortcuts"), "Ctrl+/", do=self.show_keys)
        explain(parts)
        text = tr("Click a part of the window to read its description")
        add("help", tr("What's this?"), "Shift+F1", text, do=QWhatsThis.enterWhatsThisMode)
        context.actions.rule("help")
        add(
            "help",
            tr("Diagnostics"),
            tip=tr("Show system information for bug reports"),
            do=self.show_machine,
        )
        context.actions.guide.triggered.connect(self.show_guide)
        context.actions.first_steps.triggered.connect(self.show_first_steps)
        context.actions.about.triggered.connect(self.show_about)
        self.menu = QAction(tr("Help"), self)
        set_tip(self.menu, tr("Shortcuts, tour, user guide and more"))

    def commands(self) -> list[Command]:
        """Return every command of the menus."""
        return [_command(where, action) for where, action in self._context.actions.all()]

    def find_command(self) -> None:
        """Search all commands by their words."""
        CommandPalette(self._context.window, tr("Find command"), self.commands(), to_give=True).open()

    def show_keys(self) -> None:
        """Show every key: those of the commands, and those that parts of the window read themselves."""
        keyed = [command for command in self.commands() if command.keys]
        keys = [*keyed, *self._keys_of_parts()]
        CommandPalette(self._context.window, tr("Keyboard shortcuts"), keys, to_give=False).open()

    def show_guide(self) -> None:
        """Show the page of the guide that fits what is being done."""
        navigation = self._context.navigation
        at = navigation.panel if navigation.panel in ("garment", "model") else navigation.step
        if navigation.page is not None:
            at = self._pages.get(navigation.page, at)
        show_page(fitting_page(at), self._context.notifications)

    def show_first_steps(self) -> None:
        """Show the page for somebody who is here for the first time."""
        show_page(first_page(), self._context.notifications)

    def show_machine(self) -> None:
        """Show what the program is made of, what draws for it, and where it writes."""
        sheet = DiagnosticsDialog(self._context.window, system_info(self._context.window), folders())
        sheet.folder_requested.connect(lambda folder: show_folder(folder, self._context.notifications.info))
        sheet.open()

    def show_about(self) -> None:
        """Show version and licences."""
        AboutDialog(self._context.window, __version__, licences()).open()

    def show_menu(self, place: QWidget) -> None:
        """Open the help menu beside the button that asks for it."""
        self._context.actions.menus["help"].popup(place.mapToGlobal(QPoint(place.width() + 4, 0)))


def _command(where: str, action: QAction) -> Command:
    native = QKeySequence.SequenceFormat.NativeText
    keys = ", ".join(key.toString(native) for key in action.shortcuts())
    title = action.text().replace("&", "")
    titles, tips = in_all_languages(title), in_all_languages(action.toolTip())
    others = (SYNONYMS.get(each, "") for each in titles)
    words = " ".join((*titles, *in_all_languages(where), *tips, *others))
    give = action.trigger if action.isEnabled() else None
    return Command(title.rstrip("…"), where, keys, normalized(words), give)
