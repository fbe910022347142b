"""A worn scan in the real window: read, compared, shown on the body, learnt from, taken back."""

from __future__ import annotations

import threading
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel, QScrollArea
from window_tools import PATIENCE, Script, run_main, settled, undrawn
from worn_pair import write_worn_pair

import app.gui.features.scan_comparison.controller
from app.gui.features.scan_comparison.page import ScanComparisonPage, ScanComparisonView
from app.gui.main_window import MainWindow
from app.i18n.catalog import using_language
from app.presenters.samples import sample_design
from app.presenters.scan_comparison import bust_text, parameter_title
from core.analysis.calibration.api import Residuals, ResidualSummary, calibrate, compare
from core.control_mesh.template import read_template
from core.document.line_notation import ready_made_lines
from core.errors import UserError
from core.messages import Message


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str, str]:
    """A project on a body of 2,100 corners, a scan with the garment on, and one of another body."""
    return write_worn_pair(tmp_path_factory.mktemp("worn"), hole=15.0)


def said(window: MainWindow) -> str:
    notice = window.notices.notice()
    return notice.sentence if notice is not None else ""


def test_a_worn_scan_is_compared_and_learnt_from(pair: tuple[str, str, str]) -> None:
    project, scan, _ = pair

    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        desk, page = window.scan_comparison_controller, window.scan_comparison_controller.page
        window.maps_controller.choose("worn")
        assert "fitting scan first" in window.maps_controller.legend.note.text()
        window.maps_controller.choose("")
        window.navigation.show_step("result")
        assert desk.door.isVisible(), "it is met under the measures"
        desk.door.click()
        assert window.inspector.panel() is page
        assert not page._compared.isVisible()
        desk.read(scan)
        yield lambda: bool(page.view.rows) and not page.view.faint
        area = page.findChild(QScrollArea)
        assert area is not None
        assert area.widget().width() <= area.viewport().width(), "nothing is cut off at the right"
        assert page.view.file == "worn.ply"
        heads = [each.text() for each in page.findChildren(QLabel) if each.isVisible()]
        assert "Residuals (prediction − scan) [mm]" in heads, "its figures have no unit of their own"
        assert page.view.lies.startswith("Registration: 100 % of the skin outside the reshaped region")
        frame = window.session.frame
        assert frame is not None
        values = window.scan_comparison_controller.values(frame)
        assert 0.8 < np.isfinite(values[: frame.stages.moving.count]).mean() < 1.0, "there is a hole"
        QTest.mouseClick(page.look, Qt.MouseButton.LeftButton)
        assert window.focusWidget() is not area, "no frame round all of the page"
        assert window.maps_controller.name == "worn"
        before = window.session.design
        page.calibrate.click()
        assert not page.calibrate.isEnabled(), "it is at work"
        yield lambda: bool(page.view.numbers)
        assert [row.title for row in page.view.numbers] == ["Line stiffness", "Rib-cage support"]
        assert page.view.numbers[1].told is False
        assert (
            page.surely.text()
            == page.view.surely
            == ("Determined to within 5 %: Line stiffness. Poorly determined (see ±): Rib-cage support.")
        )
        assert (page.apply.isVisible(), page.apply.property("kind")) == (True, "primary"), "one is told well"
        page.apply.click()
        yield lambda: settled(window)() and bool(page.view.rows) and not page.view.faint
        after = window.session.design
        assert after is not None
        assert after.calibration is not None
        assert after.line_stiffness == pytest.approx(6.0, rel=0.15)
        assert page.view.record.startswith("Calibration with worn.ply")
        assert not page.view.numbers, "what was found was of the design before"
        window.session.undo_stack.undo()
        assert window.session.design == before
        yield settled(window)
        assert page.view.record == ""

    assert run_main([project], script) == 0


def test_another_person_is_refused_and_an_edit_makes_the_comparison_old(pair: tuple[str, str, str]) -> None:
    project, scan, other = pair

    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        desk, page = window.scan_comparison_controller, window.scan_comparison_controller.page
        desk.show_page()
        desk.read(other)
        yield lambda: "does not match the first" in said(window)
        assert desk.worn is None
        desk.read(scan)
        assert "does not match" not in said(window), "the refusal was of the scan before"
        yield lambda: bool(page.view.rows) and not page.view.faint
        rms = page.view.rows[0].rms
        window.session.preview_line("mid-bust", 0.95)
        yield lambda: page.view.faint
        assert not page.calibrate.isEnabled()
        frame = window.session.frame
        assert frame is not None
        assert np.isnan(desk.values(frame)).all(), "nothing old lies on the body"
        window.session.commit_line("mid-bust", "Mid-bust", 0.95)
        yield lambda: settled(window)() and not page.view.faint
        assert page.view.rows[0].rms != rms
        page.thickness.entered.emit(2.0)
        yield lambda: bool(page.view.rows) and not page.view.faint
        assert page.view.rows[0].mean.startswith("+")
        window.session.undo_stack.setClean()

    assert run_main([project], script) == 0


