"""The 3D widget: what the pointer does, what is drawn over the view, and that closing leaves nothing."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
import pyvista as pv
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QImage, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot
from window_tools import small_view

from app.gui.theme.stylesheet import apply_theme
from app.gui.viewport.interaction import NOTCH, TURN
from app.gui.viewport.overlay import Pin
from app.gui.viewport.viewport import Viewport
from app.rendering.band import Band
from core.geometry.mesh import Mesh

Button, Keys, XY = Qt.MouseButton, Qt.KeyboardModifier, tuple[float, float]
LEFT, MIDDLE, NONE = Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton, Qt.MouseButton.NoButton
SHIFT, PLAIN = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.NoModifier
RADIUS = 150.0  # of the ball that stands for a body [mm]


@pytest.fixture
def view(qtbot: QtBot) -> Iterator[Viewport]:
    app = QApplication.instance()
    assert isinstance(app, QApplication)
    apply_theme(app, dark=False)
    view = small_view(qtbot, 360, 270)
    ball = pv.Icosphere(radius=RADIUS, nsub=4)
    view.scene.show_body(Mesh(ball.points, ball.regular_faces))
    turn = np.radians(np.linspace(-60.0, 60.0, 9))
    path = RADIUS * np.stack([np.sin(turn), -np.cos(turn), 0.0 * turn], axis=1)
    view.scene.show_bands([Band("Bust line", path, "#5A3F94", 24.0)])
    view.frame_all()
    yield view
    view.close_view()


def mouse(
    view: Viewport, kind: QEvent.Type, at: XY, button: Button = NONE, held: Button = NONE, keys: Keys = PLAIN
) -> None:
    place = QPointF(*at)
    canvas = view.overlay.parentWidget()
    event = QMouseEvent(kind, place, QPointF(canvas.mapToGlobal(place)), button, held, keys)
    QApplication.sendEvent(canvas, event)


def drag(view: Viewport, start: XY, end: XY, button: Button = LEFT, keys: Keys = PLAIN) -> None:
    middle = (0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]))
    mouse(view, QEvent.Type.MouseButtonPress, start, button, button, keys)
    mouse(view, QEvent.Type.MouseMove, middle, NONE, button, keys)
    mouse(view, QEvent.Type.MouseMove, end, NONE, button, keys)
    mouse(view, QEvent.Type.MouseButtonRelease, end, button, NONE, keys)


def wheel(view: Viewport, x: float, y: float, notches: int) -> None:
    canvas = view.overlay.parentWidget()
    place = QPointF(x, y)
    turn, phase = QPoint(0, 120 * notches), Qt.ScrollPhase.NoScrollPhase
    event = QWheelEvent(place, QPointF(canvas.mapToGlobal(place)), QPoint(), turn, NONE, PLAIN, phase, False)
    QApplication.sendEvent(canvas, event)


def pixels(image: QImage) -> np.ndarray:
    plain = image.convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(plain.constBits(), np.uint8).reshape(plain.height(), plain.bytesPerLine())
    return rows[:, : 3 * plain.width()].reshape(plain.height(), plain.width(), 3).astype(float)


# -- pictures


def test_the_picture_holds_body_line_and_background(view: Viewport) -> None:
    image = view.picture()
    ratio = view.devicePixelRatioF()
    assert (image.width(), image.height()) == (round(360 * ratio), round(270 * ratio))
    body = pixels(image)[50, image.width() // 2]
    assert body[0] > body[1] > body[2]
    assert pixels(image)[4, 4].min() > 200.0
    red, green, blue = np.moveaxis(pixels(image), 2, 0)
    assert ((blue > red + 25.0) & (red > green)).sum() > 200  # the line is violet


def test_a_theme_change_of_the_window_darkens_the_view(view: Viewport) -> None:
    app = QApplication.instance()
    assert isinstance(app, QApplication)
    apply_theme(app, dark=True)
    assert view.scene.dark
    assert pixels(view.picture())[4, 4].max() < 60.0
    apply_theme(app, dark=False)
    assert pixels(view.picture())[4, 4].min() > 200.0


@contextmanager
def drawings(view: Viewport) -> Iterator[list[str]]:
    drawn: list[str] = []
    render = view._canvas._render
    view._canvas._render = lambda: drawn.append("drawn") or render()
    yield drawn
    QApplication.processEvents()
    del view._canvas._render


def test_many_requests_make_one_drawing(view: Viewport) -> None:
    view.picture()
    with drawings(view) as drawn:
        for _ in range(5):
            view.request_draw()
    assert len(drawn) == 1


def test_a_small_picture_of_what_is_drawn_draws_nothing(view: Viewport) -> None:
    view.picture()
    with drawings(view) as drawn:
        small = view.picture(fine=False)
    assert not drawn
    assert np.array_equal(pixels(small), pixels(view.picture()))
    with drawings(view) as drawn:
        view.request_draw()
        view.picture(fine=False)
    assert len(drawn) == 1


def test_a_still_picture_loses_its_stairs_and_a_moving_one_is_quick(view: Viewport, qtbot: QtBot) -> None:
    view.request_draw()
    assert not smoothed(view)
    qtbot.waitUntil(lambda: smoothed(view))
    drag(view, (10.0, 10.0), (20.0, 10.0))
    assert not smoothed(view)


def smoothed(view: Viewport) -> bool:
    renderer = view.scene.plotter.renderer
    return bool(renderer.GetUseFXAA() or renderer.GetPass())


# -- the camera


def test_a_left_drag_turns_without_rolling(view: Viewport) -> None:
    before = view.scene.view
    drag(view, (10.0, 10.0), (60.0, 30.0))
    after = view.scene.view
    assert after.azimuth == pytest.approx(before.azimuth - 50.0 * TURN)
    assert after.elevation == pytest.approx(before.elevation + 20.0 * TURN)
    assert after.focus == before.focus
    for _ in range(4):
        drag(view, (10.0, 10.0), (10.0, 260.0))
    assert view.scene.view.elevation == 89.0
    assert view.scene.plotter.camera.roll == pytest.approx(view.scene.view.azimuth, abs=360.0)
    assert view.scene.plotter.camera.up == (0.0, 0.0, 1.0)


@pytest.mark.parametrize(("button", "keys"), [(MIDDLE, PLAIN), (LEFT, SHIFT)])
def test_panning_moves_the_body_with_the_pointer(view: Viewport, button: Button, keys: Keys) -> None:
    place = view.scene.view.focus
    before = view.scene.view.to_picture(place, view.width(), view.height())[0, :2]
    drag(view, (100.0, 100.0), (130.0, 85.0), button, keys)
    after = view.scene.view.to_picture(place, view.width(), view.height())[0, :2]
    assert after - before == pytest.approx((30.0, -15.0))


def test_the_wheel_zooms_to_the_pointer(view: Viewport) -> None:
    start, sight = view.scene.view.ray(250.0, 80.0, view.width(), view.height())
    depth = view.scene.view.distance / -(sight @ view.scene.view.axes[2])
    place = start + depth * sight
    distance = view.scene.view.distance
    wheel(view, 250.0, 80.0, 2)
    assert view.scene.view.distance == pytest.approx(distance / NOTCH**2)
    spot = view.scene.view.to_picture(place, view.width(), view.height())[0, :2]
    assert spot == pytest.approx((250.0, 80.0))


def test_a_double_click_on_the_body_makes_it_the_centre(view: Viewport) -> None:
    mouse(view, QEvent.Type.MouseButtonDblClick, (200.0, 100.0), LEFT, LEFT)
    assert np.linalg.norm(view.scene.view.focus) == pytest.approx(RADIUS, abs=1.0)
    mouse(view, QEvent.Type.MouseButtonDblClick, (2.0, 2.0), LEFT, LEFT)
    assert np.linalg.norm(view.scene.view.focus) == pytest.approx(RADIUS, abs=1.0)


def test_a_framed_body_stays_framed_until_the_pointer_takes_over(view: Viewport) -> None:
    distance = view.scene.view.distance
    view.resize(180, 270)
    assert view.scene.view.distance > 1.2 * distance
    wheel(view, 90.0, 100.0, 1)
    distance = view.scene.view.distance
    view.resize(360, 270)
    assert view.scene.view.distance == distance


def test_a_glide_ends_at_the_view_that_was_asked_for(view: Viewport, qtbot: QtBot) -> None:
    view.motion = True
    view.set_view("left")
    assert view.scene.view.azimuth < 45.0
    qtbot.waitUntil(lambda: view.scene.view.azimuth == pytest.approx(90.0))


# -- lines under the pointer


def test_a_click_on_a_line_names_it(view: Viewport, qtbot: QtBot) -> None:
    x, y, _ = view.scene.view.to_picture(view.scene.band_anchor("Bust line"), 360, 270)[0]
    with qtbot.waitSignal(view.band_clicked) as heard:
        drag(view, (x, y), (x + 1.0, y))
    assert heard.args == ["Bust line"]
    with qtbot.assertNotEmitted(view.band_clicked):
        drag(view, (x, y), (x + 40.0, y))
        drag(view, (4.0, 4.0), (4.0, 4.0))


def test_hovering_names_the_line_once_and_leaving_names_none(view: Viewport) -> None:
    heard: list[str] = []
    view.band_hovered.connect(heard.append)
    x, y, _ = view.scene.view.to_picture(view.scene.band_anchor("Bust line"), 360, 270)[0]
    for dx in (0.0, 1.0, 2.0):
        mouse(view, QEvent.Type.MouseMove, (x + dx, y))
    assert view.scene.bands.hovered == "Bust line"
    mouse(view, QEvent.Type.MouseMove, (4.0, 4.0))
    assert heard == ["Bust line", ""]


def test_the_label_of_a_line_is_drawn_and_goes(view: Viewport) -> None:
    without = pixels(view.picture())
    view.label_band("Bust line", "Bust line 97.0 %", "−12.3 mm")
    assert np.abs(pixels(view.picture()) - without).max() > 100.0
    view.label_band("")
    assert np.abs(pixels(view.picture()) - without).max() < 3.0


# -- pins


def test_a_pin_behind_the_body_is_hollow(view: Viewport) -> None:
    front, back = np.array([70.0, -RADIUS, 60.0]), np.array([-70.0, RADIUS, 60.0])
    view.set_pins([Pin("front", "Front", front, "ok", "90 %"), Pin("back", "Back", back, "ok", "50 %")])
    image = pixels(view.picture())

    def heart(place: np.ndarray) -> np.ndarray:
        x, y, _ = view.scene.view.to_picture(place, 360, 270)[0] * view.devicePixelRatioF()
        return image[round(y), round(x)]

    assert heart(front).max() < 60.0  # ink
    assert heart(back)[0] > 120.0  # clay seen through the ring


def test_a_dragged_pin_stays_on_the_skin(view: Viewport, qtbot: QtBot) -> None:
    place = np.array([40.0, -np.sqrt(RADIUS**2 - 40.0**2 - 60.0**2), 60.0])
    view.set_pins([Pin("bust", "Bust point", place, "ok", "90 %")])
    x, y, _ = view.scene.view.to_picture(place, 360, 270)[0]
    heard: list[tuple[str, np.ndarray]] = []
    view.pin_moved.connect(lambda name, skin: heard.append((name, skin)))
    direction = view.scene.view.azimuth
    with qtbot.waitSignals([view.pin_pressed, view.pin_released]):
        drag(view, (x, y), (x - 20.0, y + 10.0))
    assert view.scene.view.azimuth == direction
    name, skin = heard[-1]
    assert (name, len(heard)) == ("bust", 2)
    assert np.linalg.norm(skin) == pytest.approx(RADIUS, abs=1.0)
    spot = view.scene.view.to_picture(skin, 360, 270)[0, :2]
    assert spot == pytest.approx((x - 20.0, y + 10.0), abs=0.01)


# -- the end


def test_closing_leaves_nothing(qtbot: QtBot) -> None:
    view = Viewport()
    view.resize(200, 150)
    view.show()
    qtbot.waitExposed(view)
    ball = pv.Icosphere(radius=RADIUS, nsub=3)
    view.scene.show_body(Mesh(ball.points, ball.regular_faces))
    view.picture()
    view.request_draw()
    left = [weakref.ref(view), weakref.ref(view.scene.plotter), weakref.ref(view.scene.body)]
    view.close_view()
    view.close_view()
    view.request_draw()
    view.close()
    view.deleteLater()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()
    del view
    gc.collect()
    assert [ref() for ref in left] == [None, None, None]
