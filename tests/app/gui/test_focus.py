"""Where the keyboard is: it goes round in a sheet, comes back from it, and stays near what has gone."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QPaintEvent, QRegion
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QHBoxLayout, QPushButton, QScrollArea, QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from app.gui.features.preferences.dialog import PreferencesDialog
from app.gui.menus import Menus
from app.gui.session.settings import DEFAULTS
from app.gui.widgets.focus_chain import next_stop, stops
from app.gui.widgets.option_field import field_of
from app.gui.widgets.splitter import Splitter
from app.i18n.catalog import use_language
from app.presenters.model_options import Choice


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
    sheet = PreferencesDialog(window, dict(DEFAULTS))
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


def test_what_is_scrolled_is_read_where_it_stands_and_scrolled_to(window: QWidget) -> None:
    area, inside = QScrollArea(), QWidget()
    column = QVBoxLayout(inside)
    rows = [QPushButton(f"row {place}") for place in range(40)]
    for each in rows:
        column.addWidget(each)
    area.setWidget(inside)
    area.setWidgetResizable(True)
    left = window.layout().itemAt(0).widget().layout()
    left.insertWidget(0, area)
    area.setFixedHeight(120)
    area.show()
    QApplication.processEvents()
    order = stops(left.parentWidget())
    assert order == [area, *rows, *(button(window, f"left {place}") for place in range(3))]
    button(window, "left 0").setFocus()
    assert next_stop(order, False)
    assert QApplication.focusWidget() is rows[-1]
    assert rows[-1].visibleRegion().boundingRect().height() == rows[-1].height()


class _Canvas(QPushButton):
    """Paints all of itself, as the view does, and keeps what it was asked to paint."""

    def __init__(self) -> None:
        super().__init__()
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.painted = QRegion()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        self.painted |= event.region()


def test_a_divider_leaves_no_colour_on_what_lies_beside_it(qtbot: QtBot) -> None:
    divider, canvas = Splitter(Qt.Orientation.Horizontal, "Width"), _Canvas()
    qtbot.addWidget(divider)
    other = QPushButton("other")
    for each in (canvas, other):
        divider.addWidget(each)
    divider.resize(300, 100)
    divider.show()
    divider.activateWindow()
    qtbot.waitUntil(divider.isActiveWindow)
    line = divider.handle(1)
    line.setFocus()
    QApplication.processEvents()
    canvas.painted = QRegion()
    other.setFocus()
    qtbot.waitUntil(lambda: canvas.painted.contains(QPoint(canvas.width() - 1, canvas.height() // 2)))


def test_down_opens_what_a_pull_down_holds_and_goes_nowhere(window: QWidget, qtbot: QtBot) -> None:
    field = field_of(Choice("key", "Key", "Tip.", (("a", "A"), ("b", "B"), ("c", "C"))))
    window.layout().addWidget(field)
    field.show()
    field.setFocus()
    pull = QApplication.focusWidget()
    QTest.keyClick(pull, Qt.Key.Key_Down)
    menu = QApplication.activePopupWidget()
    assert menu is not None
    assert QApplication.focusWidget() is pull
    menu.close()


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
