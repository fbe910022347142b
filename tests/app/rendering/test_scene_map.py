"""Maps and the section plane in the 3D drawing: what the pixels show. No window is opened here."""

from __future__ import annotations

import numpy as np
import pytest

from app.rendering.appearance import APPEARANCES, rgb
from app.rendering.scene import Scene
from app.rendering.vertex_colors import FOLDS, Ramp
from app.research.sphere import sphere
from core.geometry.planar_curves import Plane, Slicer
from tests.app.rendering.conftest import MakeScene

BALL = sphere(rings=61, spokes=120)  # of radius 100 mm
RAMP = Ramp(("#0000FF", "#EDD8C9", "#FF0000"), -10.0, 10.0, "#EDD8C9")


@pytest.fixture
def scene(make_scene: MakeScene) -> Scene:
    scene = make_scene()
    scene.show_body(BALL)
    scene.set_view("front")
    scene.frame_all()
    return scene


def drawn(scene: Scene) -> np.ndarray:
    return np.array(scene.plotter.actors["body"].mapper.dataset["Colour"], dtype=int)


def picture(scene: Scene) -> np.ndarray:
    scene.plotter.render()
    return np.asarray(scene.plotter.screenshot(return_img=True), dtype=int)


def test_a_ramp_gives_zero_the_clay_and_ends_the_ends() -> None:
    colours = RAMP(np.array([-30.0, -10.0, -5.0, 0.0, 10.0, np.nan]))
    clay = rgb("#EDD8C9")
    assert colours[[0, 1]] == pytest.approx(np.tile([0.0, 0.0, 255.0], (2, 1)))
    assert colours[2] == pytest.approx(0.5 * (clay + rgb("#0000FF")))
    assert colours[[3, 5]] == pytest.approx(np.tile(clay, (2, 1)))
    assert colours[4] == pytest.approx([255.0, 0.0, 0.0])


def test_a_map_colours_the_body_and_leaves_it_again(scene: Scene) -> None:
    body = scene.body
    assert body is not None
    clay = drawn(scene)
    body.show_map(RAMP(np.full(len(BALL.vertices), 10.0)))
    assert (drawn(scene) == [255, 0, 0]).all()
    left = np.flatnonzero(BALL.vertices[:, 0] > 1.0)
    body.recolour(left, RAMP(np.full(len(left), -10.0)))
    assert (drawn(scene)[left] == [0, 0, 255]).all()
    red, _, blue = np.moveaxis(picture(scene)[140:160], 2, 0)
    assert (blue[:, 165:200] > red[:, 165:200]).all()  # the subject's left is on the right of the picture
    assert (red[:, 100:135] > blue[:, 100:135]).all()
    scene.set_occlusion(np.zeros(len(BALL.vertices)))
    assert drawn(scene)[left[0]] == pytest.approx([0, 0, 255.0 * (1.0 - FOLDS)], abs=1.0)
    scene.set_occlusion(np.ones(len(BALL.vertices)))
    body.show_map(None)
    assert (drawn(scene) == clay).all()
    assert drawn(scene)[0] == pytest.approx(rgb(APPEARANCES[False].clay), abs=1.0)


def test_the_section_plane_shows_its_sheet_and_its_curve(scene: Scene) -> None:
    def blue() -> np.ndarray:
        image = picture(scene)
        return (image[..., 2] > image[..., 0] + 60) & (image[..., 2] > 120)

    assert not blue().any()
    plane = Plane("x", 30.0)
    curves = Slicer(BALL, plane).curves(BALL.vertices)
    scene.section.show(plane, BALL.vertices.min(axis=0), BALL.vertices.max(axis=0), curves)
    assert scene.section.curve[:, 0] == pytest.approx(30.0, abs=1e-4)
    assert np.linalg.norm(scene.section.curve, axis=1) == pytest.approx(100.0, abs=0.3)
    seen = np.argwhere(blue())
    spot = scene.view.to_picture(np.array([[30.0, -95.4, 0.0]]), 300, 300)[0]
    assert np.abs(seen - [spot[1], spot[0]]).sum(axis=1).min() < 4.0
    scene.set_view("left")
    before = picture(scene)
    scene.section.set_visible(False)
    corner = scene.view.to_picture(np.array([[30.0, -118.0, 118.0]]), 300, 300)[0]
    x, y = (round(float(at)) for at in corner[:2])
    sheet, plain = before[y, x], picture(scene)[y, x]
    assert 4 < (plain - sheet)[0] < 30  # a breath of blue: less red
