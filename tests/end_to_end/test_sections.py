"""The section plane in the hand: its handle in every view, its panel, through the real main()."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hand_tools import PLAIN, SHIFT, move, press, release
from PySide6.QtCore import QEvent, QObject, QPoint, QSize, Qt
from window_tools import Script, run_main, settled, undrawn

from app.gui.main_window import MainWindow
from app.gui.viewport.plane_handle import PlaneHandle
from app.gui.viewport.viewport import Viewport

pytestmark = pytest.mark.usefixtures("empty_house")


def place_of(window: MainWindow) -> float:
    """Return where the plane is on its axis [mm]."""
    slicer = window.sections_controller._slicer
    assert slicer is not None
    return slicer.plane.at


def handle_of(viewport: Viewport) -> PlaneHandle:
    handle = viewport.findChild(PlaneHandle)
    assert handle is not None
    return handle


def test_the_section_plane_is_dragged_in_every_view() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        undrawn(window)
        section = window.sections_controller
        section.set_on(True)
        for axis, view in (("x", "front"), ("z", "front"), ("y", "left"), ("x", "three-quarter")):
            window.view.viewport.set_view(view)
            section.choose_axis(axis)
            section.go_through("left")
            the_handle_follows_the_hand_along_the_normal(window)
        a_plane_that_faces_the_eye_is_dragged_up_and_down(window)
        shift_is_fine_and_escape_brings_it_back(window)
        the_handle_stays_where_it_is_seen(window)
        a_picture_is_saved_without_the_handle(window)
        for way in ("wipe", "side"):
            window.view.compare_by(way)
            the_hand_on_one_side_cuts_both(window)
        a_plane_that_is_taken_away_is_in_no_hand(window)
        assert handle_of(window.view.viewport).isHidden()

    run_main([], script)


def drag_handle(handle: PlaneHandle, way: np.ndarray, held: Qt.KeyboardModifier = PLAIN) -> None:
    """Press the handle and move the pointer over the view by ``way`` [px]; the button stays down."""
    start = handle.rect().center()
    press(handle, start, held)
    ends = handle.mapToGlobal(start) + QPoint(*np.round(way).astype(int).tolist())
    for part in (0.5, 1.0):
        there = handle.mapToGlobal(start)
        move(handle, handle.mapFromGlobal(there + part * (ends - there)), held)


def the_handle_follows_the_hand_along_the_normal(window: MainWindow) -> None:
    section, handle = window.sections_controller, handle_of(window.view.viewport)
    assert handle.isVisible()
    assert handle.cursor().shape() == Qt.CursorShape.OpenHandCursor
    before = {role: np.concatenate([c.places for c in curves]) for role, curves in section.curves.items()}
    at, start = place_of(window), handle.geometry().center()
    way = handle._way / np.linalg.norm(handle._way)
    across = np.array([-way[1], way[0]])
    drag_handle(handle, 40.0 * way + 20.0 * across)
    assert handle.cursor().shape() == Qt.CursorShape.ClosedHandCursor
    gone = handle.geometry().center() - start
    assert np.array([gone.x(), gone.y()]) == pytest.approx(40.0 * way, abs=3.0)  # not across
    assert place_of(window) > at + 5.0
    for role, former in before.items():
        now = np.concatenate([c.places for c in section.curves[role]])
        assert now.shape != former.shape or np.abs(now - former).max() > 0.5  # both, live
    curve = window.view.viewport.scene.section.curve
    assert curve[:, "xyz".index(section.axis)] == pytest.approx(place_of(window), abs=0.06)
    release(handle, handle.rect().center())
    assert handle.cursor().shape() == Qt.CursorShape.OpenHandCursor
    assert not window.actions_.cancel.isEnabled()


def a_plane_that_faces_the_eye_is_dragged_up_and_down(window: MainWindow) -> None:
    section, handle = window.sections_controller, handle_of(window.view.viewport)
    window.view.viewport.set_view("front")
    assert not handle.at_eye
    assert "away from you" not in handle.toolTip()
    section.choose_axis("y")
    assert handle.at_eye
    assert "Drag up to move the plane away from you" in handle.toolTip(), (
        "arrows up and down alone would tell another way"
    )
    at = place_of(window)
    drag_handle(handle, np.array([0.0, -30.0]))
    release(handle, handle.rect().center())
    assert place_of(window) > at + 5.0  # up is away from the eye


def shift_is_fine_and_escape_brings_it_back(window: MainWindow) -> None:
    section, handle = window.sections_controller, handle_of(window.view.viewport)
    section.choose_axis("x")
    section.go_through("right")
    place = place_of(window)
    drag_handle(handle, np.array([30.0, 0.0]))
    coarse = place_of(window) - place
    assert window.actions_.cancel.isEnabled()
    window.actions_.cancel.trigger()
    assert place_of(window) == place
    move(handle, handle.rect().center() + QPoint(50, 0))
    assert place_of(window) == place  # it has been let go of
    release(handle, handle.rect().center())
    section.go_through("left")
    assert place_of(window) != place  # still through a bust point, not left by hand
    section.go_through("right")
    drag_handle(handle, np.array([30.0, 0.0]), SHIFT)
    assert place_of(window) - place == pytest.approx(0.1 * coarse, abs=0.3)
    release(handle, handle.rect().center())
    drag_handle(handle, np.array([2000.0, 0.0]))
    assert section.panel.slider.value() == section.panel.slider.maximum()  # not out of the body
    release(handle, handle.rect().center())


def the_handle_stays_where_it_is_seen(window: MainWindow) -> None:
    view, handle = window.view.viewport, handle_of(window.view.viewport)
    window.sections_controller.go_through("left")
    for name in ("front", "left", "back", "three-quarter", "top"):
        for framed in (view.frame_all, view.frame_bust):
            view.set_view(name)
            framed()
            assert view.rect().contains(handle.geometry()), name
            assert not handle.geometry().intersects(window.view.compare.geometry())


def a_picture_is_saved_without_the_handle(window: MainWindow) -> None:
    handle = handle_of(window.view.viewport)
    shown = [handle.isVisible()]
    handle.installEventFilter(heard := Heard(shown))
    window.view.picture()
    handle.removeEventFilter(heard)
    assert shown == [True, False, True]


def test_a_panel_that_was_folded_is_folded_at_the_next_start(mannequin: Path) -> None:
    def fold(window: MainWindow) -> Script:
        yield settled(window)
        undrawn(window)
        panel = window.sections_controller.panel
        assert not panel.is_folded
        panel.fold.click()
        assert panel.is_folded

    def unfold(window: MainWindow) -> Script:
        yield settled(window)
        undrawn(window)
        panel = window.sections_controller.panel
        assert panel.is_folded
        panel.fold.click()

    def look(window: MainWindow) -> Script:
        yield settled(window)
        undrawn(window)
        assert not window.sections_controller.panel.is_folded

    for script in (fold, unfold, look):
        run_main([str(mannequin)], script)


class Heard(QObject):
    """Notes when a widget is hidden and shown."""

    def __init__(self, shown: list[bool]) -> None:
        super().__init__()
        self._shown = shown

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        if event.type() in (QEvent.Type.Hide, QEvent.Type.Show):
            self._shown.append(event.type() == QEvent.Type.Show)
        return False


def the_hand_on_one_side_cuts_both(window: MainWindow) -> None:
    main, rest = (body.viewport for body in window.view.beside.live)
    place = place_of(window)
    handle = handle_of(rest)
    drag_handle(handle, -30.0 * handle._way / np.linalg.norm(handle._way))
    release(handle, handle.rect().center())
    now = place_of(window)
    assert now < place - 5.0
    for viewport in (main, rest):
        assert viewport.scene.section.curve[:, 0].mean() == pytest.approx(now, abs=0.06)
    assert handle_of(main)._plane == handle._plane


def a_plane_that_is_taken_away_is_in_no_hand(window: MainWindow) -> None:
    section, handle = window.sections_controller, handle_of(window.view.viewport)
    drag_handle(handle, np.array([20.0, 0.0]))
    assert section.carries
    section.set_on(False)
    assert not section.carries
    assert not window.actions_.cancel.isEnabled()
    assert handle.cursor().shape() == Qt.CursorShape.OpenHandCursor


def test_the_section_panel_leaves_the_bust_free_in_the_smallest_window() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        undrawn(window)
        assert window.size() == QSize(1180, 700)
        section, view = window.sections_controller, window.view.viewport
        section.set_on(True)
        panel = section.panel
        yield lambda: panel.size() == panel.sizeHint()
        for name in ("three-quarter", "front"):
            view.set_view(name)
            spine, _ = view.scene.bands.spine("mid-bust")
            seen = view.scene.view.to_picture(spine, view.width(), view.height())
            shadow = panel.MARGINS[2]
            assert panel.geometry().right() - shadow < seen[:, 0].min()
        height = panel.height()
        panel.fold.click()
        assert panel.is_folded
        assert panel.slider.isVisible()
        yield lambda: panel.height() < 0.5 * height
        panel.fold.click()
        yield lambda: panel.height() == height
        drawing = window.draw_tool
        drawing.begin()
        card, floating = drawing._sketching.card, window.view.floating
        yield lambda: panel.is_folded and not floating.clashes(card)
        drawing.leave()
        yield lambda: panel.height() == height
        wide = panel.plot.width()
        window.resize(1600, 1000)
        yield lambda: panel.plot.width() > wide

    run_main([], script)


def test_the_ghost_stands_behind_every_variant() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.view.set_layer("ghost", True)
        frame = window.session.frame
        window.view.show_variants([("A", frame), ("B", None)])
        for viewport in window.view.panes.viewports:
            assert viewport.scene.plotter.actors["ghost"].GetVisibility()
        window.view.set_layer("ghost", False)
        for viewport in window.view.panes.viewports:
            assert not viewport.scene.plotter.actors["ghost"].GetVisibility()
        window.view.set_layer("ghost", True)
        window.view.compare_by("side")
        main, rest = (body.viewport.scene for body in window.view.beside.live)
        assert main.plotter.actors["ghost"].GetVisibility()
        assert not rest.plotter.actors["ghost"].GetVisibility()  # nothing has moved away from it

    run_main([], script)
