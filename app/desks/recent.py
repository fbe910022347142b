"""The files that were opened last, remembered between sessions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QMenu

from app.wording.words import tr

_KEY = "recent"
_MOST = 10


def recent_files() -> list[str]:
    """Return the last files, newest first."""
    stored = QSettings().value(_KEY, [])
    paths = [stored] if isinstance(stored, str) else stored if isinstance(stored, list) else []
    return [str(path) for path in paths]


def remember_file(path: str) -> None:
    """Put a file on top of the list."""
    path = str(Path(path).absolute())
    QSettings().setValue(_KEY, [path, *(other for other in recent_files() if other != path)][:_MOST])


def fill_recent_menu(menu: QMenu, open_file: Callable[[str], None]) -> None:
    """List the last files in a menu; those that are gone are grey."""
    menu.clear()
    for path in recent_files():
        action = menu.addAction(Path(path).name)
        action.setToolTip(path)
        action.setEnabled(Path(path).exists())
        action.triggered.connect(lambda _=False, chosen=path: open_file(chosen))
    if menu.isEmpty():
        menu.addAction(tr("Nothing yet")).setEnabled(False)
