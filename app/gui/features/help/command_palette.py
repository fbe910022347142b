"""Command palette: all commands of the window with their keys, to search and run."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QHeaderView, QLineEdit, QTreeWidget, QTreeWidgetItem, QWidget

from app.gui.theme.stylesheet import font
from app.gui.widgets.basic import sentence
from app.gui.widgets.dialog import Dialog
from app.i18n.catalog import tr


@dataclass(frozen=True)
class Command:
    """One thing to ask for: its words, where it stands, its keys; ``words`` is what it is found by."""

    title: str
    where: str
    keys: str
    words: str
    give: Callable[[], object] | None = None


def normalized(text: str) -> str:
    """Return text as it is compared: in small letters of one width."""
    return unicodedata.normalize("NFKC", text).casefold()


def _distance(command: Command, words: Sequence[str]) -> int:
    """Return how far a command is from what is typed: its title or another word begins so."""
    if not words:
        return 0
    title, word = normalized(command.title), words[0]
    ranks = title.startswith(word), word in title, f" {word}" in command.words
    return ranks.index(True) if any(ranks) else len(ranks)


class CommandList(QTreeWidget):
    """Commands by the place where they stand, or in the order of how well they are found."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.setAccessibleName(name)
        self.setColumnCount(3)
        self.setHeaderHidden(True)
        self.setRootIsDecorated(False)
        self.setIndentation(0)
        self.setUniformRowHeights(True)
        self.setAllColumnsShowFocus(True)
        self.setFont(font("body"))
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)

    def show_commands(self, commands: Sequence[Command]) -> None:
        """Show these; the first is chosen."""
        self.clear()
        for command in commands:
            item = QTreeWidgetItem([command.title, command.where, command.keys])
            item.setData(0, Qt.ItemDataRole.UserRole, command)
            item.setForeground(1, self.palette().placeholderText())
            item.setTextAlignment(2, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            item.setFont(2, font("body", tabular=True))
            if command.give is None and not command.keys:
                item.setDisabled(True)
            self.addTopLevelItem(item)
        self.choose(0)
        head = self.header()
        head.setStretchLastSection(False)
        head.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        for column in (1, 2):
            head.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)

    def choose(self, row: int) -> None:
        """Choose the command in this row, or the nearest that there is."""
        item = self.topLevelItem(min(max(row, 0), self.topLevelItemCount() - 1))
        if item is not None:
            self.setCurrentItem(item)

    def chosen(self) -> Command | None:
        """Return the command that is chosen."""
        item = self.currentItem()
        return None if item is None else item.data(0, Qt.ItemDataRole.UserRole)


class CommandPalette(Dialog):
    """A field to search in over a list of commands; ``to_give`` has Enter give the chosen one."""

    def __init__(self, parent: QWidget, title: str, commands: Sequence[Command], to_give: bool) -> None:
        super().__init__(parent, title, (620, 560))
        self._commands, self._to_give = tuple(commands), to_give
        self.search = QLineEdit()
        self.search.setPlaceholderText(tr("Search in English or Japanese"))
        self.search.setAccessibleName(tr("Search"))
        self.search.setMinimumHeight(30)
        self.search.setClearButtonEnabled(True)
        self.search.installEventFilter(self)
        self.search.textChanged.connect(self._find)
        self.list = CommandList(title)
        self._nothing = sentence(tr("No matching command."))
        for each in (self.search, self.list, self._nothing):
            self.body.addWidget(each)
        if to_give:
            self.list.itemActivated.connect(self._give)
            self.search.returnPressed.connect(self._give)
        self.add_close().setDefault(False)
        self._find("")

    def _find(self, text: str) -> None:
        words = normalized(text).split()
        found = [each for each in self._commands if all(word in each.words for word in words)]
        found.sort(key=lambda each: _distance(each, words))
        self.list.show_commands(found)
        self._nothing.setVisible(not found)

    def _give(self) -> None:
        command = self.list.chosen()
        if command is not None and command.give is not None:
            self.accept()
            command.give()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Let the arrows go through the list while a word is being typed."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            steps = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1, Qt.Key.Key_PageDown: 10, Qt.Key.Key_PageUp: -10}
            step = steps.get(Qt.Key(event.key()))
            if step is not None:
                self.list.choose(self.list.currentIndex().row() + step)
                return True
        return super().eventFilter(watched, event)
