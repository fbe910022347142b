"""Before and after, flipped, wiped and side by side, through the real main()."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest
from PySide6.QtCore import QCoreApplication, QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QImage, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication
from window_tools import Script, run_main, settled

from app.gui.main_window import MainWindow
from app.gui.session.settings import get_setting
from app.gui.viewport import compare_key as flip_key
from app.gui.viewport.split_view import REACH
from app.gui.viewport.viewport import Viewport
from core.pipeline.live_solver import Frame

pytestmark = pytest.mark.usefixtures("empty_house")


def test_before_and_after_are_flipped_wiped_and_put_side_by_side(monkeypatch: pytest.MonkeyPatch) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        yield lambda: window.view.is_shaded
        first = window.session.frame
        assert first is not None
        the_body_is_of_another_material_and_the_line_is_framed(window)
        the_space_bar_flips_and_lets_peek(window, monkeypatch)
        a_wipe_shows_both_pictures_with_a_handle_between(window)
        beside = yield from bodies_side_by_side_share_one_camera(window)
        variants_are_put_side_by_side(window, first)
        key(window, Qt.Key.Key_D)
        key(window, Qt.Key.Key_D)
        assert window.view.beside.way == "after"
        yield lambda: nothing_is_left_of(beside)
        assert window.view.panes.viewports == (window.view.viewport,)

    assert run_main([], script) == 0


def the_body_is_of_another_material_and_the_line_is_framed(window: MainWindow) -> None:
    view, body = window.view.viewport, window.view.viewport.scene.body
    assert body is not None
    far, clay = view.scene.view, body.colours.astype(int)
    window.view_controller.materials["plaster"].trigger()
    assert get_setting("material") == "plaster"
    red, _, blue = (body.colours.astype(int) - clay).mean(axis=0)
    assert blue > red + 10.0  # clay is warm, plaster is grey
    window.view.select_line("mid-bust")
    key(window, Qt.Key.Key_F)
    line = view.scene.view.to_picture(view.scene.bands.spine("mid-bust")[0], view.width(), view.height())
    assert view.scene.view.distance < far.distance
    assert ((line[:, :2] > 0) & (line[:, :2] < [view.width(), view.height()])).all()
    key(window, Qt.Key.Key_Home)
    assert view.scene.view.distance > far.distance


def the_space_bar_flips_and_lets_peek(window: MainWindow, monkeypatch: pytest.MonkeyPatch) -> None:
    view, space = window.view, Qt.Key.Key_Space
    body = view.viewport.scene.body
    assert body is not None

    def is_moved() -> bool:
        return bool(np.abs(body.shown_points - body.rest.vertices).max() > 1.0)

    monkeypatch.setattr(flip_key, "HOLD", 60_000)
    key(window, space)
    assert not is_moved()
    key(window, space)
    assert is_moved()
    monkeypatch.setattr(flip_key, "HOLD", 0)  # now every press is a long one
    key(window, Qt.Key.Key_W)
    QTest.keyPress(window, space)
    assert view.beside.way == "before"
    assert not is_moved()
    QTest.keyRelease(window, space)
    assert view.beside.way == "wipe"
    key(window, Qt.Key.Key_W)
    the_space_bar_presses_a_button_that_was_reached_by_keyboard(window)
    key(window, Qt.Key.Key_G)
    assert view.viewport.scene.is_visible("ghost")
    view.set_layer("ghost", False)
    assert not view.compare.actions_by_name["ghost"].isChecked()
    assert not view.viewport.scene.is_visible("ghost")


def the_space_bar_presses_a_button_that_was_reached_by_keyboard(window: MainWindow) -> None:
    first = window.view.tools.findChildren(QAbstractButton)[0]
    first.setFocus()
    QTest.keyClick(first, Qt.Key.Key_Tab)
    button = QApplication.focusWidget()
    assert isinstance(button, QAbstractButton)
    assert button is not first
    QTest.keyPress(button, Qt.Key.Key_Space)
    assert button.isDown()
    assert window.view.beside.way == "after"
    button.setDown(False)
    window.view.viewport.setFocus()


def a_wipe_shows_both_pictures_with_a_handle_between(window: MainWindow) -> None:
    view = window.view
    panes, handle = view.panes, view.panes.handle
    view.select_line("")
    view.set_after(False)
    before = pixels(view.picture(1))
    view.set_after(True)
    after = pixels(view.picture(1))
    view.viewport.setFocus()
    key(window, Qt.Key.Key_W)
    assert view.compare.actions_by_name["wipe"].isChecked()
    assert handle.hasFocus()
    rest, width = view.beside.bodies[1].viewport, panes.width()
    assert rest.scene.material == "plaster"
    drag_handle(window, round(0.42 * width))
    line = round(width * handle.share())
    assert handle.share() == pytest.approx(0.42, abs=0.002)
    assert handle.geometry().center().x() == pytest.approx(line, abs=1)
    assert rest.rect().width() == width
    assert rest.parentWidget().width() == line
    seen, low = pixels(view.picture(1)), 100  # below the titles
    left, right = np.s_[low:, : line - REACH], np.s_[low:, line + REACH :]
    assert np.array_equal(seen[left], before[left])
    assert np.array_equal(seen[right], after[right])
    assert not np.array_equal(seen[left], after[left])
    assert not np.array_equal(seen[right], before[right])
    step = handle.value()
    QTest.keyClick(handle, Qt.Key.Key_Left)
    assert handle.value() == step - 10
    QTest.mouseDClick(handle, Qt.MouseButton.LeftButton)
    assert handle.share() == 0.5
    assert handle.accessibleName()
    titles = [title.geometry() for title in panes.titles]
    assert titles[0].right() < handle.geometry().center().x() < titles[1].left()
    drag_handle(window, 150)  # where the tools of comparison lie over it
    assert clear_of_the_tools(window)


def bodies_side_by_side_share_one_camera(window: MainWindow) -> Script:
    view, tools = window.view, window.view.tools.actions_by_name
    key(window, Qt.Key.Key_D)
    left, right = view.panes.viewports
    assert right is view.viewport
    assert [title.text for title in view.panes.titles] == ["Before", "After"]
    assert abs(left.width() - right.width()) <= 1
    assert left.geometry().right() < right.geometry().left()
    for here, there in ((left, right), (right, left)):
        for act in (orbit, pan, zoom):
            former = here.scene.view
            act(here)
            assert here.scene.view != former
            assert there.scene.view == here.scene.view
    tools["front"].trigger()
    tools["perspective"].trigger()
    assert left.scene.view == right.scene.view
    assert (left.scene.view.name, left.scene.view.parallel) == ("front", True)
    tools["fit"].trigger()
    tools["control-mesh"].trigger()
    assert left.scene.view == right.scene.view
    assert left.scene.is_visible("control")
    window.view.set_line_visible("mid-bust", False)
    assert "mid-bust" not in left.scene.bands.names
    window.view.set_line_visible("mid-bust", True)
    rest, shown = left.scene.body, right.scene.body
    assert rest is not None
    assert shown is not None
    former = shown.shown_points.copy()
    window.lines_controller.commit_length("mid-bust", 0.9)
    yield lambda: bool(np.abs(shown.shown_points - former).max() > 1.0)
    assert np.array_equal(rest.shown_points, rest.rest.vertices)
    return weakref.ref(left.scene), weakref.ref(left.scene.plotter), weakref.ref(rest)


def variants_are_put_side_by_side(window: MainWindow, other: Frame) -> None:
    view = window.view
    view.show_variants([("A", other), ("B", None), ("C", other)])
    first, own, last = view.panes.viewports
    assert own is view.viewport
    assert not view.compare.actions_by_name["side"].isChecked()
    assert [title.text for title in view.panes.titles] == ["A", "B", "C"]
    assert len({title.y() for title in view.panes.titles}) == 1, "one height, though only one was in the way"
    frame = window.session.frame
    assert frame is not None
    for viewport, shown in ((first, other), (own, frame), (last, other)):
        body = viewport.scene.body
        assert body is not None
        assert np.array_equal(body.shown_points[shown.stages.moving.vertices], shown.points)
    assert clear_of_the_tools(window)


def nothing_is_left_of(things: tuple[weakref.ref[object], ...]) -> bool:
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    gc.collect()
    return all(thing() is None for thing in things)


def key(window: MainWindow, name: Qt.Key) -> None:
    QTest.keyClick(window, name)


def pixels(image: QImage) -> np.ndarray:
    plain = image.convertToFormat(QImage.Format.Format_RGB32)
    return np.array(plain.constBits()).reshape(plain.height(), plain.width(), 4)[..., :3]


def clear_of_the_tools(window: MainWindow) -> bool:
    """Whether no title lies under the tools of comparison."""
    left, top, right, bottom = window.view.compare.MARGINS
    tools = window.view.compare.geometry().adjusted(left, top, -right, -bottom)
    shown = [title.geometry() for title in window.view.panes.titles if title.isVisible()]
    return not any(each.intersects(tools) for each in shown)


def drag_handle(window: MainWindow, x: int) -> None:
    """Take the handle beside its line, and pull the line to ``x``."""
    panes, handle, button = window.view.panes, window.view.panes.handle, Qt.MouseButton.LeftButton
    grip = QPoint(REACH + 8, 300)
    to = handle.geometry().center().x()
    QTest.mousePress(handle, button, pos=grip)
    for goal in ((x + to) // 2, x):
        QTest.mouseMove(handle, handle.mapFrom(panes, QPoint(goal + 8, 300)))
    QTest.mouseRelease(handle, button, pos=grip)


def orbit(viewport: Viewport) -> None:
    pull(viewport, Qt.MouseButton.LeftButton)


def pan(viewport: Viewport) -> None:
    pull(viewport, Qt.MouseButton.MiddleButton)


def pull(viewport: Viewport, button: Qt.MouseButton) -> None:
    canvas = viewport.overlay.parentWidget()
    start = QPoint(40, canvas.height() - 120)
    QTest.mousePress(canvas, button, pos=start)
    for step in (15, 30):
        QTest.mouseMove(canvas, start + QPoint(step, 3))
    QTest.mouseRelease(canvas, button, pos=start + QPoint(30, 3))


def zoom(viewport: Viewport) -> None:
    canvas, none = viewport.overlay.parentWidget(), Qt.MouseButton.NoButton
    at = QPointF(canvas.rect().center())
    turn = QWheelEvent(
        at, canvas.mapToGlobal(at), QPoint(), QPoint(0, 120), none, Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QCoreApplication.sendEvent(canvas, turn)
