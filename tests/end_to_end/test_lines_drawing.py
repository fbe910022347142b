"""Lines are drawn on the body by clicks, kept with their mirror image, led through other control points."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_main, settled, undrawn

from app.gui.features.lines.draw_tool import LineDrawTool
from app.gui.features.lines.line_draw_card import LineDrawCard
from app.gui.main_window import MainWindow
from core.control_mesh.path_snapping import Snapped
from core.control_mesh.template import read_template
from core.document.free_lines import FreeCurve
from core.document.line_notation import mirror_image, mirrored
from core.geometry.plane_sections import resample

TEMPLATE = read_template("168")

pytestmark = pytest.mark.usefixtures("empty_house")


def spot(window: MainWindow, point: int) -> QPoint:
    """Where a control point is seen."""
    scene, overlay = window.view.viewport.scene, window.view.viewport.overlay
    places = scene.carried_points(window.session.frame.stages.control.mesh.vertices[[point]])
    x, y, _ = scene.view.to_picture(places, overlay.width(), overlay.height())[0]
    return QPoint(round(x), round(y))


def click(window: MainWindow, *points: int) -> None:
    """Click on control points as they are seen."""
    canvas = window.view.viewport.overlay.parentWidget()
    for point in points:
        QTest.mouseMove(canvas, spot(window, point))
        QTest.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=spot(window, point))


def press(window: MainWindow, key: Qt.Key) -> None:
    QTest.keyClick(window.view.viewport, key)


def at(row: int, column: int) -> int:
    return TEMPLATE.point(row, column)


def test_a_line_is_drawn_by_clicks_and_snaps_to_the_control_mesh_on_both_sides() -> None:
    path = tuple(at(row, 2) for row in (2, 3, 4, 5, 6))

    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        window.view.viewport.set_view("front")
        drawing, card = window.draw_tool, window.draw_tool._sketching.card
        window.actions_.draw_line.trigger()
        assert card.isVisible()
        click(window, path[0])  # before the skin is ready the first points are joined straight
        yield lambda: drawing._ways is not None
        press(window, Qt.Key.Key_Return)
        assert drawing._found is None, "one point is no line"
        click(window, at(4, 4))
        press(window, Qt.Key.Key_Backspace)
        click(window, path[2], path[-1])
        skin = window.session.frame.stages.body.mesh
        curve = np.concatenate(drawing._curve)
        assert len(curve) > 20, "it follows the skin"
        assert np.abs(curve - skin.vertices.mean(axis=0)).max() < 400.0
        window.view.viewport.setFocus()
        press(window, Qt.Key.Key_Return)
        assert isinstance(drawing._found["bust"], FreeCurve), "as it was drawn, unless chosen otherwise"
        assert drawing._found["bust"].deviation < 1.0
        card.snap.click()
        assert drawing._found["bust"].path == path
        assert drawing._found["bust"].deviation < 15.0
        card.both.setChecked(True)
        press(window, Qt.Key.Key_Return)
        assert not card.isVisible()
        yield lambda: "line 1 left" in window.lines.rows and window.is_settled()
        own = {line.name: line.points for line in window.session.design.own_lines}
        assert own == {"line 1 left": path, "line 1 right": mirrored(path, TEMPLATE)}
        assert window.session.undo_stack.undoText() == "Line 1 added"
        assert window.lines.rows["line 1 left"].view.sides, "drawn on both sides, it is linked"
        yield from led_elsewhere(window, path)
        yield from let_go_of(window)
        yield from a_ring(window)

    run_main([], script)


def drawing_begun(
    window: MainWindow,
) -> Generator[Callable[[], bool], None, tuple[LineDrawTool, LineDrawCard]]:
    """Begin to draw a line on the front, and return what draws it and its card once the skin is ready."""
    undrawn(window)
    yield settled(window)
    window.view.viewport.set_view("front")
    window.actions_.draw_line.trigger()
    yield lambda: window.draw_tool._ways is not None
    return window.draw_tool, window.draw_tool._sketching.card


def test_a_line_on_the_rib_cage_is_said_to_measure_only_and_can_move_to_where_it_pulls() -> None:
    def script(window: MainWindow) -> Script:
        drawing, card = yield from drawing_begun(window)
        card.snap.setChecked(False)
        fixed = window.session.frame.stages.control.fixed
        row = [point for point in window.session.frame.stages.control.paths["under-bust"] if fixed[point]]
        click(window, row[2], row[4])
        window.view.viewport.setFocus()
        press(window, Qt.Key.Key_Return)
        assert not drawing._found["bust"].is_movable
        assert "measured only" in card._what.text()
        assert isinstance(drawing._found["bust"], FreeCurve)
        card.move_.click()
        assert card.snap.isChecked()
        assert drawing._found["bust"].is_movable
        assert "measured only" not in card._what.text()
        assert card.move_.isHidden()
        press(window, Qt.Key.Key_Return)
        yield lambda: "line 1" in window.lines.rows and window.is_settled()
        assert window.lines.rows["line 1"].view.constrained

    run_main([], script)


@pytest.mark.usefixtures("fine_samples")
def test_a_diagonal_stays_what_was_drawn_and_can_be_drawn_anew() -> None:
    def script(window: MainWindow) -> Script:
        drawing, card = yield from drawing_begun(window)
        click(window, at(2, 1), at(5, 4))
        window.view.viewport.setFocus()
        press(window, Qt.Key.Key_Return)
        drawn, found = np.concatenate(drawing._curve), drawing._found["bust"]
        card.both.setChecked(True)
        press(window, Qt.Key.Key_Return)
        yield lambda: "line 1 left" in window.lines.rows and window.is_settled()
        left, right = window.session.design.own_lines
        assert left.free
        assert right == mirror_image(left, TEMPLATE, "line 1 right")
        shown = window.view.viewport.scene.bands.ribbon("line 1 left")
        middle = shown.mesh.vertices.reshape(shown.rows, shown.columns, 3)[3:-3].mean(axis=1)
        away = np.linalg.norm(middle[:, None] - resample(drawn, 0.5), axis=2).min(axis=1)
        assert away.max() < 3.0, "its middle on the skin, a few mm under its cloth"
        assert found.deviation < 1.0
        assert window.lines.rows["line 1 left"].view.over_shoulder is None, "it ends on the breast"
        window.session.commit_line("line 1 left", "Line 1", 0.95)
        yield settled(window)
        assert window.session.frame.lengths["line 1 left"] < 0.99 * found_length(window, "line 1 left")
        window.lines.rows["line 1 left"].details.requested.emit("path")
        assert drawing.at_work
        click(window, at(2, 2), at(5, 2))
        window.view.viewport.setFocus()
        press(window, Qt.Key.Key_Return)
        press(window, Qt.Key.Key_Return)
        yield settled(window)
        again, other = window.session.design.own_lines
        assert again.name == "line 1 left"
        assert again != left
        assert other == mirror_image(again, TEMPLATE, "line 1 right")
        assert window.session.design.ratio("line 1 left") == 0.95

    run_main([], script)


def found_length(window: MainWindow, name: str) -> float:
    """The length of a line at rest."""
    lines = {line.name: line for line in window.session.frame.stages.model.lines}
    return lines[name].rest_length


def led_elsewhere(window: MainWindow, path: tuple[int, ...]) -> Script:
    """Drag one point of the line to its neighbour, and take its last one out; the mirror image follows."""
    canvas = window.view.viewport.overlay.parentWidget()
    window.lines.rows["line 1 left"].details.requested.emit("path")
    here, there = spot(window, path[2]), spot(window, at(4, 3))
    QTest.mousePress(canvas, Qt.MouseButton.LeftButton, pos=here)
    for part in (0.4, 1.0):
        QTest.mouseMove(canvas, here + (there - here) * part)
    QTest.mouseRelease(canvas, Qt.MouseButton.LeftButton, pos=there)
    click(window, path[-1])
    led = (path[0], path[1], at(4, 3), path[3])
    assert window.path_tool._steps[-1] == led
    click(window, path[-1])
    assert window.path_tool._steps[-1] == (*led, path[-1])
    press(window, Qt.Key.Key_Backspace)
    press(window, Qt.Key.Key_Return)
    own = {line.name: line.points for line in window.session.design.own_lines}
    assert own == {"line 1 left": led, "line 1 right": mirrored(led, TEMPLATE)}
    assert window.session.undo_stack.undoText() == "Line 1: path changed"
    window.actions_.undo.trigger()
    assert window.session.design.own_lines[0].points == path
    yield settled(window)


def let_go_of(window: MainWindow) -> Script:
    """What is drawn ends with its control mesh or its line, and never takes the place of another line."""
    session, drawing, routing = window.session, window.draw_tool, window.path_tool
    session.edit(lambda design: design.without_custom_line("line 1 left"), "one side away")
    drawing._keep({"bust": Snapped((at(2, 2), at(3, 2)), closed=False, deviation=0.0, is_movable=True)})
    assert [line.name for line in session.design.own_lines] == ["line 1 right", "line 2 left", "line 2 right"]
    routing.begin("line 2 right")
    assert routing._sketching.at_work
    while session.design.own_lines:
        window.actions_.undo.trigger()
    assert not routing._sketching.at_work
    assert not window.view.tools.actions_by_name["control-mesh"].isChecked()
    yield settled(window)
    window.actions_.draw_line.trigger()
    session.choose_template("120")
    assert not drawing._sketching.at_work
    window.actions_.draw_line.trigger()
    assert not drawing._sketching.at_work, "the body that is shown still has the other mesh"
    window.actions_.undo.trigger()
    # The design is that of the frame at once; the other control mesh may be on its way all the same.
    yield lambda: window.is_settled() and session.frame.revision == session._revision
    ways, drawing._ways, jobs = drawing._ways[1], None, window.jobs
    for _ in range(3):
        window.actions_.draw_line.trigger()
    preparing = [job for job in jobs.at_work() if job.words == "Preparing skin for drawing…"]
    assert len(preparing) == 1, "the skin is made ready once"
    drawing._take_ways(replace(session.frame.stages.body), ways)
    assert drawing._ways is None, "that was another body"
    drawing._take_ways(session.frame.stages.body, ways)
    jobs.cancel(drawing._job)
    drawing.leave()


def a_ring(window: MainWindow) -> Script:
    """A click on the first point closes a line; Esc leaves without one."""
    drawing = window.draw_tool
    ring = [at(2, 3), at(3, 4), at(4, 3), at(3, 2)]
    window.activateWindow()
    yield window.isActiveWindow
    press(window, Qt.Key.Key_N)
    assert drawing.at_work
    click(window, *ring)
    assert len(drawing._places) == len(ring)
    click(window, ring[0])
    assert drawing._found["bust"].closed
    card = drawing._sketching.card
    assert isinstance(drawing._found["bust"], Snapped) == card.snap.isChecked()
    card.snap.setChecked(True)
    assert set(ring) <= set(drawing._found["bust"].path)
    card.snap.setChecked(False)
    assert drawing._found["bust"].deviation < 1.0
    press(window, Qt.Key.Key_Escape)
    assert not drawing._sketching.at_work
    assert window.session.design.own_lines == ()
    yield settled(window)
