"""The first run: the sample opens in a bra, and the tour ends with that and the sheet."""

from __future__ import annotations

from pathlib import Path
from shutil import copy

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot
from window_tools import Script, run_main, settled

from app.gui.features.report.controller import ReportController
from app.gui.main_window import MainWindow
from app.gui.widgets.coach_mark import CoachMark
from app.presenters.bust_shift import bust_shift, shift_between, up_text
from app.presenters.samples import FIRST_SAMPLE, SAMPLES, WHOLE_TRUNK, dressed_sample, sample_design
from core.garment.assessment import BAD, GOOD, assess
from core.garment.presets import find_preset, with_preset
from core.pipeline.build import build
from core.pipeline.solve import solve
from tests.end_to_end.test_cups import pulled

pytestmark = pytest.mark.usefixtures("empty_house", "landmarks_known")

SEEN = 5.0
"""A lift of the bust points that is seen in the view from near by, beside the original [mm]."""


@pytest.mark.usefixtures("fine_samples")
@pytest.mark.parametrize("name", SAMPLES)
def test_the_bra_of_a_sample_lifts_the_bust_and_can_be_worn(name: str) -> None:
    solution = solve(build(dressed_sample(name)))
    stages = solution.stages
    assert shift_between(stages.rest_marks, stages.watch(solution.control_points)).mean.up > SEEN
    assert assess(solution).level == GOOD


@pytest.mark.usefixtures("opened_as_in_the_program")
def test_the_tour_leads_from_the_lifted_bust_to_the_sheet() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        tour = window.start_controller.tour
        yield lambda: tour.place == 0
        assert window.session.design == dressed_sample(FIRST_SAMPLE)
        yield lambda: window.strip.chip.state() != "pending"
        assert window.strip.chip.state() != BAD
        assert window.view.compare.actions_by_name["ghost"].isChecked()
        steps = (before_and_after, four_steps, a_cup, the_verdict, the_sheet)
        for place, step in enumerate(steps):
            assert tour.place == place
            yield from covers_nothing_that_must_be_seen(window)
            yield from step(window)
            QTest.keyClick(tour.mark, Qt.Key.Key_Return if step is not the_sheet else Qt.Key.Key_Escape)
        assert tour.place == -1
        assert not tour.mark.isVisible()
        assert lift(window) > SEEN
        assert window.report_controller.is_open, "the sheet is there when the tour is over"
        the_samples_open_as_at_first(window)
        yield settled(window)

    run_main([], script)


@pytest.mark.usefixtures("opened_as_in_the_program")
def test_the_tour_goes_on_at_the_report_that_is_opened_meanwhile() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        tour = window.start_controller.tour
        yield lambda: tour.place == 0
        window.report_controller.action.trigger()
        yield lambda: tour.place == 4
        yield from covers_nothing_that_must_be_seen(window)
        tour.end()
        yield settled(window)

    run_main([], script)


def test_the_tour_ends_with_a_girdle(monkeypatch: pytest.MonkeyPatch) -> None:
    girdle = with_preset(sample_design(WHOLE_TRUNK), find_preset("girdle"))
    monkeypatch.setattr("app.gui.features.project.controller.dressed_sample", lambda name: girdle)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.start_controller.take_tour()
        tour = window.start_controller.tour
        for _ in range(5):
            QTest.keyClick(tour.mark, Qt.Key.Key_Return)
        assert tour.place == 5
        assert not window.report_controller.is_open
        yield lambda: window.session.design is girdle
        yield lambda: tour.mark.ring.geometry().contains(place_of(window, window.lines.rows["waist"]))
        yield settled(window)
        assert "girdle" in tour.mark.accessibleName()
        assert window.session.frame.lower is not None
        assert window.lines.rows["waist"].slider.ratio() < 1.0
        QTest.keyClick(tour.mark, Qt.Key.Key_Return)
        assert tour.place == -1

    run_main([], script)


def before_and_after(window: MainWindow) -> Script:
    """The number that is told is that of the body; Space shows the original one, and the reshaped again."""
    mark = window.start_controller.tour.mark
    assert lift(window) > SEEN
    assert up_text(lift(window)) in mark.accessibleName()
    window.activateWindow()
    yield window.isActiveWindow
    for after in (False, True):
        QTest.keyClick(mark, Qt.Key.Key_Space)
        assert window.view.after is after
    yield settled(window)


def four_steps(window: MainWindow) -> Script:
    mark = window.start_controller.tour.mark
    assert "Ctrl+O" in mark.accessibleName(), "the way to a scan of one's own"
    assert all(mark.ring.geometry().contains(place_of(window, each)) for each in window.rail.items.values())
    window.rail.items["landmarks"].click()
    assert window.rail.current() == "landmarks"
    window.rail.items["lines"].click()
    yield settled(window)


def a_cup(window: MainWindow) -> Script:
    """A higher cup lifts and presses more, what is below the body tells so, and Ctrl+Z takes it back."""
    design, before, pressed = window.session.design, lift(window), pressure(window)
    slider = window.cups.rows["lift"].slider
    assert window.start_controller.tour.mark.ring.geometry().contains(place_of(window, slider))
    pulled(window, "lift", design.cup.lift + 6.0)
    yield settled(window)
    assert lift(window) > before + 2.0
    yield lambda: pressure(window) > pressed + 0.02
    QTest.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    yield settled(window)
    assert window.session.design == design
    yield lambda: 0.0 < pressure(window) < pressed + 0.01


