"""The quick start in the real window: from a scan file to the sheet and the saved project."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from garment_tools import at_rest, cut_rows
from pdf_tools import Pdf
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_main, settled, undrawn

from app.gui.main_window import MainWindow
from app.presenters.bust_shift import bust_shift, shift_between
from app.presenters.samples import FIRST_PRESET, STRAP, dressed_sample, sample_path
from core.document.design import ScanSource
from core.document.storage.project_file import open_project
from core.garment.cut_list import cut_list
from core.garment.match_shape import reached_points
from core.garment.pressure import pressure_limits
from core.garment.pressure_list import pressure_list
from core.pipeline.build import Stages, build
from tests.end_to_end.test_cups import pulled
from tests.end_to_end.test_scan import pull

BAND, SHORT = "under-bust", 0.80
"""The band, and how short it is tried in step 14 [1]."""

HIGH = 25.0
"""How high the cups are made in step 8 [mm]."""

DOCS = Path(__file__).parents[2] / "docs"

pytestmark = pytest.mark.usefixtures("empty_house", "own_data", "on_solid", "landmarks_known")


@pytest.fixture(autouse=True)
def answers(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, person: Path) -> None:
    """A customer's scan, and answers to the dialogs of files."""
    shutil.copy(person, tmp_path / "anna.ply")
    monkeypatch.setattr("app.gui.features.project.controller.ask_open", lambda *_: str(tmp_path / "anna.ply"))
    monkeypatch.setattr(
        "app.gui.features.project.controller.ask_save", lambda *_: str(tmp_path / "anna.busk")
    )
    monkeypatch.setattr("app.gui.features.report.controller.ask_save", lambda *_: str(tmp_path / "anna.pdf"))


@pytest.mark.usefixtures("first_tour")
def test_the_first_customer_as_the_guide_tells_it(tmp_path: Path) -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        yield from opened(window)
        yield from corrected(window)
        yield from dressed(window)
        yield from cut(window)
        yield from pressed(window)
        yield from printed(window, tmp_path)
        yield from kept(window, tmp_path)

    assert run_main([], script) == 0


def opened(window: MainWindow) -> Script:
    """Steps 1 to 3: the tour is there and skipped, the scan is opened and understood."""
    mark = window.start_controller.tour.mark
    yield mark.isVisible
    QTest.keyClick(mark, Qt.Key.Key_Escape)
    assert not mark.isVisible()
    window.actions_.open.trigger()
    yield lambda: window.session.design is not None and "anna" in window.session.design.scan.path
    yield settled(window)
    assert window.rail.current() == "scan", "unit and front are looked at first"
    assert window.inspector.isVisible()
    frame = window.session.frame
    assert frame is not None
    assert frame.stages.body.pose.unit == "mm"
    assert frame.stages.body.pose.front == "-y"
    assert frame.stages.design.active_lines() == set(), "a scan is opened with no line set"
    assert frame.stages.design.tissue == "solid"


def corrected(window: MainWindow) -> Script:
    """Steps 4 and 5: a pin is dragged, seen from the front."""
    window.rail.items["landmarks"].click()
    window.view.viewport.set_view("front")
    assert window.session.frame is not None
    before = window.session.frame.stages.landmarks.position("bust_point_left")
    pull(window, "bust_point_left", QPoint(0, -6))
    yield settled(window)
    assert window.session.frame is not None
    landmarks = window.session.frame.stages.landmarks
    assert landmarks.points["bust_point_left"].by_hand
    assert 2.0 < float(np.linalg.norm(landmarks.position("bust_point_left") - before)) < 25.0


def dressed(window: MainWindow) -> Script:
    """Steps 6 to 9: a bra is put on and lifts the bust; higher cups lift it more."""
    window.rail.items["lines"].click()
    menu = window.actions_.menus["presets"]
    menu.aboutToShow.emit()
    next(each for each in menu.actions() if each.text().startswith(FIRST_PRESET)).trigger()
    yield settled(window)
    assert window.session.design.active_elastics().keys() == {BAND, STRAP, "strap right"}
    assert window.session.frame is not None
    lift = bust_shift(window.session.frame).mean.up
    assert lift > 5.0
    pulled(window, "lift", HIGH)
    yield settled(window)
    assert window.session.frame is not None
    assert bust_shift(window.session.frame).mean.up > lift + 2.0
    # The word stands a while before another takes its place.
    yield lambda: window.strip.chip.state() not in ("pending", "bad")
    for shown in (1.0, 0.0):
        window.actions_.flip.trigger()
        assert window.view.compare.isVisible(), shown


