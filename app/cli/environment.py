"""What a program finds round itself: streams that may be missing or narrow, a terminal or a desktop."""

from __future__ import annotations

import atexit
import io
import os
import shutil
import sys
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, TextIO

import platformdirs

from app.rendering.display import has_display
from core.document.printable_name import shown, shown_line
from core.errors import UserError


class PlainStream:
    """A text stream that spells control characters: names of files and messages may hold some that a
    terminal would obey.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write a text, and return how many of its letters were given."""
        self._stream.write(shown(text))
        return len(text)

    def writelines(self, texts: Iterable[str]) -> None:
        """Write texts one after the other."""
        for text in texts:
            self.write(text)

    def __getattr__(self, name: str) -> Any:
        """Return what else the stream has."""
        return getattr(self._stream, name)


def settle_in() -> None:
    """Make streams safe to write to, and give libraries a lasting place for what they find out."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:  # a Windows program without a console
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 - as long as we run
        elif isinstance(stream, io.TextIOWrapper):
            if stream.errors == "strict":
                # A console of another code page lacks some of our letters: better one is lost than all.
                stream.reconfigure(errors="replace")
            setattr(sys, name, PlainStream(stream))
    if getattr(sys, "frozen", False):
        # The packager lets one look for all type of the system at each start anew; the other would keep
        # what it compiles where the program lies.
        folder = _lasting()
        os.environ["MPLCONFIGDIR"] = str(folder / "matplotlib")
        os.environ.setdefault("NUMBA_CACHE_DIR", str(folder / "numba"))
    if sys.platform.startswith("linux"):
        told = next((name for name in ("LC_ALL", "LC_CTYPE", "LANG") if os.environ.get(name)), "LC_CTYPE")
        if (os.environ.get(told) or "C") in ("C", "POSIX"):  # Qt would take this one too, and complain
            os.environ["LC_CTYPE" if told == "LANG" else told] = "C.UTF-8"


def _lasting() -> Path:
    """Return the user's folder for caches, or a passing one where none can be made: there may be no home."""
    with suppress(OSError, RuntimeError):
        folder = platformdirs.user_cache_path("Busk", appauthor=False)
        there = next(place for place in (folder, *folder.parents) if place.exists())
        if folder.is_absolute() and os.access(there, os.W_OK):
            return folder
    passing = tempfile.mkdtemp(prefix="busk-")
    atexit.register(shutil.rmtree, passing, ignore_errors=True)
    return Path(passing)


def has_terminal() -> bool:
    """Tell whether somebody at a terminal has called; else it was a desktop, or another program."""
    return any(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stdout, sys.stderr))


def is_seen_in_window(file: str) -> bool:
    """Tell whether the window should say that a file is not there: who double-clicks sees no terminal."""
    named = bool(Path(file).suffix) or any(mark in file for mark in (os.sep, os.altsep) if mark)
    return named and has_display() and not has_terminal()


def path_of(text: str) -> str:
    """Return the path of a file that may have been handed over as a URL, as some file managers do."""
    if not text.lower().startswith("file:"):
        return text
    from PySide6.QtCore import QUrl  # noqa: PLC0415 (a window follows, and it brings Qt along)

    url = QUrl(text)
    if url.host().lower() == "localhost":
        url.setHost("")
    return url.toLocalFile() or text


def tell(error: UserError, of_window: bool) -> None:
    """Say what is wrong: in the terminal, and in a box where a window was wanted and no stream is there."""
    print(f"busk: {shown_line(str(error))}", file=sys.stderr)
    if not (of_window and sys.__stderr__ is None and has_display()):
        return
    from PySide6.QtCore import Qt  # noqa: PLC0415
    from PySide6.QtWidgets import QApplication, QMessageBox  # noqa: PLC0415

    app = QApplication.instance() or QApplication(sys.argv[:1])
    box = QMessageBox(QMessageBox.Icon.Warning, "Busk", error.message)
    box.setTextFormat(Qt.TextFormat.PlainText)  # of this and the next text: a path may look like HTML
    box.setInformativeText(error.hint)
    box.exec()
    del app
