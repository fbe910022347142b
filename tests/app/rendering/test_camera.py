"""The turntable camera: it never rolls, and the picture moves as the pointer does."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from app.rendering.camera import SLANTED, STEEPEST, VIEWS, View, framing_place
from app.rendering.scene import Scene

WIDTH, HEIGHT = 450, 300


def test_the_camera_never_rolls_and_stops_at_the_poles() -> None:
    random = np.random.default_rng(5)
    view = View()
    for _ in range(200):
        view = view.orbit(*random.normal(0.0, 60.0, 2))
        right, up, back = view.axes
        assert right[2] == 0.0
        assert up[2] > 0.0
        assert abs(view.elevation) <= STEEPEST
        assert np.linalg.det(view.axes) == pytest.approx(1.0)
        assert back @ (view.eye - np.asarray(view.focus)) == pytest.approx(view.distance)


@pytest.mark.parametrize("parallel", [False, True])
def test_a_sight_goes_through_its_pixel(parallel: bool) -> None:
    view = View((10.0, -20.0, 300.0), 1800.0, 34.0, 8.0, parallel)
    start, sight = view.ray(123.0, 77.0, WIDTH, HEIGHT)
    along = start + np.array([[900.0], [2000.0]]) * sight
    assert view.to_picture(along, WIDTH, HEIGHT)[:, :2] == pytest.approx(np.tile([123.0, 77.0], (2, 1)))


def test_zooming_keeps_the_place_under_the_pointer() -> None:
    view = View((0.0, 0.0, 300.0), 1800.0, 20.0, 5.0)
    x, y = 0.6, -0.3  # half heights
    pixel = (WIDTH / 2 + x * HEIGHT / 2, HEIGHT / 2 - y * HEIGHT / 2)
    right, up, _ = view.axes
    place = np.asarray(view.focus) + view.half_height * (x * right + y * up)
    closer = view.zoom(1.15, x, y)
    assert closer.to_picture(place, WIDTH, HEIGHT)[0, :2] == pytest.approx(pixel)
    assert closer.distance == pytest.approx(1800.0 / 1.15)


def test_dragging_moves_the_picture_by_as_many_pixels() -> None:
    view = View((0.0, 0.0, 300.0), 1800.0, 20.0, 5.0)
    moved = view.pan(30.0, -12.0, HEIGHT).to_picture(view.focus, WIDTH, HEIGHT)[0]
    assert moved[:2] == pytest.approx((WIDTH / 2 + 30.0, HEIGHT / 2 - 12.0))


def test_named_views_look_from_their_side() -> None:
    sides = {"front": (0, -1, 0), "left": (1, 0, 0), "right": (-1, 0, 0), "back": (0, 1, 0)}
    for name, side in sides.items():
        assert View().named(name).axes[2] == pytest.approx(side, abs=1e-12)
    assert View().named("top").axes[2][2] > 0.99
    assert set(VIEWS) == {*sides, "three-quarter", "top"}


def test_a_place_is_faced_from_where_its_skin_looks_but_not_steeply() -> None:
    for name in ("front", "left", "right", "back"):
        assert View(azimuth=12.0).facing(View().named(name).axes[2]).name == name
    aslant = View((1.0, 2.0, 3.0), 900.0).facing([1.0, -1.0, 0.5])
    assert aslant.azimuth == pytest.approx(45.0)
    assert aslant.elevation == pytest.approx(np.degrees(np.arctan(0.5 / np.sqrt(2.0))))
    assert (aslant.focus, aslant.distance) == ((1.0, 2.0, 3.0), 900.0)
    assert View().facing([0.0, -0.1, -1.0]).elevation == -SLANTED


def test_a_place_that_is_turned_to_comes_into_the_picture_if_it_is_not_there() -> None:
    view, normal = View((0.0, 0.0, 0.0), 1000.0), np.array([0.0, 1.0, 0.0])
    near = framing_place(view, np.array([10.0, 100.0, 20.0]), normal, 1.6)
    assert (near.name, near.focus, near.distance) == ("back", view.focus, view.distance)
    far = framing_place(view, np.array([10.0, 100.0, 400.0]), normal, 1.6)
    assert (far.name, far.focus) == ("back", (10.0, 100.0, 400.0))


def test_a_move_between_views_ends_there_the_short_way() -> None:
    start, end = View(azimuth=170.0), View(azimuth=-170.0, distance=900.0)
    assert start.towards(end, 0.5).azimuth == pytest.approx(180.0)
    last = start.towards(end, 1.0)
    assert last.orbit(0.0, 0.0).azimuth == pytest.approx(end.azimuth)
    assert last.distance == pytest.approx(end.distance)


@pytest.mark.parametrize("parallel", [False, True])
def test_the_picture_plane_agrees_with_vtk(parallel: bool) -> None:
    plotter = pv.Plotter(off_screen=True, window_size=(WIDTH, HEIGHT), lighting="none")
    scene = Scene(plotter)
    scene.set_camera(View((10.0, -20.0, 300.0), 1800.0, 34.0, 8.0, parallel))
    plotter.render()
    points = np.random.default_rng(3).uniform(-150.0, 150.0, (8, 3)) + scene.view.focus
    ours = scene.view.to_picture(points, WIDTH, HEIGHT)
    for point, (x, y, _) in zip(points, ours, strict=True):
        plotter.renderer.SetWorldPoint(*point, 1.0)
        plotter.renderer.WorldToDisplay()
        assert (x, HEIGHT - y) == pytest.approx(plotter.renderer.GetDisplayPoint()[:2], abs=0.05)
    plotter.close()
