"""The notice bar: what is said when, what waits, and what takes it away."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QApplication, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from app.gui.widgets.notification_bar import NotificationBar

pytestmark = pytest.mark.usefixtures("light_theme")


def test_notices_wait_for_each_other(qtbot: QtBot) -> None:
    bar, acted = NotificationBar(), []
    qtbot.addWidget(bar)
    bar.show_notice("warn", "First.", "Do this.", [("Do", lambda: acted.append("done"))], lasting=True)
    bar.show_notice("warn", "Second <b>.", lasting=True)
    bar.show_notice("warn", "Second <b>.", lasting=True)
    assert bar.notice().sentence == "First."
    assert bar.more.text() == "1 more"
    next(each for each in bar.findChildren(QPushButton) if each.text() == "Do").click()
    assert acted == ["done"]
    assert bar.notice().sentence == "Second <b>."
    assert any("&lt;b&gt;" in label.text() for label in bar.findChildren(QLabel)), "names are not markup"
    bar.close_notice()
    assert bar.notice() is None
    assert bar.isHidden()


def test_what_goes_wrong_now_is_said_now_and_the_others_can_be_looked_at(qtbot: QtBot) -> None:
    bar = NotificationBar()
    qtbot.addWidget(bar)
    bar.show_notice("warn", "Look at this.", lasting=True)
    bar.show_notice("bad", "Not read.", lasting=True)
    bar.show_notice("bad", "Not written.", lasting=True)
    assert bar.notice().sentence == "Not written."
    bar.show_notice("ok", "Written.")
    bar.show_notice("ok", "Copied.")
    assert bar.notice().sentence == "Copied.", "what goes by itself waits for nothing"
    bar.close_notice()
    seen = []
    for _ in range(4):
        seen.append((bar.notice().sentence, bar.more.text()))
        bar.more.click()
    assert [said for said, _ in seen] == ["Not written.", "Not read.", "Look at this.", "Not written."]
    assert {more for _, more in seen} == {"2 more"}


def test_only_what_a_notice_is_about_takes_it_away(qtbot: QtBot) -> None:
    bar = NotificationBar()
    qtbot.addWidget(bar)
    for sentence, about in (("Refused.", "refused"), ("Not written.", "files"), ("Open twice.", "")):
        bar.show_notice("bad", sentence, lasting=True, about=about)
    bar.withdraw("files")
    assert bar.notice().sentence == "Open twice."
    bar.close_notice()
    assert bar.notice().sentence == "Refused."
    bar.withdraw("files")
    bar.withdraw("refused")
    assert bar.notice() is None


def test_a_wide_button_stands_under_the_words_and_a_short_one_beside_them(qtbot: QtBot) -> None:
    bar = NotificationBar()
    qtbot.addWidget(bar)
    bar.resize(700, 90)
    for words, width, below in (
        ("Lower the gain, " * 3, 700, True),
        ("Undo", 700, False),
        ("Undo", 300, True),
    ):
        bar.show_notice("warn", "It swings.", actions=[(words, print)], details="Figures")
        bar.resize(width, 90)
        QApplication.processEvents()
        (one,) = bar.buttons
        assert (one.y() > bar.unfold.y() + 10) == below
        assert one.width() >= one.sizeHint().width()
        bar.resize(4 * width, 90)
        QApplication.processEvents()
        assert one.y() <= bar.unfold.y() + 10, "where there is room it stands beside them"
        bar.close_notice()


def test_no_button_is_cut_off(qtbot: QtBot) -> None:
    bar = NotificationBar()
    qtbot.addWidget(bar)
    words = ["Lengthen Mid-bust by 37.1 mm", "Lengthen Mid-bust by 2.6 mm"]
    bar.show_notice("warn", "It is strained.", actions=[(each, print) for each in words], details="Figures")
    for width, seen in ((420, 1), (680, 2), (420, 1)):
        bar.set_room(width, 600)
        QApplication.processEvents()
        shown = [each for each in bar.buttons if not each.isHidden()]
        assert len(shown) == seen
        assert all(each.width() >= each.sizeHint().width() for each in shown)
