"""The sheet in the window, through the real main(): made, followed, named, spoken, given away."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from pdf_tools import Pdf
from PySide6.QtCore import Qt
from PySide6.QtPrintSupport import QPrinter
from PySide6.QtTest import QTest
from window_tools import Script, run_bodiless, run_undrawn, settled

from app.gui.main_window import MainWindow
from app.gui.widgets.thumbnail_list import VIEW
from app.i18n.catalog import language
from app.report.document import SHOTS
from app.report.painter import A4
from app.report.pdf_file import write_pdf
from core.measurements.table import before_after, measure_rows

pytestmark = pytest.mark.usefixtures("empty_house")


def made(window: MainWindow) -> Callable[[], bool]:
    """The sheet is there, and of the design that is shown."""
    return window.report_controller.page.does["pdf"].isEnabled


def test_the_sheet_takes_the_place_of_the_work_and_gives_it_back(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        assert not window.top.primary.isEnabled(), "no body is open yet"
        yield settled(window)
        desk, work = window.report_controller, window.pages.currentWidget()
        assert desk.action.shortcut().toString() == "Ctrl+P"
        window.top.primary.click()
        assert window.pages.currentWidget() is desk.page
        assert not made(window)(), "it is not there at once, and nothing waits for it"
        yield made(window)
        assert desk.handout is not None
        assert desk.pages is not None
        assert desk.pages.count == 2
        assert tuple(desk.handout.pictures) == SHOTS
        frame = window.session.frame
        assert frame is not None
        told = measure_rows(*before_after(frame.stages, frame.control_points))
        assert desk.handout.report.measures == tuple(told)
        leaf = desk.page.paper.leaves[0]
        shown, title = leaf.grab().toImage(), leaf.width() * 18.0 / A4[0]
        dark = sum(shown.pixelColor(x, round(title)).lightness() < 128 for x in range(shown.width() // 2))
        assert dark > 10, "the title is painted where it stands on paper"
        scroll = desk.page.paper.verticalScrollBar()
        yield lambda: scroll.maximum() > 0
        scroll.setValue(scroll.maximum())
        QTest.keyClick(window, Qt.Key.Key_Escape)
        assert window.pages.currentWidget() is work
        desk.open()
        assert scroll.value() == 0, "a sheet opens at its head, where a doubt stands"
        assert not desk.page.back.icon().isNull(), "an arrow says that it is no heading"
        desk.page.back.click()
        assert window.pages.currentWidget() is work

    assert run_bodiless([str(mannequin)], script) == 0


def test_the_sheet_follows_and_a_former_one_is_not_given_away(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.report_controller.open()
        yield made(window)
        former = window.report_controller.handout
        assert former is not None
        assert former.report.cuts.rows == ()
        window.session.commit_line("mid-bust", "Mid-bust", 0.96)
        assert not any(press.isEnabled() for press in window.report_controller.page.does.values())
        assert (
            window.report_controller.page.state.text()
            == "The report is created when the solver has converged."
        )
        yield made(window)
        sheet = window.report_controller.handout.report
        assert [row.line for row in sheet.cuts.rows] == ["mid-bust"]
        assert sheet.lift is not None
        frame = window.session.frame
        assert frame is not None
        lift = frame.marks.bust_point_left_z - frame.stages.rest_marks.bust_point_left_z
        assert sheet.lift.left_up == pytest.approx(lift, abs=0.1)
        window.session.commit_line("mid-bust", "Mid-bust", 0.9)
        yield settled(window)
        window.session.commit_line("mid-bust", "Mid-bust", 0.96)
        yield lambda: settled(window)() and made(window)()
        again = window.report_controller.handout.report
        assert again.turns == sheet.turns, "a garment is plotted from rest, not from the edit before"
        assert (again.lift, again.volume) == (sheet.lift, sheet.volume)
        for _ in range(2):
            window.actions_.undo.trigger()
        window.actions_.undo.trigger()
        yield made(window)
        assert window.report_controller.handout.report.cuts.rows == ()

    assert run_bodiless([str(mannequin)], script) == 0


def test_what_came_of_an_edit_on_the_sheet_is_kept_with_its_picture(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.report_controller.open()
        window.session.edit(lambda design: replace(design, customer="Anna"), "Customer Anna")
        yield made(window)
        QTest.qWait(600)  # longer than a result must have stood
        window.report_controller.leave()
        kept = window.history.snapshots
        yield lambda: kept.count() == 1
        assert kept.item(0).data(VIEW).picture is not None

    assert run_bodiless([str(mannequin)], script) == 0


def test_the_customer_is_one_step_and_measures_nothing_again(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    measured = []
    real = before_after
    monkeypatch.setattr(
        "core.export.report_data.before_after", lambda *all_: measured.append(1) or real(*all_)
    )

    def script(window: MainWindow) -> Script:
        yield settled(window)
        desk, page = window.report_controller, window.report_controller.page
        desk.open()
        yield made(window)
        page.customer.setFocus()
        QTest.keyClicks(page.customer, "Anna 0412")
        QTest.keyClick(page.customer, Qt.Key.Key_Return)
        assert window.session.design is not None
        assert window.session.design.customer == "Anna 0412"
        yield lambda: made(window)() and desk.handout.report.heading.customer == "Anna 0412"
        assert window.session.undo_stack.undoText() == "Customer Anna 0412"
        window.session.show_variant("B")
        yield lambda: made(window)() and desk.handout.report.heading.variant == "B"
        assert desk.handout.report.heading.customer == "Anna 0412", "it is of every variant"
        for _ in range(2):
            window.actions_.undo.trigger()
        yield lambda: made(window)() and desk.handout.report.heading.customer == ""
        assert page.customer.text() == ""
        assert len(measured) == 1

    assert run_bodiless([str(mannequin)], script) == 0


def test_a_name_that_is_typed_goes_out_with_the_next_press(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def place(parent: object, title: str, name: str, kinds: str, ending: str) -> str:
        return str(tmp_path / f"sheet{ending}")

    monkeypatch.setattr("app.gui.features.report.controller.ask_save", place)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        desk, page = window.report_controller, window.report_controller.page
        desk.open()
        page.customer.setFocus()
        QTest.keyClicks(page.customer, "Anna")
        QTest.keyClick(page.customer, Qt.Key.Key_Return)
        yield made(window)
        assert desk.handout.report.heading.customer == "Anna", "it was named while it was being made"
        page.customer.selectAll()
        QTest.keyClicks(page.customer, "Berta")
        for what in ("pdf", "json", "csv"):
            QTest.mouseClick(page.does[what], Qt.MouseButton.LeftButton)
            yield made(window)
        assert window.focusWidget() is page.customer, "else the field would have told its name by itself"
        assert "Berta" in Pdf(tmp_path / "sheet.pdf").text()
        assert json.loads((tmp_path / "sheet.json").read_text("utf-8"))["heading"]["customer"] == "Berta"
        assert "Berta" in (tmp_path / "sheet.csv").read_text("utf-8-sig")
        assert "Anna" not in Pdf(tmp_path / "sheet.pdf").text()
        assert window.session.design is not None
        assert window.session.design.customer == "Berta"

    assert run_bodiless([str(mannequin)], script) == 0


def test_the_sheet_is_saved_in_another_language(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def place(parent: object, title: str, name: str, kinds: str, ending: str) -> str:
        return str(tmp_path / f"sheet{ending}")

    monkeypatch.setattr("app.gui.features.report.controller.ask_save", place)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        desk, page = window.report_controller, window.report_controller.page
        desk.open()
        yield made(window)
        page.languages.button("ja").click()
        assert language() == "en", "the window speaks on as it did"
        for what in ("pdf", "json", "csv"):
            page.does[what].click()
        pdf = Pdf(tmp_path / "sheet.pdf")
        assert "補整レポート" in pdf.text()
        assert len(pdf.sizes) == 2
        data = json.loads((tmp_path / "sheet.json").read_text("utf-8"))
        assert data["measures"] == desk.handout.report.as_data()["measures"], "the file is in English"
        bust = next(row["before"] for row in data["measures"] if row["key"] == "bust_girth")
        assert f"{bust:.1f}" in pdf.text()
        assert (tmp_path / "sheet.csv").read_text("utf-8-sig").startswith("section,key,title")

    assert run_bodiless([str(mannequin)], script) == 0


def test_the_printer_gets_the_same_pages(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Dialog:
        def __init__(self, printer: QPrinter, parent: object) -> None:
            printer.setOutputFormat(QPrinter.OutputFormat.PdfFormat)
            printer.setOutputFileName(str(tmp_path / "printed.pdf"))

        def exec(self) -> int:
            return 1

    monkeypatch.setattr("app.gui.file_export.QPrintDialog", Dialog)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.report_controller.open()
        yield made(window)
        window.report_controller.page.does["print"].click()
        printed = Pdf(tmp_path / "printed.pdf")
        write_pdf(tmp_path / "written.pdf", window.report_controller.pages, "sheet")
        written = Pdf(tmp_path / "written.pdf")
        assert printed.sizes == written.sizes == [(210, 297)] * 2
        assert printed.text() == written.text()
        first, other = (pdf.pieces(0)[0] for pdf in (printed, written))
        assert abs(first.left - other.left) < 0.3
        assert abs(first.top - other.top) < 0.3

    assert run_bodiless([str(mannequin)], script) == 0


def test_only_the_pages_that_were_chosen_are_printed(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Dialog:
        def __init__(self, printer: QPrinter, parent: object) -> None:
            printer.setOutputFormat(QPrinter.OutputFormat.PdfFormat)
            printer.setOutputFileName(str(tmp_path / "printed.pdf"))
            printer.setPrintRange(QPrinter.PrintRange.PageRange)
            printer.setFromTo(2, 2)

        def exec(self) -> int:
            return 1

    monkeypatch.setattr("app.gui.file_export.QPrintDialog", Dialog)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.report_controller.open()
        yield made(window)
        window.report_controller.page.does["print"].click()
        printed = Pdf(tmp_path / "printed.pdf")
        write_pdf(tmp_path / "written.pdf", window.report_controller.pages, "sheet")
        assert printed.sizes == [(210, 297)]
        second = [piece.text for piece in Pdf(tmp_path / "written.pdf").pieces(1)]
        assert [piece.text for piece in printed.pieces(0)] == second

    assert run_bodiless([str(mannequin)], script) == 0


def test_the_sheet_comes_without_pictures_where_they_cannot_be_drawn(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object, **__: object) -> None:
        raise RuntimeError("no graphics")

    monkeypatch.setattr("app.report.images.OffscreenRenderer", fails)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.report_controller.open()
        yield made(window)
        assert window.report_controller.handout is not None
        assert window.report_controller.handout.pictures == {}

    assert run_bodiless([str(mannequin)], script) == 0


def test_the_window_closes_while_the_sheet_is_being_made(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.report_controller.open()
        yield lambda: bool(window.jobs.at_work())

    assert run_undrawn([str(mannequin)], script) == 0
