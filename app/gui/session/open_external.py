"""Folders and pages, which other programs show, as if they had been started without Busk."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from PySide6.QtCore import QProcess, QUrl
from PySide6.QtGui import QDesktopServices


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
