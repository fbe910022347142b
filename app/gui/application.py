"""The Qt application: names, theme, log and guards, set before the first window."""

from __future__ import annotations

import faulthandler
import logging
import os
import platform
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import Any

import platformdirs
import PySide6
from PySide6.QtCore import QEvent, QLibraryInfo, Qt, QTimer, QTranslator
from PySide6.QtGui import QFileOpenEvent, QGuiApplication
from PySide6.QtWidgets import QApplication

from app.gui.session.log_file import LimitedLog, trim
from app.gui.session.settings import get_setting
from app.gui.theme.icons import program_icon
from app.gui.theme.stylesheet import apply_theme, load_fonts
from app.i18n.catalog import use_language
from app.i18n.lengths import use_unit
from core import __version__
from core.errors import UserError
from core.files.atomic_write import private_folder
from core.messages import Message

# Read by the libraries at their import.
os.environ.setdefault("QT_API", "pyside6")
os.environ.setdefault("PYQTGRAPH_QT_LIB", "PySide6")

_AGAIN = 200
"""Milliseconds after which it is looked again whether a question is still open."""


class Application(QApplication):
    """The application: it hears of files that the desktop wants to have opened, at any time.

    macOS starts a program without a word and tells the file that was double-clicked by an event, perhaps
    before there is a window; it is kept until ``hand_files_to`` names who opens it.
    """

    def __init__(self, arguments: Sequence[str]) -> None:
        super().__init__(list(arguments))
        self._open: Callable[[str], object] | None = None
        self._asked = ""

    def event(self, event: QEvent) -> bool:
        """Handle events that open a file."""
        if not isinstance(event, QFileOpenEvent):
            return super().event(event)
        self._asked = event.file() or self._asked
        # Whoever opens it may ask about unsaved changes: not in the middle of an event of the system.
        QTimer.singleShot(0, self, self._hand_on)
        return True

    def hand_files_to(self, open_file: Callable[[str], object] | None) -> None:
        """Open files with ``open_file``, including one requested earlier."""
        self._open = open_file
        self._hand_on()

    def _hand_on(self) -> None:
        if not self._asked or self._open is None:
            return
        if self.activeModalWidget() is not None:  # a question is open: one after the other
            QTimer.singleShot(_AGAIN, self, self._hand_on)
            return
        file, self._asked = self._asked, ""
        self._open(file)


def hand_files_to(open_file: Callable[[str], object] | None) -> None:
    """Open files from the desktop with ``open_file`` at any time; keep them without one."""
    app = QApplication.instance()
    if isinstance(app, Application):
        app.hand_files_to(open_file)


def application(
    language: str | None = None, dark: bool | None = None, unit: str | None = None
) -> QApplication:
    """Return the application, made if there is none.

    Language, theme and unit of lengths fall back to what the user chose last. Raises UserError for a pair of
    Python and Qt that is known to crash.
    """
    _refuse_bad_pair()
    existing = QApplication.instance()
    if not isinstance(existing, QApplication):
        QApplication.setHighDpiScaleFactorRoundingPolicy(Qt.HighDpiScaleFactorRoundingPolicy.PassThrough)
        _name_to_windows()
        existing = Application(sys.argv[:1])
        existing.setOrganizationName("Busk")
        existing.setApplicationName("Busk")
        existing.setApplicationVersion(__version__)
        # How a desktop knows to which menu entry, and so to which picture, a window belongs.
        existing.setDesktopFileName("busk")
        existing.setWindowIcon(program_icon())
    use_words(existing, language or get_setting("language"))
    use_unit(unit or get_setting("unit"))
    load_fonts()
    apply_theme(existing, chosen_dark(get_setting("theme")) if dark is None else dark)
    return existing


class _QtWords(QTranslator):
    """Qt's own words; of a text that got a key letter since it was translated, the translation without."""

    def translate(self, context: str, text: str, disambiguation: Any = None, n: int = -1) -> str | None:
        """Return the translation of a text of Qt, or nothing."""
        found = super().translate(context, text, disambiguation, n)
        # Of an empty text Qt would take it that it is meant.
        return found or super().translate(context, text.replace("&", ""), disambiguation, n) or None


def use_words(app: QApplication, language: str) -> None:
    """Set the language of all words that are made from now on, those of Qt's own dialogs among them."""
    use_language(language)
    for former in app.findChildren(QTranslator):
        app.removeTranslator(former)
        former.deleteLater()
    words = _QtWords(app)
    # English is what Qt speaks by itself; of a language that it lacks, a part is left in English.
    if words.load(f"qtbase_{language}", QLibraryInfo.path(QLibraryInfo.LibraryPath.TranslationsPath)):
        app.installTranslator(words)


def log_folder() -> Path:
    """Return the folder that faults are written to."""
    return Path(platformdirs.user_log_dir("Busk", appauthor=False))


@contextmanager
def log_kept() -> Iterator[Path]:
    """Write faults, never the scan or its measures, to a log while the window is open; gives its folder.

    Where no log can be written there is none.
    """
    folder = log_folder()
    try:
        private_folder(folder)
        trim(folder / "crash.log")
        crashes = open(folder / "crash.log", "a", encoding="utf-8")  # noqa: SIM115 - closed below
    except OSError:
        yield folder
        return
    handler = LimitedLog(folder / "busk.log")
    logging.getLogger().addHandler(handler)
    hooks, told = (sys.excepthook, threading.excepthook), faulthandler.is_enabled()
    sys.excepthook = _log_fault
    threading.excepthook = _log_thread_fault
    try:
        with crashes:
            faulthandler.enable(crashes)
            yield folder
    finally:
        # The file is closed: faults go to the terminal again, if they did before.
        faulthandler.disable()
        if told and sys.__stderr__ is not None:
            faulthandler.enable(sys.__stderr__)
        sys.excepthook, threading.excepthook = hooks
        logging.getLogger().removeHandler(handler)
        handler.close()


def _log_fault(kind: type[BaseException], fault: BaseException, trace: TracebackType | None) -> None:
    logging.error("unexpected fault", exc_info=(kind, fault, trace))
    sys.__excepthook__(kind, fault, trace)


def _log_thread_fault(args: threading.ExceptHookArgs) -> None:
    _log_fault(args.exc_type, args.exc_value or RuntimeError(), args.exc_traceback)


def chosen_dark(theme: str) -> bool:
    """Return whether a theme (system, light, dark) has dark colours."""
    if theme == "system":
        return QGuiApplication.styleHints().colorScheme() == Qt.ColorScheme.Dark
    return theme == "dark"


def _name_to_windows() -> None:
    """Tell Windows that windows are those of Busk, whatever has started it: one button, our picture."""
    if sys.platform == "win32":
        import ctypes  # noqa: PLC0415 (only there it has this)

        with suppress(AttributeError, OSError):
            ctypes.windll.shell32.SetCurrentProcessExplicitAppUserModelID("Busk.Busk")


def _refuse_bad_pair() -> None:
    if PySide6.__version__.startswith("6.12.0") and sys.version_info < (3, 12):
        raise UserError(
            Message(
                "PySide6 6.12.0 crashes on Python {python_version}.", python_version=platform.python_version()
            ),
            Message("Install compatible versions: run 'make setup' again."),
        )
