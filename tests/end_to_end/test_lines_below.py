"""Own lines below the bust: drawn there, over both regions as one band, mirrored, undone, saved."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from window_tools import Script, drag, run_main, settled

from app.gui.main_window import MainWindow
from app.presenters.samples import sample_path
from core.document.storage.project_file import open_project
from core.garment.cut_list import cut_list_of

pytestmark = pytest.mark.usefixtures("empty_house")

TRUNK = str(sample_path("trunk"))


def click(window: MainWindow, *cells: tuple[str, int, int]) -> None:
    """Click on control points as they are seen, each by region, row and column."""
    viewport, stages = window.view.viewport, window.session.frame.stages
    canvas = viewport.overlay.parentWidget()
    for region, row, column in cells:
        control = stages.fitted if region == "bust" else stages.lower.fitted
        (point, *_) = np.flatnonzero((control.row == row) & (control.column == column))
        places = viewport.scene.carried_points(control.mesh.vertices[[point]])
        x, y, _ = viewport.scene.view.to_picture(places, viewport.overlay.width(), viewport.overlay.height())[
            0
        ]
        QTest.mouseMove(canvas, QPoint(round(x), round(y)))
        QTest.mouseClick(canvas, Qt.MouseButton.LeftButton, pos=QPoint(round(x), round(y)))


def press(window: MainWindow, key: Qt.Key) -> None:
    window.view.viewport.setFocus()
    QTest.keyClick(window.view.viewport, key)


def begun(window: MainWindow) -> Script:
    """Add the region below the bust, and begin to draw."""
    yield settled(window)
    window.lines_controller.add_lower_trunk()
    yield lambda: window.session.frame.stages.lower is not None and window.is_settled()
    window.view.viewport.set_view("front")
    window.actions_.draw_line.trigger()
    yield lambda: window.draw_tool._ways is not None


def test_a_line_on_the_belly_is_drawn_set_and_taken_back() -> None:
    def script(window: MainWindow) -> Script:
        session, drawing = window.session, window.draw_tool
        yield from begun(window)
        click(window, ("lower", 5, -4), ("lower", 4, 1), ("lower", 5, 4))
        press(window, Qt.Key.Key_Return)
        assert list(drawing._found) == ["lower"]
        assert drawing._found["lower"].deviation < 1.0
        drawing._sketching.card.snap.click()
        assert max(drawing._found["lower"].path) < drawing._sketching.frame.stages.lower.fitted.row.size
        drawing._sketching.card.snap.click()
        press(window, Qt.Key.Key_Return)
        yield lambda: "line 1" in window.lines.rows and window.is_settled()
        row = window.lines.rows["line 1"]
        assert row.view.group == "waist"
        assert (row.view.own, row.view.constrained, row.view.splits) == (True, True, False)
        assert window.view.viewport.scene.bands.ribbon("line 1") is not None, "drawn, though it is off"
        rest = session.frame.line_lengths["line 1"]
        drag(window, "line 1", -12)
        yield settled(window)
        assert session.frame.line_lengths["line 1"] < rest - 3.0
        assert session.frame.stages.design.lower_design.active_lines() == {"line 1"}
        window.lines.removed.emit("line 1")
        yield settled(window)
        assert "line 1" not in window.lines.rows
        session.undo_stack.undo()
        yield settled(window)
        assert session.frame.line_lengths["line 1"] < rest - 3.0

    run_main([TRUNK], script)


def test_a_line_over_bust_and_waist_is_one_band(tmp_path: Path) -> None:
    def script(window: MainWindow) -> Script:
        session, drawing = window.session, window.draw_tool
        yield from begun(window)
        click(window, ("bust", 3, 2), ("lower", 2, 2), ("lower", 5, 1))
        press(window, Qt.Key.Key_Return)
        assert list(drawing._found) == ["bust", "lower"]
        drawing._sketching.card.both.setChecked(True)
        press(window, Qt.Key.Key_Return)
        yield lambda: "line 1 left" in window.lines.rows and window.is_settled()
        row = window.lines.rows["line 1 left"]
        assert row.view.names == ("line 1 left", "line 1 right", "line 1 lower left", "line 1 lower right")
        assert not any(name in window.lines.rows for name in row.view.names[1:]), "one row for all of it"
        rest = {name: session.frame.line_lengths[name] for name in row.view.names}
        assert row.view.rest_mm == pytest.approx(0.5 * sum(rest.values()), rel=1e-6)
        session.commit_line("line 1 left", "Line 1", 0.94)
        yield settled(window)
        reached = session.frame.line_lengths
        assert all(reached[name] < rest[name] - 0.5 for name in rest)
        assert session.undo_stack.undoText() == "Line 1 94.0 %"
        (left, right) = cut_list_of(session.frame).rows
        assert (left.line, right.line) == ("line 1 left", "line 1 right")
        together = reached["line 1 left"] + reached["line 1 lower left"]
        assert left.reached_front_mm == pytest.approx(together)
        assert session.save(str(tmp_path / "band.busk"), None)
        yield (tmp_path / "band.busk").exists
        assert open_project(str(tmp_path / "band.busk")).design.own_lines == session.design.own_lines
        window.lines.removed.emit("line 1 left")
        yield settled(window)
        assert session.design.own_lines == ()

    run_main([TRUNK], script)
