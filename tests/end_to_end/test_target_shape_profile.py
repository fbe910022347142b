"""Profiles are drawn on the body, and the foremost place is dragged, while the result is asked for."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from ask_tools import answered, drag, wear
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_undrawn, settled

from app.gui.main_window import MainWindow
from app.gui.viewport.target_handle import TargetCurve

pytestmark = pytest.mark.usefixtures("empty_house")


def choose(window: MainWindow, kind: str) -> None:
    """Click one of the three words that say what is dragged."""
    window.target_shape_controller.card.hand._buttons[kind].click()


def draws_a_profile(window: MainWindow) -> Script:
    yield wear(window)
    window.layout_.give_up()
    desk, viewport = window.target_shape_controller, window.view.viewport
    desk.begin()
    yield answered(window)
    choose(window, "profile")
    yield answered(window)
    handles = desk.handles.profile.handles["profile left"]
    assert viewport.view.name == "left", "a profile is seen from its side"
    assert all(handle.isVisible() for handle in handles)
    assert not any(handle.isVisible() for handle in desk.handles.by_name.values())
    curve = viewport.overlay.parentWidget().findChild(TargetCurve)
    assert curve.isVisible()
    assert np.abs(curve._wished - curve._reached).max() < 0.5, "it begins with the skin"
    # Nothing lies under the tools, nothing over another.
    top = window.view.floating.seen(window.view.tools).top()
    spots = [handle.mapTo(window.view, handle.rect().center()) for handle in handles]
    assert max(spot.y() for spot in spots) + 13 < top
    assert min(abs(a.y() - b.y()) for a, b in pairwise(spots)) >= 20
    assert desk.goals() == (), "nothing is asked for before it is drawn"
    assert not desk.card.apply.isEnabled()
    assert "Drag the handles of the curve" in desk.card.hint.text()


def wishes_what_is_dragged(window: MainWindow) -> Script:
    desk, viewport = window.target_shape_controller, window.view.viewport
    handles = desk.handles.profile.handles["profile left"]
    curve = viewport.overlay.parentWidget().findChild(TargetCurve)
    # Dragged, it is wished; the body follows, and how far it is off is told.
    middle = len(handles) // 2
    drag(handles[middle], 12, 0, drop=False)
    assert desk.work.at_work
    assert curve._wished[:, 1].max() > curve._reached[:, 1].min()
    QTest.mouseRelease(handles[middle], Qt.MouseButton.LeftButton)
    yield answered(window)
    scale = 2.0 * viewport.view.half_height / viewport.height()
    drawn = desk.drawn["profile left"]
    assert drawn.steps[middle] == pytest.approx([0.0, -12.0 * scale], abs=0.2 * 12.0 * scale)
    assert desk.answer.reply is not None
    assert not desk.answer.question.hurried
    assert "Other changes: Bust point" in desk.card.price.text(), "what is free may move as well"
    words = desk.card.wishes["profile left"].now.text()
    assert words.startswith("mean deviation ")
    off = np.array([desk.answer.reply.reached[goal.name] - goal.value for goal in desk.goals()])
    assert words == f"mean deviation {np.abs(off).mean():.1f} mm, maximum {np.abs(off).max():.1f} mm"
    # Esc gives the curve back while it is in the hand.
    drag(handles[0], 30, 0, drop=False)
    assert desk.drawn["profile left"] is not drawn
    window.progress_controller.cancel()
    yield answered(window)
    assert desk.drawn["profile left"].steps == pytest.approx(drawn.steps)


def tells_lines_that_are_tried_on(window: MainWindow) -> Script:
    """They look so until they are taken."""
    desk = window.target_shape_controller
    row = window.lines.rows["full-bust"]
    assert row.view.tried == (abs(row.view.ratio - 0.98) >= 5e-4)
    tried = next(row for row in window.lines.rows.values() if row.view.tried)
    assert tried.percent.property("tried") == "yes"
    assert "Apply" in tried.percent.toolTip()
    desk.card.apply.click()
    yield settled(window)
    assert not any(row.view.tried for row in window.lines.rows.values())
    assert window.session.undo_stack.undoText() == "Targets: Profile through the left bust point"
    assert not any(handle.isVisible() for handle in desk.handles.profile.all())


def takes_a_table(window: MainWindow, tmp_path: Path) -> Script:
    desk = window.target_shape_controller
    desk.begin()
    yield answered(window)
    desk.drawing.begin("right")
    yield answered(window)
    assert window.view.viewport.view.name == "right"
    profile = desk.drawn["profile right"]
    rows = "\n".join(f"{height:.3f},{out - 1.0:.3f}" for height, out in profile.base.tolist())
    path = tmp_path / "wish.csv"
    path.write_text(f"height_mm,out_mm\n{rows}\n", encoding="utf-8")
    desk.drawing.take_table("right", str(path))
    yield answered(window)
    assert desk.answer.reply is not None, "a table is asked for at once"
    assert desk.handles.profile.handles["profile right"][0].isVisible()
    desk.card.wishes["profile right"].remove.click()
    yield answered(window)
    assert desk.handles.kind == "bust", "with the last profile its handles go"
    assert not any(handle.isVisible() for handle in desk.handles.profile.all())
    desk.leave()
    yield settled(window)


def drags_the_foremost_place(window: MainWindow) -> Script:
    desk = window.target_shape_controller
    window.view.viewport.set_view("left")
    desk.begin()
    yield answered(window)
    choose(window, "apex")
    yield answered(window)
    assert list(desk.wishes) == ["apex lift", "apex out"], "free ones of the other place are gone"
    left, frame = desk.handles.by_name["bust_left"], window.session.frame
    foot = frame.stages.watch.apex_places(frame.control_points)[0]
    assert left._foot == pytest.approx(foot)
    assert foot[1:] == pytest.approx(frame.stages.watch.apexes(frame.control_points)[0])
    now = dict(desk.answer.now)
    QTest.keyClick(left, Qt.Key.Key_Up)
    yield answered(window)
    assert desk.wishes["apex lift"] == pytest.approx(now["apex lift"] + 1.0, abs=0.02)
    assert desk.wishes["apex out"] is None
    assert left._place[2] - left._foot[2] == pytest.approx(
        desk.wishes["apex lift"] - desk.answer.then["apex lift"], abs=0.02
    )
    choose(window, "bust")
    assert list(desk.wishes) == ["apex lift", "lift", "out"], "what is asked for stays"
    yield answered(window)
    field = desk.card.wishes["lift"].field
    field.setFocus()
    QTest.keyClick(field, Qt.Key.Key_Escape)
    assert not desk.is_open, "nothing was typed: one Esc is enough"
    yield settled(window)


def test_profiles_and_foremost_places_are_dragged(tmp_path: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield from draws_a_profile(window)
        yield from wishes_what_is_dragged(window)
        yield from tells_lines_that_are_tried_on(window)
        yield from takes_a_table(window, tmp_path)
        yield from drags_the_foremost_place(window)

    run_undrawn([], script)
