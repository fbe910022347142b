"""The live plot through the real main(): edits on its axis, turns slow enough to see, what is saved."""

from __future__ import annotations

import csv
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QSettings
from PySide6.QtGui import QImage
from PySide6.QtSvg import QSvgRenderer
from window_tools import Script, drag, run_bodiless, settled

import app.gui.features.convergence.controller
from app.gui.main_window import MainWindow
from app.presenters.measurements import measure_views
from app.presenters.plots import PLOTTED_TURNS, tracks
from core.pipeline.live_solver import Frame

pytestmark = pytest.mark.usefixtures("empty_house")


def test_turns_can_be_watched_marked_and_saved(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        app.gui.features.convergence.controller, "ask_save", lambda *given: str(tmp_path / given[2])
    )

    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield from each_turn_is_seen_while_they_are_slow(window)
        yield from an_edit_is_marked_where_it_was_made(window)
        what_is_plotted_is_what_was_made(window)
        measures_are_worked_out_only_where_they_are_seen(window)
        the_saved_table_holds_every_turn(window, tmp_path)
        what_is_plotted_is_saved_as_it_is_seen(window, tmp_path)

    run_bodiless([], script)


def each_turn_is_seen_while_they_are_slow(window: MainWindow) -> Script:
    seen: list[Frame] = []
    window.convergence_controller.slow.trigger()
    window.lines.length_committed.emit("mid-bust", 0.9)
    design = window.session.design
    window.session.frame_ready.connect(seen.append)
    shown: dict[int, Frame] = {}  # by iteration: a frame that answers a request need not bring another

    def enough() -> bool:
        mine = [frame for frame in seen if frame.stages.design is design]
        shown.update((frame.tracks["adaptive"][-1].iteration, frame) for frame in mine)
        return len(shown) > 8

    yield enough
    assert list(shown) == list(range(min(shown), max(shown) + 1)), "no iteration is left out"
    moves = [np.abs(one.points - other.points).max() for one, other in pairwise(shown.values())]
    assert min(moves) > 0.0, "each is to be seen on the body"
    assert {frame.verdict.motion for frame in shown.values()} == {"settling"}, "and the verdict waits"
    window.session.frame_ready.disconnect(seen.append)
    window.convergence_controller.slow.trigger()
    yield settled(window)


def an_edit_is_marked_where_it_was_made(window: MainWindow) -> Script:
    plot = window.strip.error_plot.canvas
    window.throttled.flush()
    (mark,) = plot.plotted.events
    assert mark.turn == 0.0
    assert "90.0 %" in mark.words
    drag(window, "mid-bust", -20, release=False)
    yield lambda: (frame := window.session.frame) is not None and frame.tracks["adaptive"][-1].iteration > 3
    drag(window, "mid-bust", -24)
    yield settled(window)
    window.throttled.flush()
    frame, words = window.session.frame, window.session.undo_stack.undoText()
    assert frame is not None
    assert (plot.plotted.events[-1].turn, plot.plotted.events[-1].words) == (frame.changed_at, words)
    plot.point_at(float(frame.changed_at))
    assert plot.readout()[-1][0] == words


def what_is_plotted_is_what_was_made(window: MainWindow) -> None:
    frame = window.session.frame
    assert frame is not None
    rest = frame.stages.rest_marks
    for control, track in tracks(frame).items():
        rows = [row for row in frame.tracks[control] if row.marks is not None][-PLOTTED_TURNS:]
        assert len(rows) > 3
        for place in (0, len(rows) // 2, -1):
            row, marks = rows[place], rows[place].marks
            assert marks is not None
            left, right = (
                marks.bust_point_left_z - rest.bust_point_left_z,
                marks.bust_point_right_z - rest.bust_point_right_z,
            )
            said = (row.iteration, 100.0 * row.error, row.error_ml, marks.apex_z - rest.apex_z)
            drawn = (track.turns, track.error_percent, track.error_ml, track.apex_mm)
            assert tuple(each[place] for each in drawn) == said
            assert track.bust_mm[place] == 0.5 * (left + right)


def measures_are_worked_out_only_where_they_are_seen(window: MainWindow) -> None:
    frame, table = window.session.frame, window.result
    assert frame is not None
    assert not window.result.isVisible()
    assert list(table.rows) != measure_views(frame), "nobody has seen them yet"
    window.navigation.show_step("result")
    assert list(table.rows) == measure_views(frame)
    window.navigation.show_step("lines")


def the_saved_table_holds_every_turn(window: MainWindow, folder: Path) -> None:
    window.strip.export_requested.emit("csv")
    with open(folder / "mannequin-turns.csv", newline="", encoding="utf-8-sig") as file:
        heading, *rows = csv.reader(file)
    frame = window.session.frame
    assert frame is not None
    assert heading[:4] == ["run", "iteration", "volume error [%]", "volume error [ml]"]
    made = {control: [row for row in rows if row[0] == control] for control in frame.tracks}
    for control, records in frame.tracks.items():
        assert [int(row[1]) for row in made[control]] == [record.iteration for record in records]
        assert [float(row[3]) for row in made[control]] == [record.error_ml for record in records]
        assert [float(row[7]) for row in made[control]] == [record.lengths[0] for record in records]
    rest = frame.stages.rest_marks.apex_z
    assert float(made["adaptive"][-1][5]) == frame.marks.apex_z - rest


def what_is_plotted_is_saved_as_it_is_seen(window: MainWindow, folder: Path) -> None:
    ml = next(each for each in window.strip.error_plot.title.menu.actions() if "ml" in each.text())
    ml.trigger()
    assert QSettings().value("plot/error") == "error_ml"
    for kind in ("png", "svg"):
        window.strip.export_requested.emit(kind)
    image = QImage(str(folder / "mannequin-turns.png"))
    assert (image.width(), image.height()) == (2880, 1020)
    inked = {image.pixelColor(x, y).name() for x in range(0, 2880, 3) for y in range(0, 1020, 3)}
    assert {"#ffffff", "#2459cf"} <= inked
    assert QSvgRenderer(str(folder / "mannequin-turns.svg")).isValid()
    drawn = (folder / "mannequin-turns.svg").read_text("utf-8")
    assert "Volume error" in drawn
    assert ">ml<" in drawn
