"""Where the keyboard is: it goes round in a sheet, comes back from it, and stays near what has gone."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QHBoxLayout, QPushButton, QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from app.dress.focus import next_stop, stops
from app.dress.wishes import UNTIL_THEN
from app.menus import Menus
from app.panels.preferences import PreferencesSheet
from app.wording.words import use_language


@pytest.fixture
def window(qtbot: QtBot) -> QWidget:
    """Two parts beside each other, each with three buttons below each other."""
    result = QWidget()
    qtbot.addWidget(result)
    row = QHBoxLayout(result)
    for part in ("left", "right"):
        column = QVBoxLayout()
        holder = QWidget()
        holder.setLayout(column)
        row.addWidget(holder)
        for place in range(3):
            column.addWidget(QPushButton(f"{part} {place}"))
    result.show()
    qtbot.waitExposed(result)
    result.activateWindow()
    qtbot.waitUntil(result.isActiveWindow)
    return result


def button(window: QWidget, name: str) -> QPushButton:
    return next(each for each in window.findChildren(QPushButton) if each.text() == name)


def test_tab_goes_round_in_the_preferences_both_ways_and_the_focus_comes_back(
    window: QWidget, qtbot: QtBot
) -> None:
    button(window, "right 1").setFocus()
    sheet = PreferencesSheet(window, dict(UNTIL_THEN))
    sheet.open()
    qtbot.waitUntil(sheet.isActiveWindow)
    order = stops(sheet)
    assert len(order) > 7
    order[0].setFocus()
    for key, back in ((Qt.Key.Key_Tab, False), (Qt.Key.Key_Backtab, True)):
        seen = []
        for _ in order:
            seen.append(QApplication.focusWidget())
            QTest.keyClick(QApplication.focusWidget(), key)
        assert seen == ([order[0], *reversed(order[1:])] if back else order)
        assert QApplication.focusWidget() is order[0]
    sheet.accept()
    qtbot.waitUntil(lambda: QApplication.focusWidget() is button(window, "right 1"))


def test_the_keyboard_stays_near_what_has_gone(window: QWidget) -> None:
    for name, near in (("right 2", "right 1"), ("left 0", "left 1")):
        gone = button(window, name)
        gone.setFocus()
        order = [each for each in stops(window) if each is not gone]
        assert next_stop(order, True)
        assert QApplication.focusWidget() is button(window, near)
    assert not next_stop([], True)


@pytest.mark.parametrize(("language", "title"), [("en", "&File"), ("ja", "ファイル(&F)")])
def test_every_menu_has_a_letter_of_its_own(window: QWidget, language: str, title: str) -> None:
    try:
        use_language(language)
        menus = Menus(window)
        menus.add("file", "Open")
    finally:
        use_language("en")
    titles = [menu.title() for menu in menus.menus.values()]
    letters = [each[each.index("&") + 1] for each in titles]
    assert titles[0] == title
    assert len(set(letters)) == len(letters)
    assert [where for where, _ in menus.all()] == [title.replace("(&F)", "").replace("&", "")]
    menus.bar.show()
    menus.enter_bar()
    assert menus.bar.activeAction() is menus.bar.actions()[0]
