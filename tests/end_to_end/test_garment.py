"""The garment in the window: elastics are chosen, the body stays, and the lengths to cut are the core's."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from garment_tools import at_rest, choose, chooser_of, cut_rows, made_of, mark, pick
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from window_tools import Script, run_bodiless, settled

from app.gui import file_export as tables
from app.gui.features.garment.elastic_assignment import LIFT_TOLD
from app.gui.main_window import MainWindow
from app.i18n.catalog import number
from app.presenters.bust_shift import bust_shift
from core.garment.elastic_options import FIRST_STRETCH, KEEP_CUT
from core.pipeline.warnings import immovable_lines

pytestmark = pytest.mark.usefixtures("empty_house", "own_data", "few_elastics")

SAME = 0.2
"""By how much a reached length may differ once an elastic is chosen, as the window states [mm]."""


def test_an_elastic_is_chosen_and_the_length_to_cut_is_that_of_the_core() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.lines_controller.commit_length("full-bust", 0.985)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        garment, before = window.garment, cut_rows(window)
        assert garment.rows["mid-bust"].cut.text() == "–"
        assert garment.rows["mid-bust"].tension.text() == number(before["mid-bust"].tension_n or 0.0, 1)
        steps, bare, made = window.session.undo_stack.count(), window.session.design, list[str]()
        for line, elastic in (
            ("mid-bust", "Strap 15 mm"),
            ("full-bust", "Bra band, plush back 12 mm"),
            ("under-bust", "Bra band, plush back 18 mm"),
        ):
            yield from choose(window, line, elastic)
            made.append(line)
            yield made_of(window, *made)
        after = cut_rows(window)
        assert window.session.undo_stack.count() == steps + 3
        assert window.session.undo_stack.undoText() == "Under-bust: Bra band, plush back 18 mm"
        for line in ("mid-bust", "full-bust"):
            assert after[line].reached_front_mm == pytest.approx(before[line].reached_front_mm, abs=SAME)
        for line, row in after.items():
            shown = garment.rows[line]
            assert shown.cut.text() == number(row.cut_mm or 0.0, 0)
            assert shown.tension.text() == number(row.tension_n or 0.0, 1)
            assert row.elastic in shown.elastic.accessibleName()
        assert (
            garment.rows["mid-bust"].stretch.text() == f"+{100 * (after['mid-bust'].elongation or 0.0):.0f} %"
        )
        window.session.undo_stack.setIndex(steps)
        yield at_rest(window)
        assert window.session.design == bare
        assert garment.rows["mid-bust"].cut.text() == "–"

    run_bodiless([], script)


def test_one_elastic_is_chosen_for_all_and_taken_off_again_without_moving_the_body() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.lines_controller.commit_length("full-bust", 0.985)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        before = cut_rows(window)
        assert window.garment.offer.isVisible()
        window.garment.offer.requested.emit()
        yield from pick(window, "Strap 15 mm")
        yield made_of(window, "mid-bust", "full-bust", "under-bust")
        assert not window.garment.offer.isVisible()
        assert window.session.undo_stack.undoText() == "All lines: Strap 15 mm"
        assert cut_rows(window)["under-bust"].elongation == pytest.approx(FIRST_STRETCH)
        yield from choose(window, "mid-bust", "No elastic")
        yield made_of(window, "full-bust", "under-bust")
        window.garment.again.click()
        assert chooser_of(window).current == -1, "they are of several"
        yield from pick(window, "Bra band, plush back 18 mm")
        yield made_of(window, "mid-bust", "full-bust", "under-bust")
        assert window.session.undo_stack.undoText() == "All lines: Bra band, plush back 18 mm"
        window.session.undo_stack.undo()
        yield made_of(window, "full-bust", "under-bust")
        yield from choose(window, "full-bust", "No elastic")
        yield made_of(window, "under-bust")
        design = window.session.design
        assert design is not None
        assert design.ratio("full-bust") == pytest.approx(0.985, abs=1e-3)
        after = cut_rows(window)
        for name, row in before.items():
            assert after[name].reached_front_mm == pytest.approx(row.reached_front_mm, abs=SAME)

    run_bodiless([], script)


def test_a_lift_that_goes_with_the_elastic_is_told() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.add_lines_controller.add("straps")
        window.lines_controller.commit_length("strap left", 0.986)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        assert window.session.frame is not None
        before = bust_shift(window.session.frame).mean.up
        yield from choose(window, "strap left", "Strap 15 mm")
        yield made_of(window, "strap left", "strap right")
        after, notice = bust_shift(window.session.frame).mean.up, window.notices.notice()
        assert notice is not None
        assert abs(after - before) >= LIFT_TOLD
        assert notice.tone == "warn"
        told = [float(value) for value in re.findall(r"([\d.]+) mm up", notice.hint)]
        assert told == pytest.approx([before, after], abs=0.15)

    run_bodiless([], script)


def test_the_other_meaning_keeps_the_length_to_cut_and_moves_the_body() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("garment")
        yield from choose(window, "mid-bust", "Strap 15 mm")
        yield made_of(window, "mid-bust")
        first, design = cut_rows(window)["mid-bust"], window.session.design
        assert design is not None
        window.garment.rows["mid-bust"].elastic.click()
        chooser_of(window).modes.button(KEEP_CUT).click()
        yield from pick(window, "Picot edge 8 mm")
        yield lambda: "Picot" in cut_rows(window)["mid-bust"].elastic
        yield at_rest(window)
        row = cut_rows(window)["mid-bust"]
        assert window.session.design is not None
        assert window.session.design.ratio("mid-bust") == design.ratio("mid-bust")
        assert row.reached_front_mm > first.reached_front_mm + 1.0
        assert (row.tension_n or 0.0) < 0.7 * (first.tension_n or 0.0)

    run_bodiless([], script)


def test_a_band_on_the_rib_cage_is_cut_as_far_stretched_as_the_designer_says() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.lines_controller.commit_length("mid-bust", 1.0)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        assert list(window.garment.rows) == ["under-bust"]
        assert window.garment.nothing.isVisible()
        yield from choose(window, "under-bust", "Bra band, plush back 18 mm")
        yield made_of(window, "under-bust")
        row = window.garment.rows["under-bust"]
        assert row.set_stretch.isVisible()
        told = window.lines.rows["under-bust"].note.text()
        assert told.startswith("Elastic: Bra band, plush back 18 mm. The line does not move the body")
        frame = window.session.frame
        assert frame is not None
        assert immovable_lines(frame.stages) == [], "an elastic is there to be cut, not measured by mistake"
        row.set_stretch.setFocus()
        row.set_stretch.selectAll()
        QTest.keyClicks(row.set_stretch, "30")
        QTest.keyClick(row.set_stretch, Qt.Key.Key_Return)
        yield at_rest(window)
        cut = cut_rows(window)["under-bust"]
        assert cut.elongation == pytest.approx(0.3)
        assert cut.cut_mm == pytest.approx(cut.reached_whole_mm / 1.3 + 25.0)
        assert row.cut.text() == number(cut.cut_mm or 0.0, 0)
        window.activateWindow()
        yield window.isActiveWindow
        row.set_stretch.setFocus()
        QTest.keyClick(row.set_stretch, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
        yield at_rest(window)
        assert cut_rows(window)["under-bust"].elongation == pytest.approx(FIRST_STRETCH), "the edit is undone"
        assert row.set_stretch.text() == "+20"
        window.session.reset_lines()
        yield at_rest(window)
        assert row.cut.text() == "–"
        assert row.elastic.words == "Bra band, plush back 18 mm"
        yield from choose(window, "under-bust", "Bra band, plush back 18 mm")
        yield made_of(window, "under-bust")
        yield from choose(window, "under-bust", "No elastic")
        yield made_of(window)
        assert window.session.design is not None
        assert not window.session.design.active_lines(), "what holds nothing is not worn"

    run_bodiless([], script)


def test_a_locked_line_stays_what_it_is() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("garment")
        window.lines_controller.decide("mid-bust", "locked", True)
        yield at_rest(window)
        before = window.session.design
        window.garment.rows["mid-bust"].elastic.click()
        yield from mark(window, "Strap 15 mm")
        assert chooser_of(window).advice.text() == "The line mid-bust is locked. Unlock the line first."
        assert not chooser_of(window).use.isEnabled()
        chooser_of(window).reject()
        assert window.session.design is before

    run_bodiless([], script)


def test_newtons_go_with_the_stiffness_of_tissue_and_the_list_leaves_as_a_table(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        before = cut_rows(window)["mid-bust"].tension_n or 0.0
        field = window.garment.tissue.field
        window.lines_controller.decide("mid-bust", "title", "Middle")
        yield at_rest(window)
        window.activateWindow()
        yield window.isActiveWindow
        field.setFocus()
        field.setText("9999")
        field.setModified(True)
        QTest.keyClick(field, Qt.Key.Key_Return)
        assert "50 to 2000" in field.accessibleDescription()
        window.actions_.undo.trigger()
        assert (field.text(), field.accessibleDescription()) == ("530", ""), "it tells the design's again"
        yield at_rest(window)
        field.setText("1060")
        field.setModified(True)
        QTest.keyClick(field, Qt.Key.Key_Return)
        yield at_rest(window)
        assert cut_rows(window)["mid-bust"].tension_n == pytest.approx(
            2.0 * before, rel=2e-3
        )  # as far as turns settle
        assert "1060" in window.garment.tissue.notes.text()
        window.garment.copy_requested.emit()
        heading, row = QGuiApplication.clipboard().text().splitlines()
        told = row.split("\t")[heading.split("\t").index("Tension N")]
        assert told == f"{cut_rows(window)['mid-bust'].tension_n:.1f}"
        window.session.preview_line("mid-bust", 0.9)
        yield lambda: window.garment.stale
        window.garment.copy_requested.emit()
        copied = QGuiApplication.clipboard().text().splitlines()[1].split("\t")
        assert copied[heading.split("\t").index("Tension N")] == told, "of a body at rest alone"
        path = tmp_path / "cuts.csv"
        monkeypatch.setattr(tables, "ask_save", lambda *_: str(path))
        window.garment.table_requested.emit()
        assert path.read_text("utf-8-sig").splitlines()[0].split(",") == heading.split("\t")

    run_bodiless([], script)
