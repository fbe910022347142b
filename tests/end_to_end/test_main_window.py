"""The window's promises to its user, each through the real main()."""

from __future__ import annotations

import gc

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QImage
from PySide6.QtTest import QTest
from window_tools import Script, drag, points, run_main, run_undrawn, settled

from app.gui.main_window import MainWindow
from app.rendering.camera import VIEWS
from core.errors import ProjectError
from core.messages import Message

pytestmark = pytest.mark.usefixtures("empty_house")


@pytest.mark.usefixtures("fine_samples")
@pytest.mark.usefixtures("spared_as_in_the_program")
def test_the_sample_opens_in_a_finished_state() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        frame = window.session.frame
        assert frame is not None
        assert window.session.name == "mannequin"
        assert len(frame.stages.body.mesh.faces) == 65742
        assert frame.verdict.state == "settled"
        assert not gc.isenabled(), "the solver's thread must not look for garbage"
        assert frame.marks.apex_z - frame.stages.rest_marks.apex_z > 1.0
        window.throttled.flush()
        yield lambda: window.strip.chip.state() in ("good", "caution", "bad")
        assert window.strip._turns.text().startswith("Converged · ")
        assert set(frame.tracks) == {"adaptive", "conventional"}

    assert run_main([], script) == 0
    assert gc.isenabled()
    assert not gc.get_freeze_count(), "what the window spared the search is given back"


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

    run_undrawn([], script)


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

    run_undrawn([], script)


def test_the_view_shows_what_its_keys_and_tools_ask_for() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield from before_and_after_flip_on_the_space_bar(window)
        yield from the_tools_tell_where_the_body_is_seen_from(window)
        control_mesh_and_lines_can_be_hidden(window)

    run_main([], script)


def before_and_after_flip_on_the_space_bar(window: MainWindow) -> Script:
    window.activateWindow()
    yield window.isActiveWindow
    view = window.view
    body = view.viewport.scene.body
    assert body is not None
    after = body.shown_points.copy()
    QTest.keyClick(window, Qt.Key.Key_Space)
    assert not view.after
    assert np.abs(body.shown_points - body.rest.vertices).max() == 0.0
    QTest.keyClick(window, Qt.Key.Key_Space)
    assert view.after
    assert np.array_equal(body.shown_points, after)


def the_tools_tell_where_the_body_is_seen_from(window: MainWindow) -> Script:
    window.view.viewport.motion = True
    view, tools = window.view.viewport, window.view.tools.actions_by_name
    assert tools["three-quarter"].isChecked()
    tools["left"].trigger()
    yield lambda: view.scene.view.name == "left"
    assert tools["left"].isChecked()
    canvas = view.childAt(view.rect().center())
    start = canvas.rect().center()
    QTest.mousePress(canvas, Qt.MouseButton.LeftButton, pos=start)
    QTest.mouseMove(canvas, start + QPoint(30, 0))
    QTest.mouseMove(canvas, start + QPoint(60, 0))
    QTest.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=start + QPoint(60, 0))
    assert not any(tools[name].isChecked() for name in VIEWS)


def control_mesh_and_lines_can_be_hidden(window: MainWindow) -> None:
    scene = window.view.viewport.scene
    tools = window.view.tools.actions_by_name
    assert not scene.is_visible("control")
    tools["control-mesh"].trigger()
    assert scene.is_visible("control")
    tools["bands"].trigger()
    assert not scene.is_visible("bands")
    window.view.compare.actions_by_name["ghost"].trigger()
    assert scene.is_visible("ghost")
    window.lines.visibility_changed.emit("mid-bust", False)
    assert "mid-bust" not in scene.bands.names


def test_an_edit_that_cannot_be_carried_out_is_taken_back() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        design = window.session.design
        window.scan.value_set.emit("unit", "m")
        yield lambda: window.notices.notice() is not None
        yield settled(window)
        assert window.session.design == design
        assert not window.session.undo_stack.canUndo()
        window.session.not_saved.emit(ProjectError(Message("Not written.")))
        drag(window, "mid-bust", -10)
        yield settled(window)
        assert window.notices.notice().sentence == "Not written.", "the refusal alone is of the past"

    run_undrawn([], script)


def test_the_conventional_force_vibrates_when_the_line_is_too_short() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.strip.control_chosen.emit("conventional")
        window.lines.length_committed.emit("mid-bust", 0.6)
        yield settled(window)
        frame = window.session.frame
        assert frame is not None
        assert frame.verdict.state == "vibrating"
        window.throttled.flush()
        yield lambda: window.strip.chip.state() == "bad"
        assert window.strip._turns.text().startswith("Oscillating · ")

    run_undrawn([], script)


def test_the_whole_window_looks_as_it_should() -> None:
    """The body is warm and in the middle, the selected band has its colour, nothing is black."""

    def script(window: MainWindow) -> Script:
        window.view.viewport.motion = False
        window.resize(1280, 800)
        yield settled(window)
        yield lambda: window.view.is_shaded
        window.throttled.flush()
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
