"""What the window promises about landmarks: the model follows a pin, both sides go together if linked."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_bodiless, run_undrawn, settled

import app.gui.features.landmarks.controller
import app.gui.features.project.controller as project_files
from app.gui.features.landmarks.panel import LandmarksPanel
from app.gui.main_window import MainWindow
from app.presenters.landmarks import LandmarkView
from core.geometry.mesh import Points
from core.landmarks.manual import nearest_skin
from core.landmarks.warnings import LandmarkWarning
from core.messages import Message
from tests.end_to_end.test_scan import pull

pytestmark = pytest.mark.usefixtures("empty_house")


def hold(window: MainWindow, name: str, by: QPoint) -> Callable[[], None]:
    """Drag a landmark's pin by so many pixels and keep it in the hand; returns how to let it go."""
    overlay = window.view.viewport.overlay
    pin = next(pin for pin in overlay.pins if pin.name == name)
    x, y, _ = overlay.spots([pin.position])[0]
    canvas, start = overlay.parentWidget(), QPoint(round(x), round(y))
    QTest.mousePress(canvas, Qt.MouseButton.LeftButton, pos=start)
    QTest.mouseMove(canvas, start + by / 2)
    QTest.mouseMove(canvas, start + by)
    return lambda: QTest.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=start + by)


def mark(window: MainWindow, name: str) -> Points:
    """Where a landmark of the shown frame is."""
    assert window.session.frame is not None
    return window.session.frame.stages.landmarks.position(name)


def test_the_model_follows_a_pin_before_it_is_let_go_and_escape_brings_all_back() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        window.navigation.show_step("landmarks")
        session, stack = window.session, window.session.undo_stack
        frame, design = session.frame, session.design
        assert frame is not None
        control = frame.stages.control.mesh.vertices
        found = mark(window, "bust_point_left")
        let_go = hold(window, "bust_point_left", QPoint(0, -14))
        yield lambda: mark(window, "bust_point_left") is not found
        assert session.frame is not None
        assert np.abs(session.frame.stages.control.mesh.vertices - control).max() > 1.0
        assert stack.count() == 0
        assert session.design is design
        assert window.landmarks_controller.carries
        assert not window.status.stop.isVisible(), "nobody waits for what goes along"
        QTest.keyClick(window, Qt.Key.Key_Escape)
        assert not window.landmarks_controller.carries
        let_go()
        yield settled(window)
        assert stack.count() == 0
        assert session.frame.stages.design is design
        assert np.array_equal(session.frame.stages.control.mesh.vertices, control)
        assert np.array_equal(mark(window, "bust_point_left"), found)
        pins = {pin.name: pin.position for pin in window.view.viewport.overlay.pins}
        assert pins["bust_point_left"] == pytest.approx(found, abs=0.01)

    run_undrawn([], script)


def test_a_new_warning_has_its_notice_whose_button_shows_its_landmark(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    warning = LandmarkWarning("root_outer_right", Message("The scan is coarse."))
    monkeypatch.setattr(app.gui.features.landmarks.controller, "landmark_warnings", lambda _: [warning])

    def script(window: MainWindow) -> Script:
        yield settled(window)
        notice = window.notices.notice()
        assert notice is not None
        assert notice.sentence == "The scan is coarse."
        ((_, review),) = notice.actions
        review()
        assert window.landmarks.isVisible()
        assert window.landmarks_controller._context.selection.landmark == "root_outer_right"

    run_bodiless([], script)


def test_linked_sides_are_placed_as_in_a_mirror_in_one_step_and_keys_move_a_pin(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(project_files, "ask_about_changes", lambda *_: "cancel")
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(tmp_path / "pins.busk"))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        window.navigation.show_step("landmarks")
        session, stack, panel = window.session, window.session.undo_stack, window.landmarks
        frame, before = session.frame, session.design
        assert frame is not None
        right = mark(window, "bust_point_right")
        pull(window, "bust_point_left", QPoint(0, -12))
        yield settled(window)
        assert not (session.frame and session.frame.stages.landmarks.points["bust_point_right"].by_hand)
        window.actions_.undo.trigger()
        yield settled(window)
        QTest.mouseClick(panel.link, Qt.MouseButton.LeftButton)
        pull(window, "bust_point_left", QPoint(0, -12))
        yield settled(window)
        assert stack.count() == 1
        assert stack.undoText() == "Bust point placed on both sides"
        left, middle = mark(window, "bust_point_left"), frame.stages.moving.middle
        image = np.array([2.0 * middle - left[0], left[1], left[2]])
        placed = mark(window, "bust_point_right")
        assert placed == pytest.approx(nearest_skin(frame.stages.body.smoothed, image), abs=0.01)
        assert placed[2] > right[2] + 2.0
        window.actions_.undo.trigger()
        yield settled(window)
        assert session.design == before
        QTest.mouseClick(panel.link, Qt.MouseButton.LeftButton)
        panel.rows["fold_left"].click()
        panel.rows["fold_left"].setFocus()
        fold = mark(window, "fold_left")
        QTest.keyClick(panel, Qt.Key.Key_Return)
        assert window.view.viewport.hasFocus()
        QTest.keyClick(window.view.viewport, Qt.Key.Key_Down, Qt.KeyboardModifier.ShiftModifier)
        QTest.keyClick(window.view.viewport, Qt.Key.Key_Down)
        assert window.landmarks_controller.carries
        QTest.keyClick(window.view.viewport, Qt.Key.Key_Return)
        yield settled(window)
        assert stack.count() == 1, "both presses are one step"
        assert 3.0 < fold[2] - mark(window, "fold_left")[2] < 8.0
        a_pin_in_the_hand_is_saved_and_asked_about(window)

    run_undrawn([], script)


def a_pin_in_the_hand_is_saved_and_asked_about(window: MainWindow) -> None:
    session, stack = window.session, window.session.undo_stack
    stack.setClean()
    QTest.keyClick(window.view.viewport, Qt.Key.Key_Down)
    assert not window.project_controller.may_leave(), "a pin that was moved a moment ago is not lost unasked"
    assert stack.count() == 2
    stack.setClean()
    QTest.keyClick(window.view.viewport, Qt.Key.Key_Down)
    assert window.project_controller.save()
    assert stack.count() == 3
    assert stack.isClean(), "it is in the file"
    assert session.finish_saving()


def test_what_is_amber_is_counted_and_can_be_confirmed(empty_house: None, qtbot: object) -> None:
    panel, heard = LandmarksPanel(), []
    weak = LandmarkView("fold_left", "Fold", 0.3, "A rule.", "under", weak=True, traced=True)
    calm = LandmarkView("side_left", "Side", 0.2, "A rule.", "further")
    panel.set_landmarks([weak, calm], ["The fold could not be seen clearly."])
    panel.confirmed.connect(heard.append)
    panel.select("side_left")
    assert panel.right.isHidden()
    assert panel.rows["side_left"].view.tone == "control", "nothing hangs on it"
    panel.select("fold_left")
    assert panel.rows["fold_left"].view.tone == "warn"
    assert panel._doubts._count.text() == "To review: 1"
    assert "shown on the body" in panel.rows["fold_left"].toolTip()
    panel.right.click()
    assert heard == [("fold_left",)]
    panel.set_landmarks([LandmarkView("fold_left", "Fold", 1.0, "A rule.", "under", by_hand=True), calm])
    assert panel._doubts.isHidden()
    panel.deleteLater()
