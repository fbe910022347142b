"""Run the parts of a self-test: shared data, isolation from user files, captured faults, one line a part."""

from __future__ import annotations

import os
import sys
import tempfile
import threading
import time
import traceback
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import platformdirs

from app.presenters.samples import sample_design
from core.errors import UserError
from core.messages import Message

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow
    from core.pipeline.build import Stages
    from core.pipeline.solve import Solution

T = TypeVar("T")
LINE = "mid-bust"
"""The active line of the sample, which is changed in the window."""

TEMPORARY = "temporary"
"""The folder for temporary files, in that of the self-test."""

_WIDE = 16
_HARMLESS = ("This plugin does not support", "propagateSizeHints")  # Qt messages about the screen
_FOLDERS = ("config", "data", "state", "cache")
_WINDOWS = {"APPDATA": "config", "LOCAL_APPDATA": "data"}
_CACHES = {"MPLCONFIGDIR": "matplotlib", "NUMBA_CACHE_DIR": "numba"}


class PartError(Exception):
    """A failed check of a part, described in a sentence."""


def check(holds: bool, sentence: str) -> None:
    """Raise PartError unless it ``holds``."""
    if not holds:
        raise PartError(sentence)


@dataclass(frozen=True)
class Part(Generic[T]):
    """One check: ``work`` returns its result in a few words, or raises.

    It is skipped after one of the parts that it ``needs`` has failed.
    """

    name: str
    work: Callable[[T], str]
    needs: tuple[str, ...] = ()


def try_parts(parts: Iterable[Part[T]], bench: T, write: Callable[[str], object]) -> list[str]:
    """Run parts one after the other, and return the names of those that failed."""
    failed: list[str] = []
    for part in parts:
        missing = [name for name in part.needs if name in failed]
        # The name comes first: if the program ends in the middle of a part, it is the last word.
        write(f"  {part.name:{_WIDE}} ")
        start = time.perf_counter()
        try:
            result = f"skipped: requires {', '.join(missing)}" if missing else f"ok      {part.work(bench)}"
        except Exception as fault:
            result, missing = f"FAILED  {_described(fault)}", [part.name]
        failed += [part.name] if missing else []
        write(f"{result}  ({time.perf_counter() - start:.2f} s)\n")
    return failed


def _described(fault: Exception) -> str:
    """Return a fault in one line; of an unexpected one also its place."""
    text = " ".join(str(fault).split())
    if isinstance(fault, PartError | UserError):
        return text
    frame = traceback.extract_tb(fault.__traceback__)[-1]
    return f"{type(fault).__name__}: {text} ({Path(frame.filename).name}, line {frame.lineno})"


class SelfTestFixture:
    """The data that parts share: a folder, the solved sample, the window while it is open, and faults."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.held = ExitStack()
        self.window: MainWindow | None = None
        self.faults: list[str] = []

    @cached_property
    def stages(self) -> Stages:
        """Return the sample with one active line, before solving."""
        from core.pipeline.build import build  # noqa: PLC0415 (a part reports what cannot be imported)

        return build(sample_design().with_line(LINE, 0.93))

    @cached_property
    def solution(self) -> Solution:
        """Return the sample, solved with adaptive volume control."""
        from core.pipeline.solve import solve  # noqa: PLC0415

        return solve(self.stages)

    @cached_property
    def project(self) -> Path:
        """Return the sample as a project file."""
        from core.document.document import Document  # noqa: PLC0415
        from core.document.storage.project_file import save_project  # noqa: PLC0415

        path = self.folder / "self-test \N{LATIN SMALL LETTER E WITH ACUTE} 試し.busk"
        save_project(path, Document.single(self.stages.design), self.stages.scan, None)
        return path

    def check_faults(self) -> None:
        """Raise PartError if a fault was captured since the last time."""
        faults, self.faults[:] = list(self.faults), []
        check(not faults, "; ".join(dict.fromkeys(faults)))


@contextmanager
def captured_faults() -> Iterator[list[str]]:
    """Yield the list of faults in other threads and of Qt messages, which are otherwise only printed."""
    from PySide6.QtCore import QtMsgType, qInstallMessageHandler  # noqa: PLC0415 (brings Qt along)

    faults: list[str] = []

    def take_message(kind: QtMsgType, where: Any, text: str) -> None:
        if kind not in (QtMsgType.QtDebugMsg, QtMsgType.QtInfoMsg) and not text.startswith(_HARMLESS):
            faults.append(f"Qt message: {text}")

    def take_fault(fault: Any) -> None:
        faults.append(f"{fault.exc_type.__name__}: {fault.exc_value}")

    hooks = sys.excepthook, threading.excepthook, sys.unraisablehook
    former = qInstallMessageHandler(take_message)
    sys.excepthook = lambda kind, fault, trace: faults.append(f"{kind.__name__}: {fault}")
    threading.excepthook = sys.unraisablehook = take_fault
    try:
        yield faults
    finally:
        sys.excepthook, threading.excepthook, sys.unraisablehook = hooks
        qInstallMessageHandler(former)


@contextmanager
def isolated(folder: Path) -> Iterator[None]:
    """Keep settings, tables, unsaved work and temporary files of this process in ``folder``.

    Raises UserError where the system does not allow it.
    """
    values = {f"XDG_{kind.upper()}_HOME": str(folder / kind) for kind in _FOLDERS}
    values |= {f"WIN_PD_OVERRIDE_{name}": str(folder / kind) for name, kind in _WINDOWS.items()}
    values |= {name: str(folder / "cache" / kind) for name, kind in _CACHES.items() if name in os.environ}
    values |= dict.fromkeys(("TMPDIR", "TEMP", "TMP"), str(folder / TEMPORARY))
    (folder / TEMPORARY).mkdir(parents=True, exist_ok=True)
    before, temporary = {name: os.environ.get(name) for name in values}, tempfile.tempdir
    os.environ.update(values)
    tempfile.tempdir = str(folder / TEMPORARY)
    try:
        places = (platformdirs.user_data_path("Busk"), platformdirs.user_state_path("Busk"))
        if not all(place.is_relative_to(folder) for place in places):
            raise UserError(
                Message("The self-test could not be isolated from user files and was not started."),
                Message("Report this with the version and the machine."),
            )
        with _settings_in(folder / "config"):
            yield
    finally:
        tempfile.tempdir = temporary
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


@contextmanager
def _settings_in(folder: Path) -> Iterator[None]:
    """Keep settings of Qt in ``folder``: those of the user have another format or place."""
    try:
        from PySide6.QtCore import QSettings  # noqa: PLC0415
    except ImportError:  # the part on Qt reports it
        yield
        return
    before = QSettings.defaultFormat()
    QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, str(folder))
    QSettings.setDefaultFormat(QSettings.Format.IniFormat)
    try:
        yield
    finally:
        QSettings.setDefaultFormat(before)
