"""Elastics of one's own in the window: brought in, refused, taken away, handed on; and all by keyboard."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from garment_tools import at_rest, choose, chooser_of, cut_rows, made_of
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from window_tools import Script, run_bodiless, settled

from app.gui.features.garment import elastics_controller as elastics_desk
from app.gui.main_window import MainWindow
from core.document.elastic import Elastic
from core.garment.elastic_csv import TEMPLATE
from core.garment.elastic_library import read_elastic, save_elastic, user_elastics, user_folder

pytestmark = pytest.mark.usefixtures("empty_house", "own_data", "few_elastics")


def test_tables_of_ones_own_are_brought_in_or_refused_and_taken_away(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    good, bad, empty = (tmp_path / name for name in ("good.csv", "bad.csv", "empty.csv"))
    good.write_text("# name: Roll 7\n# width_mm: 12\nelongation %,force N\n20,1.3\n40,2.5\n80,4.9\n")
    bad.write_text("# name: Roll 8\n# width_mm: 12\nelongation %,force N\n20,1.3\n40,much\n")
    chosen = [bad, good, empty]

    def script(window: MainWindow) -> Script:
        yield settled(window)
        monkeypatch.setattr(elastics_desk, "ask_file", lambda *_: str(chosen[0]))
        monkeypatch.setattr(elastics_desk, "ask_save", lambda *_: str(empty))
        monkeypatch.setattr(elastics_desk, "ask", lambda *_: "delete")
        window.garment.elastics_requested.emit()
        sheet = window.elastics_controller.sheet
        assert sheet is not None
        yield sheet.isVisible
        shipped = sheet.table.topLevelItemCount()
        assert not sheet.delete.isEnabled()
        sheet.import_requested.emit()
        refusal = sheet.notices.notice()
        assert refusal is not None
        assert "Row 5 of the table Roll 8 does not contain two numbers" in str(refusal.sentence)
        assert not user_folder().exists()
        chosen[0] = good
        sheet.import_requested.emit()
        assert sheet.marked == "Roll 7"
        notice = sheet.notices.notice()
        assert notice is not None
        assert "no seam allowance: 20 mm is added to each cut length" in notice.hint
        assert sheet.delete.isEnabled()
        assert sheet.views["Roll 7"].forces == ("1.3", "2.5", "3.7", "4.9")
        assert "4.9 N at 80 %" in sheet.curve.accessibleName()
        assert sheet.table.topLevelItemCount() == shipped + 1
        sheet.export_requested.emit("Roll 7")
        assert read_elastic(empty) == read_elastic(good)
        sheet.template_requested.emit()
        assert empty.read_text("utf-8-sig") == TEMPLATE
        chosen[0] = empty
        sheet.import_requested.emit()
        refusal = sheet.notices.notice()
        assert refusal is not None
        assert "Row 6" in str(refusal.sentence), "a table that is not filled in is none"
        sheet.table.mark("Roll 7")
        sheet.delete.click()
        assert "Roll 7" not in sheet.views
        assert user_elastics() == ([], [])
        sheet.reject()
        yield lambda: window.elastics_controller.sheet is None

    run_bodiless([], script)


def test_an_own_elastic_travels_with_its_project_to_where_nobody_has_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    project, cut = tmp_path / "mine.busk", []

    def save(window: MainWindow) -> Script:
        save_elastic(Elastic("Roll 9", 14.0, ((0.0, 0.0), (0.4, 5.2), (0.9, 14.0)), 18.0, "mine", False))
        yield settled(window)
        window.navigation.show_panel("garment")
        yield from choose(window, "mid-bust", "Roll 9")
        yield made_of(window, "mid-bust")
        cut.append(window.garment.rows["mid-bust"].cut.text())
        window.session.save(str(project), None)
        assert window.session.finish_saving()

    def reopen(window: MainWindow) -> Script:
        assert not user_folder().exists()
        yield settled(window)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        row = window.garment.rows["mid-bust"]
        assert row.elastic.words == "Roll 9"
        assert row.cut.text() == cut[0]
        row.elastic.click()
        chooser = chooser_of(window)
        assert chooser.views()[chooser.current].title == "Roll 9, in this project"
        chooser.reject()

    run_bodiless([], save)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "elsewhere"))
    run_bodiless([str(project)], reopen)


def test_the_keyboard_alone_chooses_an_elastic() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        window.inspector.tabs.button("garment").click()
        yield at_rest(window)
        pull = window.garment.rows["mid-bust"].elastic
        window.inspector.tabs.button("garment").setFocus()
        for _ in range(8):
            if QApplication.focusWidget() is not pull:
                window.focusNextPrevChild(True)
        assert QApplication.focusWidget() is pull
        assert pull.accessibleName() == "Mid-bust: elastic, Choose elastic…"
        QTest.keyClick(pull, Qt.Key.Key_Return)
        table = chooser_of(window).table
        yield table.hasFocus
        yield lambda: not window.jobs.at_work()
        while chooser_of(window).views()[chooser_of(window).current].title != "Strap 15 mm":
            QTest.keyClick(table, Qt.Key.Key_Down)
        QTest.keyClick(table, Qt.Key.Key_Return)
        yield made_of(window, "mid-bust")
        assert window.garment.rows["mid-bust"].elastic.words == "Strap 15 mm"

    run_bodiless([], script)


def test_an_elastic_beyond_its_table_is_told_in_a_drag_and_anew_at_the_next_edit() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("garment")
        yield from choose(window, "mid-bust", "Strap 15 mm")
        yield made_of(window, "mid-bust")
        made = window.session.design
        window.notices.clear()
        window.session.preview_line("mid-bust", 0.52)
        yield lambda: window.notices.notice() is not None
        window.session.cancel_preview()
        yield at_rest(window)
        window.notices.clear()
        window.lines_controller.commit_length("mid-bust", 0.52)
        yield lambda: window.notices.notice() is not None
        notice = window.notices.notice()
        assert notice is not None
        assert "the table of the elastic ends at 70 %" in notice.sentence
        yield at_rest(window)
        assert window.session.design == made

    run_bodiless([], script)


def test_a_linked_lines_is_made_of_the_same_in_one_step() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.add_lines_controller.add("straps")
        window.lines_controller.commit_length("strap left", 0.9915)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        steps, before = window.session.undo_stack.count(), cut_rows(window)
        yield from choose(window, "strap right", "Strap 12 mm")
        yield made_of(window, "strap left", "strap right")
        assert window.session.undo_stack.count() == steps + 1
        assert window.session.undo_stack.undoText() == "Straps: Strap 12 mm"
        design = window.session.design
        assert design is not None
        assert design.linked_lines("strap left") == ("strap left", "strap right")
        for name, row in cut_rows(window).items():
            assert row.reached_front_mm == pytest.approx(before[name].reached_front_mm, abs=0.2)
        assert window.garment.rows["strap left"].elastic.words == "Strap 12 mm"

    run_bodiless([], script)


def test_one_that_is_called_as_ours_gets_a_name_of_its_own_and_none_is_called_measured_without_a_source(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    table = tmp_path / "strap.csv"
    table.write_text("# name: Strap 15 mm\n# width_mm: 15\nelongation %,force N\n20,2.6\n80,9.8\n")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        monkeypatch.setattr(elastics_desk, "ask_file", lambda *_: str(table))
        window.garment.elastics_requested.emit()
        sheet = window.elastics_controller.sheet
        assert sheet is not None
        yield sheet.isVisible
        sheet.import_requested.emit()
        assert sheet.marked == "Strap 15 mm, custom"
        assert not sheet.views["Strap 15 mm"].own
        assert sheet.mark.text() == "Source of the measurement unknown"
        sheet.table.mark("Strap 15 mm")
        assert sheet.mark.text() == "Estimate, not measured"
        sheet.reject()
        yield lambda: window.elastics_controller.sheet is None
        window.navigation.show_panel("garment")
        yield from choose(window, "mid-bust", "Strap 15 mm, custom")
        yield made_of(window, "mid-bust")
        # Another one of that name, as a newer table has it: the project keeps its own.
        save_elastic(replace(user_elastics()[0][0], curve=((0.0, 0.0), (0.4, 5.0), (0.9, 12.0))))
        window.garment.rows["mid-bust"].elastic.click()
        chooser = chooser_of(window)
        assert "Strap 15 mm, custom" in [each.title for each in chooser.views()]
        assert chooser.views()[chooser.current].title == "Strap 15 mm, custom, from this project"
        chooser.reject()

    run_bodiless([], script)
