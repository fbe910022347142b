"""The selected band in the hand: pulled, given back, refused, resisting, through the real main()."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hand_tools import LEFT, PLAIN, SHIFT, move, press, release
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from window_tools import Script, points, run_main, settled, undrawn

from app.gui.features.lines.band_drag import STEP
from app.gui.features.lines.slider import RESISTANCE
from app.gui.main_window import MainWindow
from app.gui.widgets.tooltip import shown_tip
from core.analysis.length_limits.zones import LengthLimits, Reason, Zone

pytestmark = pytest.mark.usefixtures("empty_house")


def canvas_of(window: MainWindow) -> QWidget:
    canvas = window.view.viewport.overlay.parentWidget()
    assert canvas is not None
    return canvas


def on_band(window: MainWindow, name: str) -> QPoint:
    """Return a pixel on a band in front of the body."""
    view = window.view.viewport
    spine, normals = view.scene.bands.spine(name)
    front = (normals @ view.scene.view.axes[2]).argsort()[::-1]
    for x, y, _ in view.scene.view.to_picture(spine[front], view.width(), view.height()):
        if view.scene.band_at(x, y, view.width(), view.height()) == name:
            return QPoint(round(x), round(y))
    raise AssertionError(f"{name} is not seen")


def pull(window: MainWindow, start: QPoint, way: QPoint, held: Qt.KeyboardModifier = PLAIN) -> None:
    """Press there and move so far; the button stays down."""
    canvas = canvas_of(window)
    press(canvas, start, held)
    for part in (0.25, 0.5, 1.0):
        move(canvas, start + part * way, held)


def hover(window: MainWindow, at: QPoint) -> Qt.CursorShape:
    move(canvas_of(window), at, button=Qt.MouseButton.NoButton)
    return canvas_of(window).cursor().shape()


def test_the_selected_band_is_pulled_shorter_and_longer() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.view.viewport.set_view("front")
        yield from a_pull_is_live_and_one_undo_step(window)
        yield from escape_brings_the_band_back(window)
        a_press_selects_and_drags_beside_or_across_turn(window)
        yield from shift_pulls_finely(window)
        another_button_leaves_the_band_in_the_hand(window)
        yield settled(window)

    run_main([], script)


def ratio_of(window: MainWindow, name: str = "mid-bust") -> float:
    assert window.session.design is not None
    return window.session.design.ratio(name)


def a_pull_is_live_and_one_undo_step(window: MainWindow) -> Script:
    stack, start, at_start = window.session.undo_stack, on_band(window, "mid-bust"), points(window).copy()
    seen, ratio = window.view.viewport.scene.view, ratio_of(window)
    assert hover(window, start) == Qt.CursorShape.SizeVerCursor
    assert hover(window, on_band(window, "full-bust")) == Qt.CursorShape.PointingHandCursor
    pull(window, start, QPoint(0, -30))
    yield lambda: np.abs(points(window) - at_start).max() > 0.5
    assert stack.count() == 0
    yield lambda: f"{100 * ratio - 3:.1f} %" in window.view.viewport._labels.band[1]
    assert "mm" in window.view.viewport._labels.band[2]
    yield lambda: window.lines.rows["mid-bust"].slider.ratio() == pytest.approx(ratio - 0.03)
    release(canvas_of(window), start + QPoint(0, -30))
    assert ratio_of(window) == pytest.approx(ratio - 30 * STEP)
    assert stack.count() == 1
    assert f"{100 * ratio - 3:.1f}" in stack.undoText()
    assert window.view.viewport.scene.view == seen
    pull(window, on_band(window, "mid-bust"), QPoint(0, 10))
    release(canvas_of(window), start)
    assert ratio_of(window) == pytest.approx(ratio - 20 * STEP)
    assert stack.count() == 2, "the next pull is a step of its own"
    stack.setIndex(0)
    yield settled(window)
    assert ratio_of(window) == pytest.approx(ratio)


def escape_brings_the_band_back(window: MainWindow) -> Script:
    design, start, at_start = window.session.design, on_band(window, "mid-bust"), points(window).copy()
    pull(window, start, QPoint(0, -40))
    yield lambda: np.abs(points(window) - at_start).max() > 0.5
    window.activateWindow()
    yield window.isActiveWindow
    QTest.keyClick(window, Qt.Key.Key_Escape)
    yield settled(window)
    assert np.abs(points(window) - at_start).max() < 0.2
    move(canvas_of(window), start + QPoint(0, -90))
    release(canvas_of(window), start + QPoint(0, -90))
    yield settled(window)
    assert window.session.design is design
    assert window.session.undo_stack.index() == 0


def a_press_selects_and_drags_beside_or_across_turn(window: MainWindow) -> None:
    view, design = window.view.viewport, window.session.design
    first = view.scene.view
    at = on_band(window, "mid-bust")
    for start, way in ((at, QPoint(40, 8)), (at + QPoint(0, -90), QPoint(0, 40))):
        pull(window, start, way)
        release(canvas_of(window), start + way)
        assert view.scene.view != first, "across the band, or beside it, a drag turns the body"
        view.look_from(first)
    other = on_band(window, "full-bust")
    pull(window, other, QPoint(0, -40))  # not selected: it turns
    release(canvas_of(window), other + QPoint(0, -40))
    assert view.scene.view != first
    view.look_from(first)
    QTest.mouseClick(canvas_of(window), LEFT, PLAIN, other)
    assert window.view.selected_line == "full-bust"
    QTest.mouseClick(canvas_of(window), LEFT, PLAIN, at)
    assert window.view.selected_line == "mid-bust"
    window.view.set_after(False)
    assert hover(window, on_band(window, "mid-bust")) == Qt.CursorShape.PointingHandCursor
    window.view.set_after(True)
    assert window.session.design is design
    window.draw_tool.begin()
    pull(window, at, QPoint(0, -40))
    release(canvas_of(window), at + QPoint(0, -40))
    assert view.scene.view != first, "who draws a line turns the body by a drag anywhere"
    window.draw_tool.leave()
    view.look_from(first)
    assert window.session.design is design


def shift_pulls_finely(window: MainWindow) -> Script:
    start, ratio = on_band(window, "mid-bust"), ratio_of(window)
    seen = window.view.viewport.scene.view
    pull(window, start, QPoint(0, 24), SHIFT)
    release(canvas_of(window), start)
    assert ratio_of(window) == pytest.approx(ratio + 0.1 * 24 * STEP)
    assert window.view.viewport.scene.view == seen
    yield settled(window)


def another_button_leaves_the_band_in_the_hand(window: MainWindow) -> None:
    start, ratio, other = on_band(window, "mid-bust"), ratio_of(window), Qt.MouseButton.RightButton
    seen = window.view.viewport.scene.view
    pull(window, start, QPoint(0, -20))
    QTest.mousePress(canvas_of(window), other, PLAIN, start)
    QTest.mouseRelease(canvas_of(window), other, PLAIN, start)
    move(canvas_of(window), start + QPoint(0, -30))
    release(canvas_of(window), start + QPoint(0, -30))
    assert not window.band_drag_controller.carries
    assert ratio_of(window) == pytest.approx(ratio - 30 * STEP, abs=STEP)  # in whole tenths of a percent
    assert window.view.viewport.scene.view == seen


def test_a_pulled_band_minds_links_locks_and_limits() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        undrawn(window)
        window.view.viewport.set_view("front")
        the_red_resists_as_in_the_slider(window)
        yield settled(window)
        window.lines_controller.decide("mid-bust", "locked", True)
        yield from a_locked_band_says_so_and_stays(window)
        window.add_lines_controller.add("straps")
        yield settled(window)
        window.throttled.flush()
        linked_bands_go_together(window)
        window.selection.select_line("under-bust")
        assert hover(window, on_band(window, "under-bust")) == Qt.CursorShape.PointingHandCursor
        yield settled(window)

    run_main([], script)


def the_red_resists_as_in_the_slider(window: MainWindow) -> None:
    ratio, start = ratio_of(window), on_band(window, "mid-bust")
    wall = ratio - 0.01
    red = Zone("red", 0.5, wall, (Reason("folded", 0.5, wall),))
    leeway = LengthLimits("mid-bust", (red, Zone("green", wall, 1.3)))
    lines = window.lines_controller
    lines.sources = replace(lines.sources, limits=lambda _: {"mid-bust": (leeway, False)})
    window.lines_controller.show_rows()
    pull(window, start, QPoint(0, -10 - round(RESISTANCE) + 2))
    assert window.band_drag_controller._ratio == pytest.approx(ratio - 0.01)
    assert f"folded below {100 * (ratio - 0.01):.1f} %" in shown_tip(window)
    move(canvas_of(window), start + QPoint(0, -10 - round(RESISTANCE) - 5))
    release(canvas_of(window), start)
    assert ratio_of(window) == pytest.approx(ratio - 0.015)


def a_locked_band_says_so_and_stays(window: MainWindow) -> Script:
    yield settled(window)
    window.throttled.flush()
    design, seen = window.session.design, window.view.viewport.scene.view
    at = on_band(window, "mid-bust")
    assert hover(window, at) == Qt.CursorShape.ForbiddenCursor
    pull(window, at, QPoint(0, -40))
    assert "locked" in shown_tip(window)
    release(canvas_of(window), at)
    assert window.session.design is design
    assert window.view.viewport.scene.view == seen


def linked_bands_go_together(window: MainWindow) -> None:
    window.selection.select_line("strap right")
    pull(window, on_band(window, "strap right"), QPoint(0, -20))
    release(canvas_of(window), QPoint(5, 5))
    assert ratio_of(window, "strap right") == ratio_of(window, "strap left") == pytest.approx(1.0 - 20 * STEP)
