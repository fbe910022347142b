"""How the program starts: with the sample and a tour at first, later with what was open before."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QSettings, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDragLeaveEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from window_tools import Script, run_main, settled

import app.gui.features.project.controller as project_files
import app.gui.features.project.start_controller
from app.gui.features.project.project_card import ProjectCard
from app.gui.features.project.recent_files import (
    day_of,
    file_at_start,
    project_views,
    recent_files,
    remember_file,
)
from app.gui.main_window import MainWindow
from app.presenters.samples import sample_path
from core.garment.assessment import LEVELS

pytestmark = pytest.mark.usefixtures("empty_house")


def cards(window: MainWindow) -> dict[str, ProjectCard]:
    """The cards of the start page by the names on them."""
    return {card.view.name: card for card in window.start_controller.page.shelf.cards}


def at_start(window: MainWindow) -> bool:
    return window.start_controller.page.isVisible()


@pytest.mark.usefixtures("fine_samples", "first_tour")
def test_the_first_start_leads_through_the_sample_and_later_ones_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    saved, gone = tmp_path / "customer 0412.busk", tmp_path / "customer 0340.busk"
    answers = iter(["", str(saved)])
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(saved))
    monkeypatch.setattr(app.gui.features.project.start_controller, "ask_open", lambda *_: next(answers))

    def first(window: MainWindow) -> Script:
        yield settled(window)
        assert window.session.name == "mannequin"
        assert not at_start(window)
        yield lambda: window.start_controller.tour.place == 0
        QTest.keyClick(window.start_controller.tour.mark, Qt.Key.Key_Escape)
        assert not window.start_controller.tour.mark.isVisible()
        window.project_controller.save_as()
        yield lambda: window.session.path == saved

    def second(window: MainWindow) -> Script:
        yield lambda: at_start(window)
        assert window.session.design is None
        assert window.start_controller.tour.place == -1
        the_cards_show_what_was_open(window)
        a_file_over_the_window_is_named_until_it_leaves(window)
        cards(window)["customer 0340"].click()
        assert at_start(window), "nothing was chosen"
        QTest.keyClick(cards(window)["customer 0340"], Qt.Key.Key_Delete)
        assert recent_files() == [str(saved)]
        window.project_controller.open_file(str(gone))
        yield window.notices.isVisible
        assert at_start(window), "the page stays as long as there is nothing else"
        QTest.keyClick(cards(window)["customer 0412"], Qt.Key.Key_Return)
        yield settled(window)
        assert not at_start(window)
        assert window.session.path == saved
        assert window.rail.current() == "lines", "a project was looked at when it was a scan"
        window.project_controller.open_file(str(sample_path("person")))
        yield lambda: window.session.name == "person"
        assert recent_files() == [str(saved)], "samples can always be had"
        window.start_controller.show_page()
        assert at_start(window)
        assert not window.rail.current(), "no step is open"
        assert window.variants_controller.segment.isHidden()
        QTest.keyClick(window.start_controller.page, Qt.Key.Key_Escape)
        assert not at_start(window)
        assert window.rail.current() == "scan", "the step that was open"
        assert window.variants_controller.segment.isVisible()

    run_main([], first)
    remember_file(str(gone))
    run_main([], second)
    QSettings().setValue("start", "last")
    assert file_at_start() == str(saved)


def the_cards_show_what_was_open(window: MainWindow) -> None:
    assert list(cards(window)) == ["customer 0340", "customer 0412"]
    card, missing = cards(window)["customer 0412"].view, cards(window)["customer 0340"].view
    assert missing.gone
    assert not card.gone
    assert card.look in ("", "Check before use", "Do not use")
    assert card.picture is not None
    assert (card.picture.width(), card.picture.text("Verdict") in LEVELS) == (480, True)
    assert card.day.startswith("Today")


def a_file_over_the_window_is_named_until_it_leaves(window: MainWindow) -> None:
    data, veil = QMimeData(), window.start_controller.veil
    data.setUrls([QUrl.fromLocalFile(str(Path.home() / "customer.ply"))])
    no_button, no_key = Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier
    event = QDragEnterEvent(QPoint(200, 200), Qt.DropAction.CopyAction, data, no_button, no_key)
    QApplication.sendEvent(window, event)
    assert veil.isVisible()
    assert veil.geometry() == window.rect()
    assert "customer.ply" in veil.accessibleName()
    QApplication.sendEvent(window, QDragLeaveEvent())
    assert not veil.isVisible()


def test_a_card_tells_when_its_file_was_opened_here(tmp_path: Path) -> None:
    scan = tmp_path / "anna.ply"
    scan.touch()
    os.utime(scan, (1_000_000_000, 1_000_000_000))
    remember_file(str(scan))
    assert project_views()[0].day.startswith("Today")
    QSettings().setValue("recent_times", "no times")
    assert project_views()[0].day == "9 Sep 2001", "of files from before it is not known"


def test_a_day_is_said_as_people_say_it() -> None:
    noon = 1_763_812_800.0
    day = 86_400.0
    assert day_of(noon, noon + 60).startswith("Today ")
    assert day_of(noon - day, noon) == "Yesterday"
    assert day_of(noon - 3 * day, noon) == "19 Nov"
    assert day_of(noon - 365 * day, noon) == "22 Nov 2024"
