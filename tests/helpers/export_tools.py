"""How tests export from the window: the sheet, a dialog of files that answers, and what is said then."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtWidgets import QApplication

import app.gui.features.export.controller
from app.gui.features.export.dialog import ExportDialog
from app.gui.main_window import MainWindow

READY = "Preparing preview…"


def opened(window: MainWindow, what: str = "") -> ExportDialog:
    """Open the sheet as the menu does, and choose what to export."""
    window.actions_.export_any.trigger()
    sheet = QApplication.activeModalWidget()
    assert isinstance(sheet, ExportDialog)
    if what:
        sheet.items[what].click()
    return sheet


def told(sheet: ExportDialog) -> Callable[[], bool]:
    """What will be in the file has been worked out."""
    return lambda: sheet._contents.text() != READY


def choose(sheet: ExportDialog, key: str, value: str) -> None:
    sheet.fields[key].chosen.emit(value)


def saved_as(monkeypatch: pytest.MonkeyPatch, path: Path) -> list[tuple[Any, ...]]:
    """Let the dialog of files answer with a path, and return what it was asked."""
    asked: list[tuple[Any, ...]] = []
    monkeypatch.setattr(
        app.gui.features.export.controller, "ask_save", lambda *how: asked.append(how) or str(path)
    )
    return asked


def written(window: MainWindow) -> Callable[[], bool]:
    return lambda: window.notices.notice() is not None and window.notices.notice().tone in ("ok", "bad")
