"""What the window promises about a scan that cannot go on: it is shown, and the user can help it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from test_window_scan import doubtful, pull
from window_tools import Script, run_main, settled

import app.scan_desk
import core.body
import core.pipeline
from app.main_window import MainWindow
from app.picture import draw_window
from core.body import Body
from core.design import Design, ScanSource
from core.errors import LandmarkError, ScanError
from core.landmarks import find_landmarks
from core.pipeline import StuckError
from core.placing import in_mm
from core.standing.upright import find_pose

pytestmark = pytest.mark.usefixtures("empty_house")


def nothing_unless_placed(body: Body, placed: Any) -> Any:
    """A ``find`` that finds no bust before a point is placed."""
    if not placed:
        raise LandmarkError("No bust is here.", "Place its points.")
    return find_landmarks(body)


def no_waist(body: Body, placed: Any) -> Any:
    """A ``find`` that never finds the waist."""
    found = find_landmarks(body, in_mm(placed, body.pose.file_to_mm))
    kept = {name: mark for name, mark in found.points.items() if name != "waist_front" or mark.by_hand}
    return replace(found, points=kept)


def test_a_scan_that_cannot_go_on_is_shown_and_a_placed_point_lets_it_in(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core.pipeline, "find", nothing_unless_placed)

    def script(window: MainWindow) -> Script:
        yield lambda: window.scan_desk.stuck is not None and not window.view.busy.isVisible()
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
        assert window.scan_desk.stuck is None
        assert window.notices.notice() is None

    run_main([str(mannequin)], script)


def test_the_picture_of_a_scan_that_cannot_go_on_shows_it(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core.pipeline, "find", nothing_unless_placed)
    with pytest.raises(StuckError, match="No bust is here"):
        draw_window(Design(ScanSource(str(mannequin))), tmp_path / "stuck.png", size=(1280, 800))
    assert (tmp_path / "stuck.png").stat().st_size > 100_000


def test_a_refused_scan_is_shown_as_it_lies_and_can_be_told_how_it_stands(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(vertices: Any, faces: Any, **told: Any) -> Any:
        if told["up"] is None:
            raise ScanError("This is no body.", "Say which way is up.")
        return find_pose(vertices, faces, **told)

    monkeypatch.setattr(core.body, "find_pose", refuse)

    def script(window: MainWindow) -> Script:
        yield lambda: window.scan_desk.stuck is not None and not window.view.busy.isVisible()
        notice = window.notices.notice()
        assert notice is not None
        assert notice.sentence == "This is no body."
        assert window.scan.isVisible()
        assert window.view.viewport.scene.body is not None
        window.scan.told.emit("up", "+z")
        yield settled(window)
        design = window.session.design
        assert design is not None
        assert design.scan.up == "+z"
        assert window.scan_desk.stuck is None

    run_main([str(mannequin)], script)


def test_a_landmark_that_was_not_found_can_be_placed_and_undone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(core.pipeline, "find", no_waist)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.desk.go_to("landmarks")
        panel = window.landmarks
        panel.rows["bust_point_left"].click()
        assert not panel.place.isVisible()
        window.desk.select_landmark("waist_front")
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

    run_main([], script)


def test_pictures_that_cannot_be_painted_leave_no_question(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: Any) -> None:
        raise RuntimeError("no paint")

    monkeypatch.setattr(core.body, "find_pose", doubtful(0.0))
    monkeypatch.setattr(app.scan_desk, "pictures", fail)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield lambda: "Scan step" in getattr(window.notices.notice(), "hint", "")
        assert not window.view.question.isVisible()

    run_main([str(mannequin)], script)
