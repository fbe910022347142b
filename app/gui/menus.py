"""The menus of the window and the one way to add to them; what is asked of it stands in ``actions``."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QActionGroup, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar, QWidget

from app.gui.widgets.menu import Menu
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

Key = str | QKeySequence.StandardKey

_KEY = re.compile(r"\(&\w\)|&")


class Menus:
    """The menu bar; ``menus`` holds file, edit, view, lines, solve, window and help, and submenus by name."""

    def __init__(self, parent: QWidget) -> None:
        self._parent = parent
        self.bar = QMenuBar(parent)
        titles = {
            "file": tr("File"),
            "edit": tr("Edit"),
            "view": tr("View"),
            "lines": tr("Lines"),
            "solve": tr("Solve"),
            "window": tr("Window"),
            "help": tr("Help"),
        }
        # Alt and the letter open a menu in any language: the first one of its name in English.
        self.menus = {name: self._menu(_with_key(title, name[0])) for name, title in titles.items()}
        self._ends: dict[str, QAction] = {}
        self._of_document: list[QAction] = []

    def add(
        self,
        menu: str,
        text: str,
        key: Key | None = None,
        tip: str = "",
        *,
        do: Callable[[], object] | None = None,
        checkable: bool = False,
        of_document: bool = False,
    ) -> QAction:
        """Return a new action at the foot of a menu; one ``of_document`` waits until a body is open."""
        action = QAction(text, self._parent)
        if key is not None:
            action.setShortcut(QKeySequence(key))
        if tip:
            set_tip(action, tip)
            action.setStatusTip(tip)
        action.setCheckable(checkable)
        if do is not None:
            action.triggered.connect(lambda _=False: do())
        if of_document:
            self._of_document.append(action)
            action.setEnabled(False)
        self.place(menu, action)
        return action

    def place(self, menu: str, action: QAction) -> None:
        """Place an action that was made elsewhere at the foot of a menu, above what ends it."""
        self.menus[menu].insertAction(self._ends.get(menu), action)  # type: ignore[arg-type]

    def rule(self, menu: str) -> None:
        """Draw a line under what a menu holds so far."""
        line = QAction(self._parent)
        line.setSeparator(True)
        self.place(menu, line)

    def end(self, menu: str, last: int) -> None:
        """Let the ``last`` actions of a menu stay at its foot, whatever is added later."""
        self._ends[menu] = self.menus[menu].actions()[-last]

    def _menu(self, title: str) -> Menu:
        result = Menu(self.bar, title)
        self.bar.addMenu(result)
        return result

    def submenu(self, menu: str, name: str, title: str) -> Menu:
        """Return a new menu within a menu, to be added to by ``name``."""
        result = self.menus[name] = Menu(self.menus[menu], title)
        self.place(menu, result.menuAction())
        return result

    def group(self, menu: str, titles: Mapping[str, str]) -> dict[str, QAction]:
        """Return actions of which one is on, by name."""
        group = QActionGroup(self._parent)
        actions = {name: self.add(menu, title, checkable=True) for name, title in titles.items()}
        for name, action in actions.items():
            action.setData(name)
            group.addAction(action)
        return actions

    def enable_document(self) -> None:
        """Allow what needs an open body."""
        for action in self._of_document:
            action.setEnabled(True)

    def enter_bar(self) -> None:
        """Move the keyboard focus through the menus."""
        self.bar.setFocus(Qt.FocusReason.MenuBarFocusReason)
        self.bar.setActiveAction(self.bar.actions()[0])

    def all(self) -> Iterator[tuple[str, QAction]]:
        """Yield each action of the menus with the titles of its menus, as ``View, Theme``."""
        for action in self.bar.actions():
            yield from _within(action, "")


def _within(action: QAction, above: str) -> Iterator[tuple[str, QAction]]:
    menu: QMenu | None = action.menu()  # type: ignore[assignment]  # the stub knows no menu of an action
    if menu is None:
        if not action.isSeparator() and action.text():
            yield above, action
        return
    for each in menu.actions():
        title = _KEY.sub("", menu.title())
        yield from _within(each, f"{above}, {title}" if above else title)


def _with_key(title: str, letter: str) -> str:
    """Return the title of a menu with the letter that opens it: a letter of its own, else one behind it."""
    first = title.lower().startswith(letter)
    return f"&{title}" if first else f"{title}(&{letter.upper()})"
