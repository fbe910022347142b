"""The window's promises to its user, each through the real main(); afterwards the house is empty."""

from __future__ import annotations

import gc
import json
import threading
import zipfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PySide6.QtCore import QPoint, QSettings, Qt
from PySide6.QtGui import QColor, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMessageBox
from window_tools import Script, run_main, settled

import app.desk
from app.main_window import MainWindow
from core.project import open_project


@pytest.fixture(autouse=True)
def empty_house(qapp: QApplication) -> Iterator[None]:
    """Nothing of a window lives on: no thread, no widget, no timer of ours, no 3D view."""
    QSettings().clear()
    yield
    gc.collect()
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("busk")]
    assert not [widget for widget in QApplication.topLevelWidgets() if isinstance(widget, MainWindow)]


def drag(window: MainWindow, name: str, pixels: int, release: bool = True) -> None:
    """Drag the handle of a line's slider, as a hand does."""
    slider = window.lines.rows[name].slider
    start = QPoint(round(slider._x_of(slider.ratio())), slider.height() // 2)
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=start)
    for step in range(1, 6):
        QTest.mouseMove(slider, start + QPoint(pixels * step // 5, 0))
    if release:
        QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=start + QPoint(pixels, 0))


def points(window: MainWindow) -> np.ndarray:
    frame = window.session.frame
    assert frame is not None
    return frame.points


def test_the_sample_opens_in_a_finished_state() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        frame = window.session.frame
        assert frame is not None
        assert window.session.name == "mannequin"
        assert len(frame.stages.body.mesh.faces) == 65742
        assert frame.verdict.state == "settled"
        assert frame.marks.apex_z - frame.stages.rest_marks.apex_z > 1.0
        window.desk.plot_now()
        yield lambda: window.strip.chip.state() == "settled"
        assert set(frame.tracks) == {"adaptive", "conventional"}

    assert run_main([], script) == 0


def test_dragging_a_slider_moves_the_body_and_is_one_undo_step() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        at_start, stack = points(window).copy(), window.session.undo_stack
        drag(window, "mid-bust", -30)
        yield settled(window)
        dragged = points(window).copy()
        design = window.session.design
        assert design is not None
        ratio = design.ratio("mid-bust")
        assert ratio < 0.94
        assert np.abs(dragged - at_start).max() > 1.0
        assert stack.count() == 1
        assert f"{100 * ratio:.1f}" in stack.undoText()
        window.actions_.undo.trigger()
        yield settled(window)
        assert np.abs(points(window) - at_start).max() < 0.2
        window.actions_.redo.trigger()
        yield settled(window)
        assert np.abs(points(window) - dragged).max() < 0.2

    run_main([], script)


def test_escape_takes_a_drag_back() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        design, at_start = window.session.design, points(window).copy()
        drag(window, "mid-bust", -60, release=False)
        yield lambda: np.abs(points(window) - at_start).max() > 0.5
        QTest.keyClick(window.lines.rows["mid-bust"].slider, Qt.Key.Key_Escape)
        yield settled(window)
        assert window.session.design is design
        assert window.session.undo_stack.count() == 0
        assert np.abs(points(window) - at_start).max() < 0.2

    run_main([], script)


def test_a_project_is_saved_and_reopened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "customer 0412.busk"
    monkeypatch.setattr(app.desk, "ask_save", lambda *_: str(path))
    seen = []

    def first(window: MainWindow) -> Script:
        yield settled(window)
        drag(window, "mid-bust", -20)
        drag(window, "full-bust", -10)
        yield settled(window)
        assert "*" in window.windowTitle()
        window.actions_.save.trigger()
        assert "*" not in window.windowTitle()
        seen.append((window.session.design, points(window).copy()))

    def again(window: MainWindow) -> Script:
        yield settled(window)
        assert window.session.name == "customer 0412"
        assert window.session.design is not None
        assert window.session.design.lines == seen[0][0].lines
        assert np.abs(points(window) - seen[0][1]).max() < 0.3

    run_main([], first)
    with zipfile.ZipFile(path) as archive:
        assert set(archive.namelist()) == {"design.json", "scan/mannequin.ply", "preview.png"}
        assert json.loads(archive.read("design.json"))["format"] == 1
        assert QImage.fromData(archive.read("preview.png")).width() == 480
    run_main([str(path)], again)


def test_the_shown_body_is_exported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        for ending in ("ply", "obj", "stl"):
            path = tmp_path / f"body.{ending}"
            monkeypatch.setattr(app.desk, "ask_save", lambda *_, path=path: str(path))
            window.actions_.export.trigger()
            body = trimesh.load(path, process=False)
            assert len(body.faces) == 65742
            frame = window.session.frame
            assert frame is not None
            if ending != "stl":
                moved = np.asarray(body.vertices)[frame.stages.moving.vertices]
                assert np.abs(moved - frame.points).max() < 1e-3

    run_main([], script)


def test_before_and_after_flip_on_the_space_bar() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield window.isActiveWindow
        view = window.view
        body = view.viewport.scene.body
        assert body is not None
        after = body.shown_points.copy()
        window.actions_.flip.trigger()
        assert not view.after
        assert np.abs(body.shown_points - body.rest.vertices).max() == 0.0
        window.actions_.flip.trigger()
        assert np.array_equal(body.shown_points, after)

    run_main([], script)


def test_control_mesh_and_lines_can_be_hidden() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        scene = window.view.viewport.scene
        tools = window.view.tools.actions_by_name
        assert not scene.is_visible("control")
        tools["control-mesh"].trigger()
        assert scene.is_visible("control")
        tools["bands"].trigger()
        assert not scene.is_visible("bands")
        window.lines.visibility_changed.emit("mid-bust", False)
        assert "mid-bust" not in scene.bands.names

    run_main([], script)


def test_a_bad_scan_leaves_everything_as_it_was(tmp_path: Path) -> None:
    broken = tmp_path / "broken.ply"
    broken.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        design, at_start = window.session.design, points(window).copy()
        window.desk.open_file(str(broken))
        yield lambda: window.notices.notice() is not None
        notice = window.notices.notice()
        assert notice is not None
        assert notice.tone == "bad"
        assert notice.hint
        yield settled(window)
        assert window.session.design is design
        assert np.abs(points(window) - at_start).max() < 0.2

    run_main([], script)


def test_an_edit_that_cannot_be_carried_out_is_taken_back() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        design = window.session.design
        window.scan.unit_chosen.emit("m")
        yield lambda: window.notices.notice() is not None
        yield settled(window)
        assert window.session.design == design
        assert window.session.undo_stack.count() == 0

    run_main([], script)


def test_the_conventional_force_vibrates_when_the_line_is_too_short() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.strip.control_chosen.emit("conventional")
        window.lines.length_committed.emit("mid-bust", 0.6)
        yield settled(window)
        frame = window.session.frame
        assert frame is not None
        assert frame.verdict.state == "vibrating"
        window.desk.plot_now()
        yield lambda: window.strip.chip.state() == "vibrating"

    run_main([], script)


@pytest.mark.parametrize("answer", ["discard", "stay", "save"])
def test_closing_asks_about_changes(answer: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "kept.busk"
    monkeypatch.setattr(app.desk, "ask_about_changes", lambda *_: answer)
    monkeypatch.setattr(app.desk, "ask_save", lambda *_: str(path))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        drag(window, "mid-bust", -20)
        yield settled(window)
        closed = window.close()
        assert closed == (answer != "stay")
        assert path.exists() == (answer == "save")

    run_main([], script)
    if answer == "save":
        assert open_project(path).ratio("mid-bust") < 0.95


def test_the_question_offers_three_ways(qapp: QApplication, monkeypatch: pytest.MonkeyPatch) -> None:
    given = []
    monkeypatch.setattr(
        QMessageBox, "exec", lambda box: given.append(box.text()) or QMessageBox.StandardButton.Cancel.value
    )
    assert app.desk.ask_about_changes(None, "Customer 0412") == "stay"
    assert "Customer 0412" in given[0]


def test_the_whole_window_looks_as_it_should() -> None:
    """The body is warm and in the middle, the selected band has its colour, nothing is black."""

    def script(window: MainWindow) -> Script:
        window.view.viewport.motion = False
        window.resize(1280, 800)
        yield settled(window)
        yield lambda: window.view.is_shaded
        window.desk.plot_now()
        yield lambda: True
        image = window.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
        ratio = image.width() / window.width()
        pixels = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
        pixels = pixels[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(int)
        area = window.view.geometry()
        top_left = window.view.mapTo(window, QPoint(0, 0))
        x, y = round(top_left.x() * ratio), round(top_left.y() * ratio)
        view = pixels[y : y + round(area.height() * ratio), x : x + round(area.width() * ratio)]
        warm = (view[..., 0] - view[..., 2] > 18) & (view[..., 0] > 90)
        across = np.flatnonzero(warm.mean(axis=0) > 0.3) / view.shape[1]
        assert 0.15 < warm.mean() < 0.7
        assert across.min() > 0.1
        assert across.max() < 0.9
        band = QColor("#E5536B")
        near = np.abs(view - [band.red(), band.green(), band.blue()]).max(axis=2) < 60
        assert near.sum() > 300
        assert (view.max(axis=2) < 12).mean() < 0.01

    run_main([], script)