def cut(window: MainWindow) -> Script:
    """Steps 11 and 12: how long to cut it."""
    window.navigation.show_panel("garment")
    yield at_rest(window)
    row = cut_rows(window)[STRAP]
    assert row.cut_mm
    assert window.garment.rows[STRAP].cut.text() == f"{row.cut_mm:,.0f}"


def pressed(window: MainWindow) -> Script:
    """Steps 13 and 14: the bra can be worn; a shorter band presses more and lifts no more."""
    desk = window.pressure_controller
    yield lambda: desk.shown is not None and at_rest(window)()
    assert window.session.frame is not None
    before = most(window)
    assert before < pressure_limits().amber_kpa
    lift = bust_shift(window.session.frame).mean.up
    window.lines_controller.commit_length(BAND, SHORT)
    yield lambda: at_rest(window)() and before < most(window) < pressure_limits().red_kpa
    assert abs(bust_shift(window.session.frame).mean.up - lift) < 0.1


def most(window: MainWindow) -> float:
    """The largest contact pressure [kPa]."""
    return max(row.max_kpa or 0.0 for row in window.pressure_controller.shown.rows)


def printed(window: MainWindow, folder: Path) -> Script:
    """Steps 15 to 17: the customer is named, the sheet saved."""
    desk = window.report_controller
    window.top.primary.click()
    desk.page.customer.setFocus()
    QTest.keyClicks(desk.page.customer, "Anna 0412")
    QTest.keyClick(desk.page.customer, Qt.Key.Key_Return)
    yield desk.page.does["pdf"].isEnabled
    desk.page.does["pdf"].click()
    text = Pdf(folder / "anna.pdf").text()
    assert "Anna 0412" in text
    for row in cut_rows(window).values():
        assert f"{row.cut_mm:,.0f}" in text
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert not desk.is_open


def kept(window: MainWindow, folder: Path) -> Script:
    """Step 18: the project is saved and opened again as it was left."""
    window.actions_.save.trigger()
    assert window.session.finish_saving()
    design = window.session.design
    assert open_project(folder / "anna.busk").customer == "Anna 0412"
    there = []
    window.session.opened.connect(there.append)
    window.session.open(str(folder / "anna.busk"))
    yield lambda: bool(there) and settled(window)()
    assert window.session.design.lines == design.lines
    assert window.session.design.placed == design.placed
    assert window.session.document.customer == "Anna 0412"


def test_the_figures_of_the_guide_are_those_of_its_steps() -> None:
    """Of steps 1 and 7 to 14, on the sample as the pictures show it."""
    design = replace(dressed_sample("person"), scan=ScanSource(str(sample_path("person"))))
    higher = replace(design, cup=replace(design.cup, lift=HIGH))
    first = build(design)
    worn, shorter = (build(each, first) for each in (higher, higher.with_line(BAND, SHORT)))
    row = next(each for each in cut_list(worn, reached_points(worn)).rows if each.line == STRAP)
    figures = [f"{row.cut_mm:.0f} mm", f"{100.0 * SHORT:.0f} %", f"{HIGH:.0f} mm", f"{lift(first):.1f} mm"]
    for each in (worn, shorter):
        most = max(each.max_kpa or 0.0 for each in pressure_list(each, reached_points(each)).rows)
        figures += [f"{lift(each):.1f} mm", f"{most:.1f} kPa"]
    for page in ("tutorial/quick-start.md", "ja/quick-start.md"):
        text = (DOCS / page).read_text("utf-8")
        assert [each for each in figures if each not in text] == []


def lift(stages: Stages) -> float:
    """How far the bust points stand above where they are at rest [mm]."""
    return shift_between(stages.rest_marks, stages.watch(reached_points(stages))).mean.up
