"""What the window promises about scans: it asks how one stands, lets go of its reading, keeps corrections."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from window_tools import Script, drag, run_bodiless, run_undrawn, settled

import app.gui.features.project.controller as project_files
import core.pipeline.build
import core.scan.body
from app.gui.main_window import MainWindow
from core.progress import Progress
from core.scan.body import Body
from core.scan.orientation.pose import Pose, estimate_pose

pytestmark = pytest.mark.usefixtures("empty_house")


def doubtful(turn: float) -> Any:
    """A ``estimate_pose`` that is not sure unless it is told, and that then errs by ``turn`` degrees."""
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    about = np.eye(4)
    about[:2, :2] = [[c, -s], [s, c]]

    def find(vertices: Any, faces: Any, **told: Any) -> Pose:
        pose = estimate_pose(vertices, faces, **told)
        if told.get("front") is not None:
            return pose
        fronts = {0.0: "-y", 180.0: "+y"}
        return replace(
            pose, file_to_mm=about @ pose.file_to_mm, front=fronts[turn], is_certain=False, others=()
        )

    return find


def slow(name: str, data: bytes, *, progress: Progress, **_: Any) -> Body:
    """A ``body_of`` that reads for ever, and tells how far it is."""
    for step in range(10_000):
        progress("reading", step / 10_000)
        time.sleep(0.005)
    raise AssertionError("nobody has cancelled")


def pull(window: MainWindow, name: str, by: QPoint) -> None:
    """Drag a landmark's pin by so many pixels, as a hand does."""
    overlay = window.view.viewport.overlay
    pin = next(pin for pin in overlay.pins if pin.name == name)
    x, y, _ = overlay.spots([pin.position])[0]
    canvas, start = overlay.parentWidget(), QPoint(round(x), round(y))
    QTest.mousePress(canvas, Qt.MouseButton.LeftButton, pos=start)
    for part in (0.4, 0.7, 1.0):
        QTest.mouseMove(canvas, start + QPoint(round(part * by.x()), round(part * by.y())))
    QTest.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=start + by)


def test_an_unsure_scan_asks_and_the_answer_is_one_undo_step(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core.scan.body, "estimate_pose", doubtful(0.0))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield window.view.question.isVisible
        notice, question, stack = window.notices.notice(), window.view.question, window.session.undo_stack
        assert notice is not None
        assert "ambiguous" in notice.sentence
        assert question.pictures[0].text() == "+z up, −y front"
        assert len(question.pictures) == 4
        QTest.mouseClick(question.pictures[0], Qt.MouseButton.LeftButton)
        assert not question.isVisible()
        assert window.notices.notice() is None
        yield settled(window)
        design, frame = window.session.design, window.session.frame
        assert design is not None
        assert frame is not None
        assert (design.scan.up, design.scan.front) == ("+z", "-y")
        assert frame.stages.body.pose.is_certain
        assert stack.count() == 1
        window.actions_.undo.trigger()
        yield settled(window)
        assert window.session.design is not None
        assert window.session.design.scan.front is None

    run_bodiless([str(mannequin)], script)


def test_a_scan_that_shows_no_bust_is_turned_by_a_picture(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core.scan.body, "estimate_pose", doubtful(180.0))

    def script(window: MainWindow) -> Script:
        yield window.view.question.isVisible
        assert window.session.design is None
        assert window.session.frame is None
        right = next(each for each in window.view.question.pictures if each.answer.front == "-y")
        QTest.mouseClick(right, Qt.MouseButton.LeftButton)
        yield settled(window)
        frame = window.session.frame
        assert frame is not None
        assert frame.stages.landmarks.position("bust_point_left")[1] < -150.0
        assert frame.stages.body.pose.front == "-y"

    run_bodiless([str(mannequin)], script)


def test_a_body_of_a_doubtful_size_leads_to_its_unit(tmp_path: Path, mannequin: Path) -> None:
    large = trimesh.load(mannequin, process=False)
    large.apply_scale(1.5)
    path = tmp_path / "large.ply"
    large.export(path)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        notice = window.notices.notice()
        assert notice is not None
        assert window.rail.items["scan"].state() == "look"
        (check,) = (do for words, do in notice.actions if words == "Check unit")
        check()
        assert window.scan.isVisible()

    run_bodiless([str(path)], script)


def test_the_reading_of_a_scan_can_be_cancelled(person: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        design, frame, busy = window.session.design, window.session.frame, window.view.busy
        monkeypatch.setattr(core.pipeline.build, "body_of", slow)
        for way in ("button", "escape"):
            window.project_controller.open_file(str(person))
            yield busy.isVisible
            assert window.actions_.cancel.isEnabled()
            if way == "button":
                QTest.mouseClick(busy.stop, Qt.MouseButton.LeftButton)
            else:
                QTest.keyClick(window, Qt.Key.Key_Escape)
            assert not busy.isVisible()
            assert not window.actions_.cancel.isEnabled()
            assert window.session.design is design
            assert window.session.frame is frame
            assert window.session.name == "mannequin"
        drag(window, "mid-bust", -10)
        yield settled(window)
        assert window.session.undo_stack.count() == 1
        assert window.notices.notice() is None

    run_bodiless([], script)


def test_a_cancelled_edit_of_the_scan_leaves_no_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        design = window.session.design
        monkeypatch.setattr(core.pipeline.build, "body_of", slow)
        window.scan.value_set.emit("front", "+y")
        yield window.view.busy.isVisible
        assert window.session.undo_stack.count() == 1
        window.progress_controller.cancel()
        assert window.session.design == design
        assert not window.session.undo_stack.canUndo()
        yield settled(window)

    run_bodiless([], script)


def test_a_dragged_pin_is_a_correction_that_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "corrected.busk"
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(path))
    kept: list[Any] = []

    def first(window: MainWindow) -> Script:
        window.view.viewport.motion = False
        yield settled(window)
        window.navigation.show_step("landmarks")
        session, stack = window.session, window.session.undo_stack
        frame = session.frame
        assert frame is not None
        found = frame.stages.landmarks.position("bust_point_left")
        pull(window, "bust_point_left", QPoint(0, 0))
        assert stack.count() == 0, "a click selects and moves nothing"
        pull(window, "bust_point_left", QPoint(0, -14))
        yield settled(window)
        assert stack.count() == 1
        assert session.frame is not None
        mark = session.frame.stages.landmarks.points["bust_point_left"]
        assert mark.by_hand
        assert mark.position[2] > found[2] + 2.0
        assert session.frame.stages.rest_marks.bust_point_left_z == pytest.approx(mark.position[2], abs=0.5)
        assert session.frame.stages.body is frame.stages.body
        assert window.landmarks.reset.isVisible()
        window.actions_.undo.trigger()
        yield settled(window)
        assert np.array_equal(session.frame.stages.landmarks.position("bust_point_left"), found)
        window.actions_.redo.trigger()
        yield settled(window)
        window.actions_.save.trigger()
        assert session.design is not None
        kept.append((session.design.placed, mark.position))

    def again(window: MainWindow) -> Script:
        yield settled(window)
        session = window.session
        assert session.design is not None
        assert session.frame is not None
        assert session.design.placed == kept[0][0]
        mark = session.frame.stages.landmarks.points["bust_point_left"]
        assert mark.by_hand
        assert mark.position == pytest.approx(kept[0][1], abs=1e-6)
        window.landmarks.reset_requested.emit(("bust_point_left",))
        yield settled(window)
        assert session.design.placed == ()
        assert not session.frame.stages.landmarks.points["bust_point_left"].by_hand

    run_undrawn([], first)
    run_undrawn([str(path)], again)
