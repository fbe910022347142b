"""The ghost shows the body at rest only where it reaches out beyond the moved one."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from app.rendering.appearance import APPEARANCES, rgb
from app.rendering.scene import Scene
from core.geometry.mesh import Mesh
from tests.app.rendering.conftest import MakeScene

WIDTH, HEIGHT, RADIUS = 300, 240, 150.0


@pytest.fixture
def scene(make_scene: MakeScene) -> Scene:
    scene = make_scene(WIDTH, HEIGHT)
    ball = pv.Icosphere(radius=RADIUS, nsub=5)
    scene.show_body(Mesh(ball.points, ball.regular_faces))
    scene.frame_all()
    return scene


def ghostly(scene: Scene) -> np.ndarray:
    """Which pixels have the ghost's colour, shape (HEIGHT, WIDTH)."""
    scene.plotter.render()
    image = np.asarray(scene.plotter.screenshot(return_img=True), dtype=float)
    return np.abs(image - rgb(APPEARANCES[scene.dark].ghost)).max(axis=2) < 3.0


def flatten_front(scene: Scene, by: float) -> None:
    rest = scene.body.rest.vertices
    scene.move_body(np.arange(len(rest)), rest + np.maximum(-rest[:, 1:2], 0.0) / RADIUS * [0.0, by, 0.0])


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("side", ["front", "left", "three-quarter"])
def test_the_ghost_of_a_body_at_rest_is_not_seen(scene: Scene, side: str, parallel: bool) -> None:
    scene.set_view(side)
    scene.set_parallel(parallel)
    scene.set_visible("ghost", True)
    assert ghostly(scene).sum() == 0


@pytest.mark.parametrize("parallel", [False, True])
def test_the_ghost_is_a_fringe_where_the_body_went_in(scene: Scene, parallel: bool) -> None:
    scene.set_view("left")  # the front of the body is on the left of the picture
    scene.set_parallel(parallel)
    flatten_front(scene, 30.0)
    assert ghostly(scene).sum() == 0
    scene.set_visible("ghost", True)
    seen = ghostly(scene)
    row = np.flatnonzero(seen[HEIGHT // 2])
    edges = np.array([[0.0, -RADIUS, 0.0], [0.0, 30.0 - RADIUS, 0.0]])
    outer, inner = scene.view.to_picture(edges, WIDTH, HEIGHT)[:, 0]
    assert row.min() == pytest.approx(outer, abs=3.0)
    assert row.max() == pytest.approx(inner, abs=3.0)
    assert not seen[:, WIDTH // 2 + 5 :].any()
    scene.before(True)
    assert ghostly(scene).sum() == 0


def test_a_new_body_has_its_own_ghost(scene: Scene) -> None:
    scene.set_visible("ghost", True)
    ball = pv.Icosphere(radius=RADIUS / 2.0, nsub=4)
    scene.show_body(Mesh(ball.points, ball.regular_faces))
    assert ghostly(scene).sum() == 0
