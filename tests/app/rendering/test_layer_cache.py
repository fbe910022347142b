"""What stands still is not drawn again, and the picture is the same to the pixel as if it were."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

from app.rendering.band import Band
from app.rendering.layer_cache import StaticLayerCache
from app.rendering.scene import Scene
from core.geometry.mesh import Mesh
from tests.app.rendering.conftest import MakeScene

WIDTH, HEIGHT = 240, 180


@pytest.fixture
def scene(make_scene: MakeScene) -> Scene:
    scene, ball = make_scene(WIDTH, HEIGHT), pv.Icosphere(radius=100.0, nsub=4)
    scene.show_body(Mesh(ball.points, ball.regular_faces))
    angles = np.linspace(-1.2, 1.2, 30)
    round_it = np.stack([98.0 * np.sin(angles), -98.0 * np.cos(angles), np.full(30, 20.0)], axis=1)
    scene.show_bands([Band("mid-bust", round_it, "#E5536B")])
    scene.set_view("three-quarter")
    scene.frame_all()
    return scene


def press(scene: Scene, by: float) -> None:
    """Press in the front of the ball, where the band lies."""
    assert scene.body is not None
    rest = scene.body.rest
    front = np.flatnonzero(rest.vertices[:, 1] < -60.0)
    scene.move_body(front, rest.vertices[front] * (1.0 - by), rest.vertex_normals[front])


def pixels(scene: Scene) -> np.ndarray:
    data = vtkUnsignedCharArray()
    scene.plotter.ren_win.GetRGBACharPixelData(0, 0, WIDTH - 1, HEIGHT - 1, 0, data)
    return vtk_to_numpy(data).copy()


def drawn_with(scene: Scene, still: StaticLayerCache) -> tuple[np.ndarray, int]:
    """Return the picture, and how many of the actors that stand still were drawn for it."""
    drawn: list[int] = []
    count = lambda *_: drawn.append(sum(bool(prop.GetVisibility()) for prop in scene.static_actors()))  # noqa: E731
    tag = scene.plotter.renderer.AddObserver("StartEvent", count)
    still.render(scene.static_actors())
    scene.plotter.renderer.RemoveObserver(tag)
    return pixels(scene), sum(drawn)


def drawn_whole(scene: Scene) -> np.ndarray:
    scene.plotter.ren_win.Render()
    return pixels(scene)


def test_a_picture_over_what_was_kept_equals_one_drawn_anew(scene: Scene) -> None:
    still = StaticLayerCache(scene.plotter)
    press(scene, 0.02)
    still.render(scene.static_actors())
    counts = []
    for by in (0.05, 0.15, 0.3, 0.0):
        press(scene, by)
        picture, count = drawn_with(scene, still)
        counts.append(count)
        assert np.array_equal(picture, drawn_whole(scene))
    assert counts == [2, 0, 0, 0], "body and floor are drawn once, then no more"


def test_the_outermost_pixels_are_kept_too(scene: Scene) -> None:
    scene.set_camera(replace(scene.view.named("front"), distance=250.0))  # the body reaches over all edges
    still, last = StaticLayerCache(scene.plotter), np.empty(0)
    for by in (0.02, 0.05, 0.3, 0.45, 0.1):
        press(scene, by)
        last, _ = drawn_with(scene, still)  # no whole picture in between: it would mend what was left out
    assert np.array_equal(last, drawn_whole(scene))


def test_graphics_that_cannot_keep_a_picture_draw_each_one_once(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    formats = iter(range(1000))
    monkeypatch.setattr("app.rendering.layer_cache._depth_of", lambda _: next(formats))  # never the same
    still, counts = StaticLayerCache(scene.plotter), []
    for by in (0.1, 0.2, 0.3, 0.4):
        press(scene, by)
        picture, count = drawn_with(scene, still)
        counts.append(count)
        assert np.array_equal(picture, drawn_whole(scene))
    assert counts[-2:] == [2, 2], "body and floor once"


def side(scene: Scene) -> np.ndarray:
    return np.flatnonzero(scene.body.rest.vertices[:, 0] > 70.0)


CHANGES: dict[str, Callable[[Scene], object]] = {
    "the camera turns": lambda scene: scene.set_view("left"),
    "the camera comes nearer": lambda scene: scene.set_camera(replace(scene.view, distance=300.0)),
    "another theme": lambda scene: scene.set_dark(True),
    "another material": lambda scene: scene.set_material("graphite"),
    "no floor": lambda scene: scene.set_visible("floor", False),
    "no body": lambda scene: scene.set_visible("body", False),
    "a ghost": lambda scene: scene.set_visible("ghost", True),
    "shadows": lambda scene: scene.set_occlusion(np.linspace(0.0, 1.0, len(scene.body.rest.vertices))),
    "a map": lambda scene: scene.body.show_map(np.full((len(scene.body.rest.vertices), 3), 90.0)),
    "original": lambda scene: scene.before(True),
    "more of it moves": lambda scene: scene.move_body(
        side(scene), 1.1 * scene.body.rest.vertices[side(scene)]
    ),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES.keys())
def test_nothing_that_was_kept_is_shown_once_it_is_wrong(
    scene: Scene, change: Callable[[Scene], object]
) -> None:
    still = StaticLayerCache(scene.plotter)
    press(scene, 0.3)
    for _ in range(3):
        still.render(scene.static_actors())
    former = pixels(scene)
    change(scene)
    for _ in range(3):
        picture, _ = drawn_with(scene, still)
        assert np.array_equal(picture, drawn_whole(scene))
    assert not np.array_equal(picture, former)


def test_nothing_is_kept_while_the_camera_moves_or_after_it_is_forgotten(scene: Scene) -> None:
    still = StaticLayerCache(scene.plotter)
    press(scene, 0.1)
    for distance in (900.0, 880.0, 860.0):
        scene.set_camera(replace(scene.view, distance=distance))
        _, count = drawn_with(scene, still)
        assert count == 2, "drawn once, not a second time to be kept"
        assert still._kept is None
    drawn_with(scene, still)
    assert still._kept is not None
    still.clear()
    assert still._kept is None
    picture, _ = drawn_with(scene, still)
    assert np.array_equal(picture, drawn_whole(scene))


def test_a_sight_meets_what_moved_and_looks_up_anew_only_that(scene: Scene) -> None:
    press(scene, 0.0)
    behind, before = np.array([0.0, 300.0, 0.0]), np.array([0.0, -300.0, 0.0])
    assert scene.hit_body(before, behind)[1] == pytest.approx(-100.0, abs=1.0)
    still, moving = (part.sight._locator for part in scene.body._parts)
    press(scene, 0.4)
    assert scene.hit_body(before, behind)[1] == pytest.approx(-60.0, abs=1.0)
    assert scene.hit_body(behind, before)[1] == pytest.approx(100.0, abs=1.0)
    assert scene.body._parts[0].sight._locator is still
    assert scene.body._parts[1].sight._locator is not moving