def test_a_shape_that_has_settled_is_compared_while_turns_beside_it_go_on(pair: tuple[str, str, str]) -> None:
    project, scan, _ = pair

    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        window.scan_comparison_controller.read(scan)
        window.maps_controller.choose("worn")
        window.session.choose_control("adaptive")
        yield lambda: settled(window)() and not window.jobs.at_work()
        window.session.reset_lines()
        window.session.set_pace(60.0)

        def compared() -> bool:
            frame = window.session.frame
            assert frame is not None
            return bool(np.isfinite(window.scan_comparison_controller.values(frame)).any())

        yield lambda: not compared()
        yield compared
        frame = window.session.frame
        assert frame is not None
        assert frame.is_running, "the conventional force is still on its way"
        assert "out than measured" in window.maps_controller.legend.note.text()
        window.session.set_pace(None)
        window.session.undo_stack.setClean()

    assert run_main([project], script) == 0


def test_where_the_bust_points_are_is_said_without_a_sign() -> None:
    figures = ResidualSummary(0.0, 1.0, 2.0, 1.0)
    way = {"left": np.array([0.0, 0.7, -0.3]), "right": np.array([0.0, -0.2, 0.04])}
    words = bust_text(Residuals(np.zeros(3), figures, {}, way, {"left": 5.66, "right": 10.8}))
    assert words.startswith(
        "Bust point left: predicted 0.3 mm lower (±5.7 mm), 0.7 mm further back. Bust point right: "
    )
    assert "predicted 0.0 mm higher (±10.8 mm), 0.2 mm further forward." in words


def test_what_is_no_finding_is_not_offered_with_the_strongest_button(qapp: QApplication) -> None:
    page = ScanComparisonPage()
    for doubtful, kind in ((True, "secondary"), (False, "primary")):
        page.show_view(ScanComparisonView(better="0.9 → 0.8 mm", helped=True, doubtful=doubtful))
        assert not page.apply.isHidden(), "it can be taken all the same"
        assert page.apply.property("kind") == kind
    page.deleteLater()


def test_a_number_that_linked_lines_share_is_called_as_their_row() -> None:
    linked = replace(sample_design(), own_lines=ready_made_lines(read_template("168"))["straps"])
    apart = linked.with_line_settings(replace(linked.line_settings("strap left"), linked=False))
    assert parameter_title("stiffness of strap left", linked) == "Stiffness of Straps"
    assert parameter_title("length of strap left", linked) == "Length of Straps"
    assert parameter_title("stiffness of strap right", apart) == "Stiffness of Strap (right)"
    assert parameter_title("stiffness of mid-bust", linked) == "Stiffness of Mid-bust"
    with using_language("ja"):
        assert "左" not in parameter_title("stiffness of strap left", linked)


def test_what_is_begun_with_another_thickness_is_never_shown(
    pair: tuple[str, str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    project, scan, _ = pair
    gate = threading.Event()

    def held_up(*args: object, **told: object) -> object:
        gate.wait(PATIENCE)
        return compare(*args, **told)

    def failing(*args: object, **told: object) -> object:
        gate.wait(PATIENCE)
        if told["thickness"] == 2.0:
            raise UserError(Message("The worn scan shows too little."), Message("Scan the front too."))
        return calibrate(*args, **told)

    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        desk, page = window.scan_comparison_controller, window.scan_comparison_controller.page
        desk.show_page()
        gate.set()
        desk.read(scan)
        yield lambda: bool(page.view.rows) and not page.view.faint
        gate.clear()
        page.thickness.entered.emit(8.0)
        page.thickness.entered.emit(2.0)  # while it is compared with the first
        gate.set()
        yield lambda: bool(page.view.rows) and not page.view.faint
        assert 1.0 < float(page.view.rows[0].mean) < 3.0, "not that of 8 mm"
        gate.clear()
        page.calibrate.click()
        gate.set()
        yield lambda: "too little" in said(window)
        assert page.calibrate.isEnabled(), "it can be tried again"
        gate.clear()
        page.thickness.entered.emit(0.0)
        gate.set()
        yield lambda: page.view.ready
        gate.clear()
        page.calibrate.click()
        page.thickness.entered.emit(1.0)  # while numbers are sought for none
        gate.set()
        yield lambda: not window.jobs._threads and page.view.ready
        assert page.view.numbers == ()
        window.session.undo_stack.setClean()

    monkeypatch.setattr(app.gui.features.scan_comparison.controller, "compare", held_up)
    monkeypatch.setattr(app.gui.features.scan_comparison.controller, "calibrate", failing)
    assert run_main([project], script) == 0
