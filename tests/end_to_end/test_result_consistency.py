"""What the window says of a result, through the real main(): one number everywhere, and one word."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from window_tools import Script, run_bodiless, run_main, run_undrawn, settled

import app.gui.file_export
from app.gui.main_window import MainWindow
from app.gui.widgets.thumbnail_list import VIEW, ThumbnailRow
from app.i18n.catalog import number
from core.mechanics.mesh_quality import STRAINED_RANGE
from core.pipeline.frame import Frame

pytestmark = pytest.mark.usefixtures("empty_house")


def frame_of(window: MainWindow) -> Frame:
    frame = window.session.frame
    assert frame is not None
    return frame


def strip_says(window: MainWindow) -> dict[str, str]:
    window.throttled.flush()
    return {name.text(): value.text() for name, value in window.strip._pairs if name.text()}


def kept(window: MainWindow, place: int = 0) -> ThumbnailRow:
    row = window.history.snapshots.item(place).data(VIEW)
    assert isinstance(row, ThumbnailRow)
    return row


def title_of_b(window: MainWindow) -> list[str]:
    return window.view.panes.titles[1].text.split("\n")


def test_the_whole_window_tells_one_lift_that_of_the_bust_points() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.variants_controller.choose("B")
        window.lines_controller.commit_length("mid-bust", 0.9)
        yield settled(window)
        now, rest = frame_of(window).marks, frame_of(window).stages.rest_marks
        up = 0.5 * (
            now.bust_point_left_z - rest.bust_point_left_z + now.bust_point_right_z - rest.bust_point_right_z
        )
        forward = 0.5 * (now.bust_point_left_out - rest.bust_point_left_out)
        forward += 0.5 * (now.bust_point_right_out - rest.bust_point_right_out)
        assert now.apex_z - rest.apex_z > up + 3.0, "the foremost place wandered up: that is no lift"
        said = f"{up:.1f} mm up, {-forward:.1f} mm back"
        assert strip_says(window)["Bust point"] == said
        (main,) = (each for each in window.strip.height_plot.canvas.plotted.curves if each.role == "main")
        assert window.strip.height_plot.title.accessibleName() == "Bust point height mm"
        assert main.values[-1] == up
        window.navigation.show_step("result")
        height, forth = (row_of(window, f"Bust point, {each}") for each in ("height", "forward"))
        assert (height, forth) == (pytest.approx(up, abs=1e-9), pytest.approx(forward, abs=1e-9))
        yield lambda: window.history.snapshots.count() == 1
        assert kept(window).words[1] == f"Bust points: {said}"
        window.navigation.show_panel("variants")
        yield (
            lambda: (
                window.variants.view is not None and not {"", "pending"} & set(window.variants.view.levels)
            )
        )
        table = {row.label: row.figures[0].values[1] for row in window.variants.view.rows}
        assert (table["Bust point lift"], table["Bust point, forward"]) == (up, forward)
        window.variants_controller.flip_side_by_side()
        assert title_of_b(window) == [
            f"Variant B   {window.strip.chip.accessibleName()}",
            f"Bust points: {said}",
            "Mid-bust 90.0 %",
        ]
        window.sections_controller.set_on(True)
        assert window.sections_controller.panel.readout.text().startswith("Bust point left: ")

    run_bodiless([], script)


def all_judged(window: MainWindow) -> bool:
    view = window.variants.view
    return view is not None and not {"", "pending"} & set(view.levels)


def row_of(window: MainWindow, label: str) -> float | None:
    return next(row.change for row in window.result.rows if row.label == label)


@pytest.mark.usefixtures("fine_samples", "limits_sought")
def test_a_settled_body_that_is_strained_says_so_in_one_voice() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.throttled.flush()
        window.lines_controller.commit_length("mid-bust", 0.9)
        yield settled(window)
        window.throttled.flush()
        condition = frame_of(window).verdict.condition
        assert condition is not None
        assert condition.shortest < STRAINED_RANGE[0]
        yield lambda: window.strip.chip.state() in ("caution", "bad")
        overall = window.assessment_controller.of(frame_of(window))
        said = [message for message, _ in overall.reasons]
        assert any(each.startswith("Skin is compressed or stretched by over 20 %") for each in said)
        assert window.strip.hint.text() == overall.first, "the worst reason stands in the strip"
        assert "Converged, strained" in window.strip._turns.text(), "the run has its own word"
        looks = {"caution": "look", "bad": "bad"}[overall.level]
        assert {window.rail.items[step].state() for step in ("lines", "result")} == {looks}
        row = window.lines.rows["mid-bust"]
        window.selection.select_line("mid-bust")
        yield lambda: row.view.leeway is not None and not row.view.stale
        assert row.view.leeway.at(0.9).tone == "amber"
        assert row.details._figures[0][3].property("tone") == "warn", "the gap is told as the groove is"
        ratio = row.view.leeway.at(0.9).long + 0.005
        window.lines_controller.commit_length("mid-bust", ratio)
        yield settled(window)
        yield lambda: window.strip._turns.text().startswith("Converged · ")
        assert row.view.leeway.at(ratio).tone == "green"

    run_main([], script)


@pytest.mark.usefixtures("fine_samples")
def test_a_run_that_never_rests_is_no_result_and_has_a_way_out() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.variants_controller.choose("B")
        window.session.choose_control("conventional")
        window.lines_controller.commit_length("mid-bust", 0.6)
        yield settled(window)
        assert frame_of(window).verdict.state == "vibrating"
        notice = window.notices.notice()
        assert notice is not None
        assert "oscillates by ±3.7 mm" in notice.sentence
        assert strip_says(window)["Bust point"].endswith(" ± 3.7 mm")
        assert window.rail.items["result"].state() == "bad"
        window.navigation.show_panel("variants")
        yield (
            lambda: (
                window.variants.view is not None and not {"", "pending"} & set(window.variants.view.levels)
            )
        )
        table = {row.label: row.figures[0].values for row in window.variants.view.rows}
        assert table["Bust point lift"][0] is not None
        assert table["Bust point lift"][1] is None
        window.variants_controller.flip_side_by_side()
        assert title_of_b(window) == ["Variant B   Do not use", "Mid-bust 60.0 %"]
        window.navigation.show_step("result")
        assert "do not use these values" in window.result.doubt
        yield lambda: window.history.snapshots.count() >= 1
        assert kept(window).words == ("Do not use", "Not valid for production")
        assert kept(window).mark == ("bad", "warning-octagon")

        offered = [button.text() for button in window.notices.buttons]
        assert "Use adaptive" not in offered, "it would lead to a fold"
        window.session.choose_control("adaptive")
        yield settled(window)
        assert frame_of(window).verdict.motion == "settled"
        notice = window.notices.notice()
        assert notice is not None
        assert "overlaps itself" in f"{notice.sentence} {notice.hint}", "at 60 % it rests, and is no body"
        window.throttled.flush()
        assert window.rail.items["result"].state() == "bad", "its badge is as red as the word"
        assert window.session.undo_stack.undoText() == "Volume control: Adaptive"
        window.actions_.undo.trigger()
        yield settled(window)
        assert frame_of(window).verdict.state == "vibrating"
        notice = window.notices.notice()
        assert notice is not None
        assert "oscillates by" in notice.sentence, "it is told again"

    run_bodiless([], script)


def test_the_same_key_puts_variants_side_by_side_and_back() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        flip, button = window.variants_controller.beside, window.variants_controller.button
        assert not button.isVisible(), "there is one variant"
        window.variants_controller.choose("B")
        yield settled(window)
        assert button.isVisible()
        keys = Qt.Key.Key_V, Qt.KeyboardModifier.ShiftModifier
        QTest.keyClick(window, *keys)
        yield lambda: window.view.beside.way == "variants"
        assert flip.isChecked()
        QTest.keyClick(window, *keys)
        assert window.view.beside.way == "after"
        assert not flip.isChecked()
        button.click()
        assert window.view.beside.way == "variants", "the variants are known: they come at once"
        window.view.compare_by("wipe")
        assert not flip.isChecked()

    run_undrawn([], script)


def test_measures_say_from_where_they_count_and_leave_as_a_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "measures.csv"
    monkeypatch.setattr(app.gui.file_export, "ask_save", lambda *_: str(path))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("result")
        body, marks = frame_of(window).stages.body.mesh.vertices, frame_of(window).stages.rest_marks
        rows = {row.label: row for row in window.result.rows}
        assert all(row.reference for row in rows.values())
        above = rows["Bust point left, height"]
        assert above.before == pytest.approx(marks.bust_point_left_z - body[:, 2].min())
        line = frame_of(window).stages.model.lines[1]
        whole = rows["Mid-bust, full length"]
        assert (line.name, whole.before) == ("mid-bust", pytest.approx(line.whole_length))
        grown = frame_of(window).lengths["mid-bust"] - line.rest_length
        assert whole.change == pytest.approx(grown, abs=0.1)
        shown = [float(whole.written(each)) for each in (whole.before, whole.after)]
        assert whole.written(whole.change) == number(shown[1] - shown[0]), "the columns agree"
        window.result.table_requested.emit()
        heading, *table = csv.reader(path.read_text(encoding="utf-8-sig").splitlines())
        assert heading == ["Measurement", "Reference", "Unit", "Before", "After", "Change", "Notes"]
        assert [row[0] for row in table] == list(rows)
        cells = table[list(rows).index("Mid-bust, full length")]
        assert cells[2:] == ["mm", *(f"{each:.1f}" for each in (whole.before, whole.after, whole.change)), ""]
        window.result.copy_requested.emit()
        assert "\t".join(cells) + "\n" in QGuiApplication.clipboard().text()

    run_bodiless([], script)
