"""Folders that Busk writes to, and other programs that show them and pages."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from PySide6.QtCore import QProcess, QSettings, QUrl
from PySide6.QtGui import QDesktopServices

from app.gui.application import log_folder
from app.i18n.catalog import tr
from core.document.storage.backups import backups_folder
from core.document.storage.recovery import recovery_folder
from core.garment.presets import user_folder


def open_outside(path: Path, heading: str = "") -> bool:
    """Let the desktop open a folder, or a page at a heading; tells whether it knows a program for that.

    Some desktops open the page at its top all the same.
    """
    url = QUrl.fromLocalFile(str(path))
    if heading:
        url.setFragment(heading)
    with environment_of_others():
        return QDesktopServices.openUrl(url)


@contextmanager
def environment_of_others() -> Iterator[None]:
    """Hide from programs that are started meanwhile where the frozen Busk has its libraries.

    Its loader puts them into ``LD_LIBRARY_PATH``, where a browser would find them in the place of its own,
    and keeps what stood there in ``LD_LIBRARY_PATH_ORIG``; Qt's plug-ins stand in such variables too. From
    source there is nothing to hide.
    """
    inside = getattr(sys, "_MEIPASS", "")
    ours = {name: value for name, value in os.environ.items() if inside and inside in value}
    for name, value in ours.items():
        others = [part for part in value.split(os.pathsep) if not part.startswith(inside)]
        former = os.environ.get(f"{name}_ORIG", os.pathsep.join(others))
        if former:
            os.environ[name] = former
        else:
            del os.environ[name]
    try:
        yield
    finally:
        os.environ.update(ours)


def start_again(file: str = "") -> bool:
    """Start another Busk, on a file if there is one; tells whether it began."""
    program = [sys.executable] if getattr(sys, "frozen", False) else [sys.executable, "-m", "app"]
    words = [*program[1:], *([file] if file else [])]
    return bool(QProcess.startDetached(program[0], words, os.getcwd())[0])


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
        texts = tr("The folder could not be opened."), tr("Folder: {folder}").format(folder=folder)
        inform(*texts)