def the_verdict(window: MainWindow) -> Script:
    """A click on the verdict opens what it is made of."""
    ring = window.start_controller.tour.mark.ring.geometry()
    assert ring.contains(place_of(window, window.strip.chip))
    yield settled(window)


def the_sheet(window: MainWindow) -> Script:
    desk: ReportController = window.report_controller
    assert desk.is_open
    yield desk.page.does["pdf"].isEnabled
    assert desk.handout is not None
    row, *_ = desk.handout.report.cuts.rows
    assert row.cut_mm, "what to cut is on it"


def covers_nothing_that_must_be_seen(window: MainWindow) -> Script:
    """The card is off the bust, the rail, the menus and its own subject; it makes way for a notice."""
    mark = window.start_controller.tour.mark
    yield lambda: not seen_of(mark).intersects(mark.ring.geometry())
    window.notices.show_notice("warn", "The scan has holes.", "Fill them.", lasting=True, about="test")
    yield lambda: window.notices.isVisible() and not seen_of(mark).intersects(notice_of(window))
    assert window.rect().contains(mark.geometry())
    for part in (window.top, window.rail):
        assert not seen_of(mark).intersects(place_of(window, part))
    if not window.report_controller.is_open:
        assert not seen_of(mark).intersects(bust_of(window))
        for part in (window.view.tools, window.view.compare):
            assert not seen_of(mark).intersects(place_of(window, part)), type(part).__name__
    window.notices.withdraw("test")
    yield settled(window)


@pytest.fixture
def mark(qtbot: QtBot) -> CoachMark:
    """The card of a tour on a plain window."""
    window = QWidget()
    qtbot.addWidget(window)
    window.resize(1000, 800)
    return CoachMark(window)


def test_a_card_makes_way_for_what_must_be_seen(mark: CoachMark) -> None:
    mark.show_step(0, 2, "Title", "Words.")
    room, target = QRect(0, 0, 1000, 800), QRect(400, 100, 100, 40)
    mark.point_at(target, room)
    below = seen_of(mark)
    mark.point_at(target, room, [below])
    assert not seen_of(mark).intersects(below)
    assert not seen_of(mark).intersects(target)
    assert room.contains(mark.geometry())


def test_a_later_step_of_fewer_words_is_lower(mark: CoachMark) -> None:
    heights = []
    for words in ("Word.", "Many words. " * 20, "Word."):
        mark.show_step(0, 2, "Title", words)
        heights.append(mark.height())
    assert heights[0] == heights[2] < heights[1]


def test_the_tour_of_a_scan_without_lines_tells_that_nothing_moved(person: Path, tmp_path: Path) -> None:
    scan = copy(person, tmp_path / "scan.ply")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.start_controller.take_tour()
        assert len(window.start_controller.tour._stops()) == 5, "a scan of one's own stays open"
        assert "0.0 mm" in window.start_controller.tour.mark.accessibleName()
        assert not window.view.compare.actions_by_name["ghost"].isChecked(), "that is for the samples"
        window.start_controller.tour.end()

    run_main([str(scan)], script)


def the_samples_open_as_at_first(window: MainWindow) -> None:
    opened = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(window.session, "open_design", opened.append)
        patch.setattr(window.project_controller, "may_leave", lambda: True)
        for action in window.actions_.samples.values():
            action.trigger()
    assert opened == [dressed_sample(name) for name in SAMPLES]


def lift(window: MainWindow) -> float:
    assert window.session.frame is not None
    return bust_shift(window.session.frame).mean.up


def pressure(window: MainWindow) -> float:
    """The largest contact pressure of a cup [kPa], 0 until it is known."""
    assert window.session.frame is not None
    listed = window.pressure_controller.of(window.session.frame)
    rows = listed.rows if listed is not None else ()
    return max((row.max_kpa or 0.0 for row in rows if row.line.startswith("cup")), default=0.0)


def seen_of(mark: CoachMark) -> QRect:
    """Where a card is without its shadow."""
    left, top, right, bottom = mark.MARGINS
    return mark.geometry().adjusted(left, top, -right, -bottom)


def notice_of(window: MainWindow) -> QRect:
    return place_of(window, window.notices)


def place_of(window: MainWindow, part: QWidget) -> QRect:
    return QRect(part.mapTo(window, QPoint(0, 0)), part.size())


def bust_of(window: MainWindow) -> QRect:
    """Where the bust is seen: both bust points and the skin that lies up to 50 mm from them."""
    frame, viewport = window.session.frame, window.view.viewport
    assert frame is not None
    middles = [frame.stages.landmarks.position(f"bust_point_{side}") for side in ("left", "right")]
    points = np.concatenate([middles + np.array([0.0, 0.0, up]) for up in (-50.0, 50.0)])
    spots = viewport.scene.view.to_picture(points, viewport.width(), viewport.height())
    low, high = (QPoint(*map(int, each)) for each in (spots[:, :2].min(axis=0), spots[:, :2].max(axis=0)))
    return QRect(low, high).translated(viewport.mapTo(window, QPoint(0, 0)))
