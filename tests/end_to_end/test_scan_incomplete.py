"""What the window promises about a scan that cannot go on: it is shown, and the user can help it."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from trimesh.creation import box
from window_tools import Script, run_bodiless, run_undrawn, settled

import app.gui.features.scan.controller
import app.rendering.thumbnail
import core.pipeline.build
import core.scan.body
from app.cli.commands.picture import draw_window
from app.gui.main_window import MainWindow
from app.gui.widgets.basic import ToolButton
from core.document.design import Design, ScanSource
from core.errors import LandmarkError, ScanError
from core.landmarks.detect import find_landmarks
from core.landmarks.manual import in_mm
from core.messages import Message
from core.pipeline.build import IncompleteBuildError
from core.scan.body import Body
from core.scan.orientation.pose import estimate_pose
from tests.end_to_end.test_scan import doubtful, pull

pytestmark = pytest.mark.usefixtures("empty_house")


def nothing_unless_placed(body: Body, placed: Any, needed: int = 1, **_: Any) -> Any:
    """A ``detect_landmarks`` that finds no bust before so many points are placed."""
    if len(placed) < needed:
        raise LandmarkError(Message("No bust is here."), Message("Place its points."))
    return find_landmarks(body)


def place(window: MainWindow, name: str, by: QPoint) -> None:
    """Place a landmark that was not found, as a hand does."""
    window.navigation.show_step("landmarks")
    window.selection.select_landmark(name)
    QTest.mouseClick(window.landmarks.place, Qt.MouseButton.LeftButton)
    pull(window, name, by)


def unpainted(*_: Any) -> Any:
    """A ``render_thumbnail`` that takes no time."""
    return np.zeros((8, 8, 4), np.uint8)


def leave(window: MainWindow) -> None:
    """Close the question without an answer."""
    QTest.mouseClick(window.view.question.findChild(ToolButton), Qt.MouseButton.LeftButton)


def no_waist(body: Body, placed: Any, **_: Any) -> Any:
    """A ``detect_landmarks`` that never finds the waist."""
    found = find_landmarks(body, in_mm(placed, body.pose.file_to_mm))
    kept = {name: mark for name, mark in found.points.items() if name != "waist_front" or mark.by_hand}
    return replace(found, points=kept)


def test_a_scan_that_cannot_go_on_is_shown_and_a_placed_point_lets_it_in(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core.pipeline.build, "detect_landmarks", nothing_unless_placed)

    def script(window: MainWindow) -> Script:
        yield lambda: window.session.stuck is not None and not window.view.busy.isVisible()
        assert window.session.frame is None
        assert window.view.viewport.scene.body is not None
        notice, panel = window.notices.notice(), window.landmarks
        assert notice is not None
        assert notice.sentence == "No bust is here."
        assert window.rail.items["landmarks"].state() == "look"
        assert panel.isVisible()
        assert all(row.view.absent for row in panel.rows.values())
        panel.rows["bust_point_left"].click()
        QTest.mouseClick(panel.place, Qt.MouseButton.LeftButton)
        pull(window, "bust_point_left", QPoint(12, -8))
        yield settled(window)
        design = window.session.design
        assert design is not None
        assert [mark.name for mark in design.placed] == ["bust_point_left"]
        assert window.session.stuck is None
        assert window.notices.notice() is None

    run_bodiless([str(mannequin)], script)


def test_a_scan_that_cannot_go_on_is_read_once_however_many_pins_it_takes(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[Any] = []
    reading = core.pipeline.build._read_upright
    monkeypatch.setattr(core.pipeline.build, "detect_landmarks", partial(nothing_unless_placed, needed=2))
    monkeypatch.setattr(
        core.pipeline.build, "_read_upright", lambda *a, **b: (read.append(a), reading(*a, **b))[1]
    )

    def script(window: MainWindow) -> Script:
        panel = window.landmarks
        yield lambda: window.session.stuck is not None
        first = window.session.stuck
        place(window, "bust_point_left", QPoint(12, -8))
        yield lambda: window.session.stuck is not first
        assert panel.rows["bust_point_left"].view.by_hand
        assert len(read) == 1
        second = window.session.stuck
        window.session.open(str(mannequin))
        yield lambda: window.session.stuck is not second
        assert len(read) == 2, "the file may be another by now"
        place(window, "bust_point_left", QPoint(12, -8))
        third = window.session.stuck
        yield lambda: window.session.stuck is not third
        place(window, "fold_left", QPoint(-9, 14))
        yield settled(window)
        assert len(read) == 2
        assert window.session.design is not None
        assert len(window.session.design.placed) == 2

    run_bodiless([str(mannequin)], script)


def test_a_scan_that_only_asks_leaves_the_open_one_alone(
    person: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []
    monkeypatch.setattr(
        app.gui.features.project.controller,
        "ask_about_changes",
        lambda _, name: asked.append(name) or "cancel",
    )
    monkeypatch.setattr(app.rendering.thumbnail, "render_thumbnail", unpainted)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        session, question = window.session, window.view.question
        monkeypatch.setattr(core.scan.body, "estimate_pose", doubtful(180.0))
        session.open(str(person))
        yield question.isVisible
        leave(window)
        assert window.notices.notice() is None
        window.navigation.show_step("landmarks")
        pull(window, "bust_point_left", QPoint(0, -14))
        yield settled(window)
        assert session.name == "mannequin"
        assert session.undo_stack.count() == 1
        session.open(str(person))
        yield question.isVisible
        QTest.mouseClick(question.pictures[0], Qt.MouseButton.LeftButton)
        assert asked == ["mannequin"], "it was edited"
        yield settled(window)
        assert session.name == "mannequin"
        assert session.undo_stack.count() == 1

    run_undrawn([], script)


def test_a_scan_whose_question_is_left_is_shown_and_can_be_told(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core.scan.body, "estimate_pose", doubtful(180.0))
    monkeypatch.setattr(app.rendering.thumbnail, "render_thumbnail", unpainted)

    def script(window: MainWindow) -> Script:
        yield window.view.question.isVisible
        leave(window)
        notice = window.notices.notice()
        assert notice is not None
        assert notice.tone == "bad"
        assert window.scan.isVisible()
        assert window.view.viewport.scene.body is not None
        first = window.session.stuck
        place(window, "bust_point_left", QPoint(12, -8))
        yield lambda: window.session.stuck is not first
        assert window.view.question.isHidden(), "it was left once"
        second = window.session.stuck
        QTest.mouseClick(window.landmarks.reset, Qt.MouseButton.LeftButton)
        yield lambda: window.session.stuck is not second
        window.scan.value_set.emit("front", "-y")
        yield settled(window)
        assert window.session.stuck is None

    run_bodiless([str(mannequin)], script)


def test_on_a_refused_scan_nothing_can_be_placed_and_what_was_stays_in_sight(
    tmp_path: Path, mannequin: Path
) -> None:
    brick = tmp_path / "brick.ply"
    box((340.0, 220.0, 700.0)).export(brick)

    def script(window: MainWindow) -> Script:
        panel = window.landmarks
        yield lambda: window.session.stuck is not None
        refused = window.session.stuck
        assert refused is not None
        assert refused.kind == "refused"
        assert refused.__traceback__ is None, "it holds all that was read"
        window.navigation.show_step("landmarks")
        window.selection.select_landmark("fold_left")
        assert panel.isVisible()
        assert not panel.place.isVisible()
        window.session.open_design(refused.design.with_placed("fold_left", (60.0, -110.0, 30.0)))
        yield lambda: window.session.stuck is not refused
        assert panel.rows["fold_left"].view.by_hand
        window.navigation.show_step("landmarks")
        assert panel.reset.isVisible()
        placed = window.session.stuck
        QTest.mouseClick(panel.reset, Qt.MouseButton.LeftButton)
        yield lambda: window.session.stuck is not placed
        assert panel.rows["fold_left"].view.absent
        window.session.open(str(mannequin))
        yield settled(window)
        assert window.session.stuck is None

    run_bodiless([str(brick)], script)


def test_the_picture_of_a_scan_that_cannot_go_on_shows_it(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core.pipeline.build, "detect_landmarks", nothing_unless_placed)
    with pytest.raises(IncompleteBuildError, match="No bust is here"):
        draw_window(Design(ScanSource(str(mannequin))), tmp_path / "stuck.png", size=(1280, 800))
    assert (tmp_path / "stuck.png").stat().st_size > 100_000


def test_a_refused_scan_is_shown_as_it_lies_and_can_be_told_how_it_stands(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(vertices: Any, faces: Any, **told: Any) -> Any:
        if told["up"] is None:
            raise ScanError(Message("This is no body."), Message("Say which way is up."))
        return estimate_pose(vertices, faces, **told)

    monkeypatch.setattr(core.scan.body, "estimate_pose", refuse)

    def script(window: MainWindow) -> Script:
        yield lambda: window.session.stuck is not None and not window.view.busy.isVisible()
        notice = window.notices.notice()
        assert notice is not None
        assert notice.sentence == "This is no body."
        assert window.scan.isVisible()
        assert window.view.viewport.scene.body is not None
        window.scan.value_set.emit("up", "+z")
        yield settled(window)
        design = window.session.design
        assert design is not None
        assert design.scan.up == "+z"
        assert window.session.stuck is None

    run_bodiless([str(mannequin)], script)


def test_a_landmark_that_was_not_found_can_be_placed_and_undone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(core.pipeline.build, "detect_landmarks", no_waist)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("landmarks")
        panel = window.landmarks
        panel.rows["bust_point_left"].click()
        assert not panel.place.isVisible()
        window.selection.select_landmark("waist_front")
        assert panel.rows["waist_front"].view.absent
        QTest.mouseClick(panel.place, Qt.MouseButton.LeftButton)
        pull(window, "waist_front", QPoint(0, 20))
        yield settled(window)
        frame = window.session.frame
        assert frame is not None
        assert frame.stages.landmarks.points["waist_front"].by_hand
        assert not panel.place.isVisible()
        window.actions_.undo.trigger()
        yield settled(window)
        assert panel.rows["waist_front"].view.absent

    run_undrawn([], script)
