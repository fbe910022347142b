"""The 3D view without the graphics driver: when it is asked for, and when starts have failed."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot
from window_tools import Script, run_main, settled

import app.gui.features.help.safe_mode
from app.gui.features.help.safe_mode import SafeMode
from app.gui.main_window import MainWindow
from app.gui.session.session import Session
from app.gui.viewport.canvas import Canvas
from app.gui.viewport.opengl import begin_graphics, graphics_work, spare_graphics
from core.document.storage.crash_counter import failed_starts, starts_folder

pytestmark = pytest.mark.usefixtures("empty_house")


@pytest.mark.usefixtures("fine_samples")
def test_the_safe_mode_draws_without_the_graphics_driver_and_says_so() -> None:
    def asked(window: MainWindow) -> Script:
        yield settled(window)
        assert [canvas.painted for canvas in window.view.findChildren(Canvas)] == [True]
        notice = window.notices.notice()
        assert notice is not None
        assert notice.sentence.startswith("Safe mode")
        image = window.view.viewport.picture()
        colours = {image.pixelColor(x, image.height() // 2).name() for x in range(0, image.width(), 7)}
        assert len(colours) > 20

    def failed(window: MainWindow) -> Script:
        yield settled(window)
        notice = window.notices.notice()
        assert notice is not None
        assert "twice" in notice.sentence
        notice.actions[0][1]()
        assert not failed_starts()

    run_main(["--safe-mode"], asked)
    for _ in range(2):
        crash_at_the_start()
    run_main([], failed)


_START = "import sys; from core.document.storage.crash_counter import StartMarker; "
_START += "start = StartMarker(); print(1, flush=True); sys.stdin.read()"


@contextmanager
def another_start() -> Iterator[None]:
    """Another process is about to draw its first picture; at the end it is killed."""
    with subprocess.Popen([sys.executable, "-c", _START], stdin=-1, stdout=-1) as other:
        assert other.stdout is not None
        assert other.stdout.readline()
        yield
        other.kill()


def crash_at_the_start() -> None:
    with another_start():
        pass


def begun() -> int:
    return len(list(starts_folder().glob("*/begun")))


def test_windows_that_are_opened_together_are_no_crashes(qapp: QApplication) -> None:
    with another_start(), another_start():
        assert begin_graphics(False) == "", "two others draw their first picture just now"
        assert begun() == 3
        spare_graphics()
    assert begin_graphics(False) == "failed", "the two were killed"
    graphics_work()
    assert begin_graphics(False) == ""
    graphics_work()
    assert begun() == 0


def test_only_an_end_while_the_driver_is_at_work_counts_as_its_fault(
    qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(app.gui.features.help.safe_mode, "_DRAWN_FOR", 1)
    window = QWidget()
    qtbot.addWidget(window)
    window.session = Session(window)
    crash_at_the_start()
    assert begin_graphics(False) == ""
    start = SafeMode(window, "")
    assert begun() == 2
    qtbot.waitUntil(lambda: begun() == 1)  # the start page waits: if it is killed now that is no fault
    window.session.opened.emit(None)
    assert begun() == 2, "it is about to be drawn"
    qtbot.waitUntil(lambda: begun() == 0)
    assert not start._clock.isActive()
    window.session.close()
