"""The folders that Busk writes to by itself, and how one is shown."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QSettings

from app.gui.application import log_folder
from app.gui.session.open_external import open_outside
from app.i18n.catalog import tr
from core.document.presets import user_folder
from core.document.storage.backups import backups_folder
from core.document.storage.recovery import recovery_folder


def folders() -> list[tuple[str, Path]]:
    """Return what each folder holds, in words, and where it is, whether it has been made yet or not."""
    return [
        (tr("Log"), log_folder()),
        (tr("Unsaved work"), recovery_folder()),
        (tr("Backups"), backups_folder()),
        (tr("Presets"), user_folder()),
        (tr("Settings"), Path(QSettings().fileName()).parent),
    ]


def shown_folder(folder: Path) -> str:
    """Return a folder as it is shown and copied: ``~`` in the place of the user's own, which is a name."""
    home = Path.home()
    return str(Path("~") / folder.relative_to(home)) if folder.is_relative_to(home) else str(folder)


def show_folder(folder: Path, inform: Callable[[str, str], object]) -> None:
    """Show a folder as the desktop does; where that does not go, say where it is."""
    if not (folder.is_dir() and open_outside(folder)):
        said = tr("The folder cannot be opened here."), tr("It is {folder}.").format(folder=folder)
        inform(*said)
