"""What the window shows while a document is being opened: its stored picture, and its name over the lines."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.gui.features.project.recent_files import picture_of
from core.document.storage.project_file import is_project

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow


class OpeningDesk(QObject):
    """Follows the session while a document is on its way in."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._shown = ""

    def follow(self) -> None:
        """Show what is being opened, or nothing once it is open, refused or cancelled."""
        path = self._window.session.opening
        if path == self._shown:
            return
        self._shown = path
        self._window.lines.show_opening(Path(path).name if path else "")
        stored = picture_of(Path(path)) if path and is_project(path) else None
        self._window.view.cover.show_picture(stored)
