"""Own lines in the real window: added ready made or point by point, shortened, saved and removed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot
from window_tools import Script, drag, points, run_bodiless, run_undrawn, settled

from app.gui.features.lines import add_lines as line_maker
from app.gui.features.lines.path_dialog import LineDialog
from app.gui.main_window import MainWindow
from core.control_mesh.template import read_template
from core.document.line_notation import parse_line, ready_made_lines
from core.document.lines import CustomLine
from core.pipeline.build import build

BIG = read_template("168")

pytestmark = pytest.mark.usefixtures("empty_house")


def test_slings_are_listed_drawn_shortened_and_removed() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        at_start, bands = points(window).copy(), window.view.viewport.scene.bands
        window.actions_.add_lines["slings"].trigger()
        yield lambda: "sling left" in window.lines.rows and window.is_settled()
        assert list(window.lines.rows)[:3] == ["full-bust", "mid-bust", "under-bust"]
        assert "sling left" in bands.names
        assert window.view.selected_line == "sling left"
        assert window.session.undo_stack.undoText() == "Slings added"
        assert np.abs(points(window) - at_start).max() < 0.2, "at 100 % they do not pull"
        led = replace(window.session.design.own_lines[0], points=(35, 48))
        window.session.edit(lambda design: design.with_custom_line(led), "led elsewhere")
        window.actions_.add_lines["slings"].trigger()
        assert window.session.design.own_lines[0] == led, "what was led elsewhere is not added over"
        window.actions_.undo.trigger()
        window.lines.length_committed.emit("sling left", 0.94)
        yield settled(window)
        frame = window.session.frame
        assert frame is not None
        row = window.lines.rows["sling left"]
        assert row.view.own
        assert 0.94 * row.view.rest_mm < (row.view.reached_mm or 0.0) < 0.97 * row.view.rest_mm
        assert frame.marks.bust_point_left_z > frame.stages.rest_marks.bust_point_left_z + 1.0
        assert window.view.viewport._labels.band[1] == "Sling left 94.0 %"
        row.details._tools["remove"].click()
        yield lambda: "sling left" not in window.lines.rows and window.is_settled()
        assert not {"sling left", "sling right"} & set(bands.names)
        assert np.abs(points(window) - at_start).max() < 0.2
        window.actions_.undo.trigger()
        yield lambda: "sling left" in window.lines.rows
        window.selection.select_line("sling right")
        window.activateWindow()
        yield window.isActiveWindow
        window.lines.rows["sling left"].slider.setFocus()
        QTest.keyClick(window.lines.rows["sling left"].slider, Qt.Key.Key_Delete)
        yield lambda: "sling left" not in window.lines.rows

    run_undrawn([], script)


def test_a_line_goes_through_the_points_that_are_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    answers = [parse_line("v=r6c-3,r3c0,r6c3", BIG), parse_line("edge=r6c-2:r6c2", BIG), None]
    monkeypatch.setattr(line_maker, "ask_own_line", lambda *_: answers.pop(0))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.actions_.own_line.trigger()
        yield lambda: "v" in window.lines.rows and window.is_settled()
        assert window.session.design.own_lines[0].points == (81, 45, 87)
        window.actions_.own_line.trigger()
        yield lambda: "edge" in window.lines.rows
        assert not window.lines.rows["edge"].view.constrained
        assert window.lines.rows["edge"].note.text() == "On fixed points: measured only."
        window.actions_.own_line.trigger()
        assert window.session.undo_stack.count() == 2
        assert window.session.save(str(tmp_path / "v.busk"), None)

    def again(window: MainWindow) -> Script:
        yield settled(window)
        assert list(window.lines.rows)[-2:] == ["v", "edge"]
        assert {"v", "edge"} <= set(window.view.viewport.scene.bands.names)

    run_undrawn([], script)
    run_undrawn([str(tmp_path / "v.busk")], again)


def test_a_line_is_drawn_from_point_to_point(qtbot: QtBot) -> None:
    parent = QWidget()
    qtbot.addWidget(parent)
    dialog = LineDialog(parent, BIG, {"mid-bust", "line 1"})

    def press(*places: str) -> None:
        for place in places:
            at = dialog.map.place(parse_line(f"x={place},0", BIG).points[0]).toPoint()
            QTest.mouseClick(dialog.map, Qt.MouseButton.LeftButton, pos=at)

    assert dialog.name.text() == "line 2"
    press("r2c3")
    assert dialog.line is None
    press("r3c3", "r4c2")
    assert dialog.line == CustomLine("line 2", (35, 48, 60))
    dialog.ends.button("closed").click()
    assert dialog.line == CustomLine("line 2", (35, 48, 60), closed=True)
    press("r4c2", "r4c4", "r4c3")
    assert dialog.points.text() == "r2c3, r3c3, r4c4, r4c3"
    dialog.name.setText("")
    QTest.keyClicks(dialog.name, "mid-bust")
    assert dialog.line is None
    assert dialog._said.text() == "A line of that name already exists."
    dialog.points.clear()
    QTest.keyClicks(dialog.points, "r9c9, 3")
    assert "no position 'r9c9'" in dialog._said.text()


def test_the_accumulating_force_can_be_chosen() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.actions_.controls["accumulating"].trigger()
        yield settled(window)
        assert set(window.session.frame.tracks) == {"adaptive", "conventional", "accumulating"}
        assert window.session.frame.verdict.state == "settled"
        window.throttled.flush()
        segment = window.strip._segment
        assert not any(
            segment.button(name).isChecked() for name in ("adaptive", "conventional", "none", "exact")
        )
        segment.button("exact").click()
        assert window.session.design.volume == "exact"

    run_bodiless([], script)


@pytest.mark.parametrize("name", ["168", "120"])
def test_ready_made_lines_pull_on_their_own_side_of_every_template(name: str, built) -> None:
    template = read_template(name)
    for kind, pair in ready_made_lines(template).items():
        for line, sign in zip(pair, (1, -1), strict=True):
            columns = template.column[list(line.points)] * sign
            assert columns.min() >= 0, kind
            assert template.free[list(line.points)].any()
            assert line.closed == (kind == "rings")
            if not line.closed:
                assert template.fixed[line.points[0]] or template.fixed[line.points[-1]]
        left, right = (template.column[list(line.points)] for line in pair)
        assert np.array_equal(left, -right)
    design = built("mannequin").design.with_template(name)
    for pair in ready_made_lines(template).values():
        for line in pair:
            design = design.with_custom_line(line)
    assert len(build(design, built("mannequin")).model.lines) == 3 + 8


def test_a_handle_in_the_hand_stays_while_lines_come_and_its_preview_goes_with_its_line() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        session, row = window.session, window.lines.rows["mid-bust"]
        drag(window, "mid-bust", -20, release=False)
        window.actions_.add_lines["straps"].trigger()
        yield lambda: "strap left" in window.lines.rows
        assert window.lines.rows["mid-bust"] is row
        ratio = row.slider.ratio()
        QTest.mouseRelease(row.slider, Qt.MouseButton.LeftButton)
        assert session.design.ratio("mid-bust") == ratio < 0.99
        session.undo_stack.undo()
        yield settled(window)
        window.throttled.flush()
        slider = window.lines.rows["strap left"].slider
        assert slider.accessibleName() == "Length of Straps"
        window.lines_controller.decide("strap left", "linked", False)
        yield settled(window)
        assert slider.accessibleName() == "Length of Strap left"
        session.undo_stack.undo()
        yield settled(window)
        cancelled: list[str] = []
        window.lines.drag_cancelled.connect(cancelled.append)
        drag(window, "strap left", -20, release=False)
        session.undo_stack.undo()
        yield lambda: "strap left" not in window.lines.rows
        assert cancelled == ["strap left"]

    run_bodiless([], script)
