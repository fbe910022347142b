"""Where the window stands: on a screen that is there, never larger than it, and remembered without a quit."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QRect, QSettings, QSize, Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot
from window_tools import Script, run_bodiless

from app.gui.main_window import MainWindow
from app.gui.widgets import window_geometry as place
from app.gui.widgets.window_geometry import TITLE, fitted, put_first, put_on_screen

LAPTOP, SECOND = QRect(0, 0, 1440, 900), QRect(1440, 0, 1920, 1080)


@pytest.mark.parametrize(
    ("wanted", "where"),
    [
        (QRect(100, 100, 1200, 700), QRect(100, 100, 1200, 700)),
        (QRect(2, 40, 1600, 1000), QRect(0, TITLE, 1440, 860)),
        (QRect(300, -200, 1200, 700), QRect(240, TITLE, 1200, 700)),
        (QRect(1500, 60, 1600, 1000), QRect(1500, 60, 1600, 1000)),
        (QRect(9000, 9000, 1200, 700), QRect(240, 200, 1200, 700)),
    ],
)
def test_a_place_is_brought_onto_the_screen_it_lies_on_most(wanted: QRect, where: QRect) -> None:
    assert fitted(wanted, [LAPTOP, SECOND]) == where


def test_a_window_that_has_no_room_fills_the_screen(qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    window.setMinimumSize(1180, 700)
    for screen, maximised in ((SECOND, False), (LAPTOP, True), (QRect(0, 0, 1024, 600), True)):
        monkeypatch.setattr(place, "screens", lambda screen=screen: [screen])
        window.setWindowState(Qt.WindowState.WindowNoState)
        put_first(window, QSize(1600, 1000))
        assert window.isMaximized() == maximised
        assert screen.contains(window.normalGeometry() if maximised else window.geometry())


def test_a_window_that_was_left_maximised_stays_so(qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    monkeypatch.setattr(place, "screens", lambda: [LAPTOP])
    window.setWindowState(Qt.WindowState.WindowMaximized)
    put_on_screen(window, QRect(5000, 5000, 1200, 700))
    assert window.isMaximized()


@pytest.mark.usefixtures("empty_house")
def test_the_first_window_is_no_larger_than_the_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(place, "screens", lambda: [LAPTOP])
    seen = []

    def put(window: QWidget, wanted: QSize) -> None:
        put_first(window, wanted)
        seen.append((window.isMaximized(), LAPTOP.contains(window.normalGeometry())))

    monkeypatch.setattr(place, "put_first", put)

    def script(window: MainWindow) -> Script:
        assert set(seen) == {(True, True)}, "the window, and what holds its place before"
        window.resize(1200, 720)
        # Whoever ends the program by force finds the window here again.
        yield lambda: QSettings().contains("window/geometry")

    run_bodiless([], script)
