"""Variants of the design through the real main(): looked at, flipped, their figures beside each other."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_main, settled, undrawn

from app.main_window import MainWindow
from app.viewing import flip_key

pytestmark = pytest.mark.usefixtures("empty_house")
SPACE = Qt.Key.Key_Space


def test_the_space_bar_goes_back_to_the_way_it_was_flipped_from(monkeypatch: pytest.MonkeyPatch) -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        view = window.view
        window.activateWindow()
        yield window.isActiveWindow
        window.variant_desk.choose("B")
        yield settled(window)
        for way in ("variants", "side", "wipe"):
            show(window, way)
            yield lambda way=way: view.beside.way == way
            monkeypatch.setattr(flip_key, "HOLD", 60_000)
            QTest.keyClick(window, SPACE)
            assert view.beside.way == "before"
            QTest.keyClick(window, SPACE)
            assert view.beside.way == way
            monkeypatch.setattr(flip_key, "HOLD", 0)  # now every press is a long one
            QTest.keyPress(window, SPACE)
            assert view.beside.way == "before"
            QTest.keyRelease(window, SPACE)
            assert view.beside.way == way
        window.desk.go_to("scan")
        assert view.beside.way == "before"
        QTest.keyPress(window, SPACE)
        assert view.beside.way == "after", "the wipe was left for good"
        QTest.keyRelease(window, SPACE)
        assert view.beside.way == "before"

    run_main([], script)


def show(window: MainWindow, way: str) -> None:
    if way == "variants":
        window.variant_desk.show_side_by_side()
    else:
        window.view.compare_by(way)
