"""Adapt to the environment: missing or narrow streams, cache folders, a terminal or a desktop."""

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
    """A text stream that escapes control characters: file names and messages may contain some that a
    terminal would obey.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write a text, and return its number of letters."""
        self._stream.write(shown(text))
        return len(text)

    def writelines(self, texts: Iterable[str]) -> None:
        """Write texts one after the other."""
        for text in texts:
            self.write(text)

    def __getattr__(self, name: str) -> Any:
        """Return any other attribute of the stream."""
        return getattr(self._stream, name)


def set_up_streams() -> None:
    """Make the streams safe to write to, and give libraries a permanent cache folder."""
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
        folder = _cache_folder()
        os.environ["MPLCONFIGDIR"] = str(folder / "matplotlib")
        os.environ.setdefault("NUMBA_CACHE_DIR", str(folder / "numba"))
    if sys.platform.startswith("linux"):
        variable = next((name for name in ("LC_ALL", "LC_CTYPE", "LANG") if os.environ.get(name)), "LC_CTYPE")
        if (os.environ.get(variable) or "C") in ("C", "POSIX"):  # Qt would take this one too, and complain
            os.environ["LC_CTYPE" if variable == "LANG" else variable] = "C.UTF-8"


def _cache_folder() -> Path:
    """Return the user's folder for caches, or a temporary one where none can be created."""
    with suppress(OSError, RuntimeError):
        folder = platformdirs.user_cache_path("Busk", appauthor=False)
        existing = next(place for place in (folder, *folder.parents) if place.exists())
        if folder.is_absolute() and os.access(existing, os.W_OK):
            return folder
    temporary = tempfile.mkdtemp(prefix="busk-")
    atexit.register(shutil.rmtree, temporary, ignore_errors=True)
    return Path(temporary)


def has_terminal() -> bool:
    """Return whether the program was started from a terminal; else by a desktop or another program."""
    return any(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stdout, sys.stderr))


def is_seen_in_window(file: str) -> bool:
    """Return whether the window should report a missing file: after a double-click there is no terminal."""
    named = bool(Path(file).suffix) or any(mark in file for mark in (os.sep, os.altsep) if mark)
    return named and has_display() and not has_terminal()


def path_of(text: str) -> str:
    """Return the path of a file that may be given as a URL, as some file managers do."""
    if not text.lower().startswith("file:"):
        return text
    from PySide6.QtCore import QUrl  # noqa: PLC0415 (a window follows, and it brings Qt along)

    url = QUrl(text)
    if url.host().lower() == "localhost":
        url.setHost("")
    return url.toLocalFile() or text


def report_error(error: UserError, in_window: bool) -> None:
    """Print an error, and show it in a box where a window was requested and there is no stream."""
    print(f"busk: {shown_line(str(error))}", file=sys.stderr)
    if not (in_window and sys.__stderr__ is None and has_display()):
        return
    from PySide6.QtCore import Qt  # noqa: PLC0415
    from PySide6.QtWidgets import QApplication, QMessageBox  # noqa: PLC0415

    app = QApplication.instance() or QApplication(sys.argv[:1])
    box = QMessageBox(QMessageBox.Icon.Warning, "Busk", str(error.message))
    box.setTextFormat(Qt.TextFormat.PlainText)  # of this and the next text: a path may look like HTML
    box.setInformativeText(str(error.hint))
    box.exec()
    del app
