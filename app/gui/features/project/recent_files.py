"""The files that were opened last, remembered between sessions."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QBuffer, QDateTime, QIODevice, QLocale, QSettings
from PySide6.QtGui import QImage, QImageReader
from PySide6.QtWidgets import QMenu

from app.gui.features.project.project_card import ProjectView
from app.gui.session.project_thumbnail import STATE
from app.gui.session.settings import get_setting
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.assessment import headline
from app.presenters.status import state_title
from core.document.storage.project_file import is_project, picture_bytes
from core.garment.assessment import BAD, CAUTION
from core.mechanics.convergence import STATES

_KEY, _TIMES = "recent", "recent_times"
_TOURED = "toured"
_MOST = 12
_LARGEST_SIDE = 4000  # of a picture [px]: a small file could stand for a huge one


def recent_files() -> list[str]:
    """Return the last files, newest first."""
    stored = QSettings().value(_KEY, [])
    paths = [stored] if isinstance(stored, str) else stored if isinstance(stored, list) else []
    return [str(path) for path in paths]


def remember_file(path: str) -> None:
    """Place a file on top of the list."""
    path, settings = str(Path(path).absolute()), QSettings()
    paths = [path, *(other for other in recent_files() if other != path)][:_MOST]
    times = _opened() | {path: time.time()}
    settings.setValue(_KEY, paths)
    settings.setValue(_TIMES, json.dumps({each: times[each] for each in paths if each in times}))


def _opened() -> dict[str, float]:
    """Return when each of the last files was opened or saved here [s since 1970], as far as that is known."""
    try:
        told = json.loads(str(QSettings().value(_TIMES, "{}")))
    except ValueError:
        return {}
    pairs = told.items() if isinstance(told, dict) else ()
    return {str(path): float(then) for path, then in pairs if isinstance(then, int | float)}


def forget_file(path: str) -> None:
    """Take a file off the list."""
    QSettings().setValue(_KEY, [other for other in recent_files() if other != path])


def is_first_start() -> bool:
    """Return whether no file was opened, and the tour neither seen nor skipped."""
    return not recent_files() and not QSettings().contains(_TOURED)


def end_first_start() -> None:
    """Record that the tour was seen or skipped."""
    QSettings().setValue(_TOURED, True)


def file_at_start() -> str:
    """Return the file to go on with, if the user wants to go on with the last one, or an empty text."""
    last = next(iter(recent_files()), "") if get_setting("start") == "last" else ""
    return last if last and Path(last).exists() else ""


def fill_recent_menu(menu: QMenu, open_file: Callable[[str], None]) -> None:
    """List the last files in a menu; those that are gone are grey."""
    menu.clear()
    for path in recent_files():
        action = menu.addAction(Path(path).name)
        set_tip(action, path)
        action.setEnabled(Path(path).exists())
        action.triggered.connect(lambda _=False, chosen=path: open_file(chosen))
    if menu.isEmpty():
        menu.addAction(tr("No recent files")).setEnabled(False)


def project_views() -> list[ProjectView]:
    """Return the last files as they are shown on the start page, newest first."""
    return [_view_of(Path(path)) for path in recent_files()]


def _view_of(path: Path) -> ProjectView:
    name = path.stem if is_project(path) else path.name
    try:
        changed = path.stat().st_mtime
    except OSError:
        return ProjectView(str(path), name, "", gone=True)
    picture = picture_of(path) if is_project(path) else None
    state = picture.text(STATE) if picture is not None else ""
    look = headline(state) if state in (CAUTION, BAD) else ""
    if state in STATES and state != "settled":  # as versions before 0.2 wrote it
        look = state_title(state)
    return ProjectView(
        str(path), name, day_of(_opened().get(str(path), changed), time.time()), picture, look=look
    )


def picture_of(path: Path) -> QImage | None:
    """Return the picture in a project, or None; a file that is no whole project says so when it is opened."""
    data = QBuffer()
    data.setData(picture_bytes(path) or b"")
    data.open(QIODevice.OpenModeFlag.ReadOnly)
    reader = QImageReader(data)
    if max(reader.size().toTuple()) > _LARGEST_SIDE:
        return None
    image = reader.read()
    return None if image.isNull() else image


def day_of(then: float, now: float) -> str:
    """Return when something was in words, both in seconds since 1970: today with its time, else the day."""
    moment, today = (QDateTime.fromSecsSinceEpoch(int(each)) for each in (then, now))
    days = moment.date().daysTo(today.date())
    if days == 0:
        return tr("Today {time}").format(time=moment.toString("HH:mm"))
    if days == 1:
        return tr("Yesterday")
    # As it is written in the window's language, whatever that of the computer is.
    form = tr("d MMM") if moment.date().year() == today.date().year() else tr("d MMM yyyy")
    return QLocale(QLocale.Language.English).toString(moment.date(), form)
