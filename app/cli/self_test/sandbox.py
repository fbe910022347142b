"""Apart: what a self-test writes lies in a folder of its own, never among the user's settings and work."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import platformdirs

from core.errors import UserError

_FOLDERS = ("config", "data", "state", "cache")
_WINDOWS = {"APPDATA": "config", "LOCAL_APPDATA": "data"}
_FINDS = {"MPLCONFIGDIR": "matplotlib", "NUMBA_CACHE_DIR": "numba"}
_PASSING = ("TMPDIR", "TEMP", "TMP")
PASSING = "passing"
"""The folder, in the one that the test has, for files that are gone when it ends."""


@contextmanager
def apart(folder: Path) -> Iterator[None]:
    """Keep settings, tables, unsaved work and passing files of this process in ``folder`` meanwhile.

    Raises UserError where the system does not let them.
    """
    values = {f"XDG_{kind.upper()}_HOME": str(folder / kind) for kind in _FOLDERS}
    values |= {f"WIN_PD_OVERRIDE_{name}": str(folder / kind) for name, kind in _WINDOWS.items()}
    values |= {name: str(folder / "cache" / kind) for name, kind in _FINDS.items() if name in os.environ}
    values |= dict.fromkeys(_PASSING, str(folder / PASSING))
    (folder / PASSING).mkdir(parents=True, exist_ok=True)
    before, passing = {name: os.environ.get(name) for name in values}, tempfile.tempdir
    os.environ.update(values)
    tempfile.tempdir = str(folder / PASSING)
    try:
        _check(folder)
        with _settings(folder / "config"):
            yield
    finally:
        tempfile.tempdir = passing
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _check(folder: Path) -> None:
    places = (platformdirs.user_data_path("Busk"), platformdirs.user_state_path("Busk"))
    if not all(place.is_relative_to(folder) for place in places):
        raise UserError(
            "The self-test could not be isolated from user files and was not started.",
            "Report this with the version and the machine.",
        )


@contextmanager
def _settings(folder: Path) -> Iterator[None]:
    """Let settings of Qt lie in ``folder``: those of the user are kept in another format, or elsewhere."""
    try:
        from PySide6.QtCore import QSettings  # noqa: PLC0415
    except ImportError:  # the part that is about Qt tells it
        yield
        return
    before = QSettings.defaultFormat()
    QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, str(folder))
    QSettings.setDefaultFormat(QSettings.Format.IniFormat)
    try:
        yield
    finally:
        QSettings.setDefaultFormat(before)
