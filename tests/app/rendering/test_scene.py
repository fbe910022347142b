"""The 3D drawing: what lies on the skin, what moves, what the pixels show. No window is opened here."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from app.rendering.actors import RayPicker
from app.rendering.appearance import APPEARANCES, rgb
from app.rendering.band import Band
from app.rendering.camera import VIEWS
from app.rendering.render_mesh import split_plates
from app.rendering.ribbon_mesh import RibbonSurface, build_casing, build_ribbon
from app.rendering.scene import Scene
from core.garment.curve_smoothing import centre_line
from core.geometry.mesh import Mesh
from core.pipeline.line_routes import LineRoute
from tests.app.rendering.conftest import MakeScene

ROOT = Path(__file__).parents[3]
WIDTH, HEIGHT = 450, 300
BUST, UNDERBUST = 347.0, 290.0  # heights of the lines drawn here on the mannequin [mm]

# The person's true landmarks [mm], left and right: the fold lies behind the breast that hangs over it.
FOLDS_AND_BREASTS = (
    ((112.64, -189.12, 232.53), (112.64, -260.52, 251.40)),
    ((-112.64, -190.60, 243.53), (-112.64, -260.52, 262.99)),
)


@pytest.fixture
def scene(make_scene: MakeScene, mannequin_mesh: Mesh) -> Scene:
    scene = make_scene(WIDTH, HEIGHT)
    scene.show_body(mannequin_mesh)
    scene.frame_all()
    return scene


def across_front(mesh: Mesh, z: float, reach: float = 110.0) -> np.ndarray:
    """A coarse path over the front at height z, as control points give it."""
    sight = RayPicker(pv.PolyData.from_regular_faces(mesh.vertices.astype(np.float32), mesh.faces))
    places = [
        sight.hit(np.array([x, -900.0, z]), np.array([x, 900.0, z])) for x in np.linspace(-reach, reach, 9)
    ]
    return np.array([place for place in places if place is not None])


def lines(mesh: Mesh) -> list[Band]:
    return [
        Band("Bust line", across_front(mesh, BUST), "#E5536B"),
        Band("Under-bust", across_front(mesh, UNDERBUST), "#5A3F94", width=20.0),
    ]


def picture(scene: Scene) -> np.ndarray:
    scene.plotter.render()
    return np.asarray(scene.plotter.screenshot(return_img=True), dtype=float)


def distance_to(mesh: Mesh, points: np.ndarray) -> np.ndarray:
    shape = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
    _, nearest = shape.find_closest_cell(points, return_closest_point=True)
    return np.linalg.norm(points - nearest, axis=1)


# -- lines


@pytest.mark.parametrize("name", ["mannequin", "person"])
def test_a_ribbon_lies_on_the_skin(name: str, request: pytest.FixtureRequest) -> None:
    body = request.getfixturevalue(f"{name}_mesh")
    surface = RibbonSurface(body)
    for z in (UNDERBUST, BUST, BUST + 50.0):
        path = across_front(body, z)
        line = centre_line(path, surface, width=12.0)
        for ribbon in (
            build_ribbon(LineRoute(path), surface, 12.0),
            build_casing(LineRoute(path), surface, 12.0),
        ):
            middle = ribbon.mesh.vertices.reshape(ribbon.rows, 8, 3).mean(axis=1)
            nearest = np.linalg.norm(middle[:, None] - line.points, axis=2).argmin(axis=1)
            bridged = line.lift[nearest]  # there it stands off, as a taut band does
            assert (distance_to(body, ribbon.mesh.vertices) - np.repeat(bridged, 8)).max() < 4.0


def test_a_ribbon_has_its_width_and_looks_outward(mannequin_mesh: Mesh) -> None:
    ribbon = build_ribbon(LineRoute(across_front(mannequin_mesh, BUST)), RibbonSurface(mannequin_mesh), 12.0)
    rows = ribbon.mesh.vertices.reshape(ribbon.rows, 8, 3)
    width = np.linalg.norm(rows[6:-6, 1] - rows[6:-6, -2], axis=1)  # its ends are round
    assert width == pytest.approx(12.0, abs=0.8)
    top = ribbon.mesh.vertex_normals.reshape(ribbon.rows, 8, 3)[3:-3, 3:5].reshape(-1, 3)
    assert (top[:, 1] < 0.0).all()  # the body faces -y


def test_a_ribbon_passes_through_its_control_points(mannequin_mesh: Mesh) -> None:
    path = across_front(mannequin_mesh, BUST)
    ribbon = build_ribbon(LineRoute(path), RibbonSurface(mannequin_mesh), 12.0)
    apart = np.linalg.norm(ribbon.mesh.vertices[None] - path[:, None], axis=2).min(axis=1)
    assert apart.max() < 5.0


def test_ribbons_move_with_the_body(scene: Scene, mannequin_mesh: Mesh) -> None:
    scene.show_bands(lines(mannequin_mesh))
    before, _ = scene.bands.spine("Bust line")
    shift = np.array([3.0, -8.0, 5.0])
    every = np.arange(len(mannequin_mesh.vertices))
    scene.move_body(every, mannequin_mesh.vertices + shift)
    after, _ = scene.bands.spine("Bust line")
    assert after - before == pytest.approx(np.tile(shift, (len(before), 1)), abs=1e-3)


def test_ribbons_stay_on_a_body_that_swells(scene: Scene, mannequin_mesh: Mesh) -> None:
    scene.show_bands(lines(mannequin_mesh))
    every = np.arange(len(mannequin_mesh.vertices))
    bump = 15.0 * np.exp(-(((mannequin_mesh.vertices - [80.0, -200.0, BUST]) / 60.0) ** 2).sum(axis=1))
    moved = mannequin_mesh.moved(mannequin_mesh.vertices + bump[:, None] * mannequin_mesh.vertex_normals)
    scene.move_body(every, moved.vertices)
    spine, _ = scene.bands.spine("Bust line")
    assert distance_to(moved, spine).max() < 4.0


# -- movement in place


def drawn(scene: Scene) -> np.ndarray:
    skin = np.zeros((len(scene.body._skin.source), 3))
    for part in scene.body._parts:
        skin[part.rows] = part.actor.mapper.dataset.points
    return skin


def test_moving_and_restoring_gives_the_same_picture(scene: Scene, mannequin_mesh: Mesh) -> None:
    scene.show_bands(lines(mannequin_mesh))
    points, image = drawn(scene), picture(scene)
    front = np.flatnonzero(mannequin_mesh.vertices[:, 1] < -120.0)
    scene.move_body(front, mannequin_mesh.vertices[front] - [0.0, 15.0, 0.0])
    assert np.abs(drawn(scene) - points).max() == pytest.approx(15.0, abs=1e-3)
    assert np.abs(picture(scene) - image).max() > 20.0
    scene.move_body(front, mannequin_mesh.vertices[front])
    assert np.array_equal(drawn(scene), points)
    assert np.abs(picture(scene) - image).max() <= 1.0


def test_before_shows_the_rest_and_after_what_came_meanwhile(scene: Scene, mannequin_mesh: Mesh) -> None:
    rest = drawn(scene)
    front = np.flatnonzero(mannequin_mesh.vertices[:, 1] < -120.0)
    scene.move_body(front, mannequin_mesh.vertices[front] - [0.0, 5.0, 0.0])
    scene.before(True)
    assert np.array_equal(drawn(scene), rest)
    scene.move_body(front, mannequin_mesh.vertices[front] - [0.0, 9.0, 0.0])
    assert np.array_equal(drawn(scene), rest)
    scene.before(False)
    assert np.abs(drawn(scene) - rest).max() == pytest.approx(9.0, abs=1e-3)


def test_the_rim_of_a_plate_moves_with_the_skin(scene: Scene, mannequin_mesh: Mesh) -> None:
    skin = split_plates(mannequin_mesh)
    rim = np.unique(skin.source[len(mannequin_mesh.vertices) :])
    scene.move_body(rim, mannequin_mesh.vertices[rim] + [0.0, 0.0, 3.0])
    points = drawn(scene)
    assert np.array_equal(points, points[: len(mannequin_mesh.vertices)][skin.source])


# -- the control mesh


def test_control_points_and_edges_follow(scene: Scene, mannequin_mesh: Mesh) -> None:
    path = across_front(mannequin_mesh, BUST)
    low = across_front(mannequin_mesh, UNDERBUST)
    count = len(path)
    a = np.arange(count - 1)
    faces = np.concatenate([np.stack([a, a + count, a + 1], axis=1)])
    control = Mesh(np.concatenate([path, low]), faces)
    scene.show_control_mesh(control, np.r_[np.zeros(count, bool), np.ones(count, bool)])
    scene.set_visible("control", True)
    edges = scene.plotter.actors["control edges"].mapper.dataset
    rest = np.array(edges.points)
    assert distance_to(mannequin_mesh, rest).max() < 3.0
    scene.move_control_mesh(control.vertices - np.array([0.0, 4.0, 0.0]))
    assert edges.points - rest == pytest.approx(np.tile([0.0, -4.0, 0.0], (len(rest), 1)), abs=1e-3)
    scene.set_visible("control", False)
    scene.before(True)
    scene.set_visible("control", True)
    assert np.array_equal(edges.points, rest)


# -- pixels


def test_the_body_is_warm_clay_before_a_quiet_background(scene: Scene) -> None:
    for dark in (False, True):
        scene.set_dark(dark)
        image = picture(scene)
        body = image[HEIGHT // 2 - 20 : HEIGHT // 2 + 20, WIDTH // 2 - 15 : WIDTH // 2 + 15].reshape(-1, 3)
        red, green, blue = body.mean(axis=0)
        assert red > green > blue
        assert 10.0 < red - blue < 90.0
        corner = image[3, 3]
        assert corner == pytest.approx(rgb(APPEARANCES[dark].edge), abs=6.0)


def test_a_line_shows_its_colour(scene: Scene, mannequin_mesh: Mesh) -> None:
    assert violet_pixels(picture(scene)) == 0
    scene.show_bands(lines(mannequin_mesh))
    assert violet_pixels(picture(scene)) > 100
    scene.set_visible("bands", False)
    assert violet_pixels(picture(scene)) == 0


def violet_pixels(image: np.ndarray) -> int:
    red, green, blue = np.moveaxis(image, 2, 0)
    return int(((blue > red + 25.0) & (red > green)).sum())


def test_the_selected_line_has_a_white_casing(scene: Scene, mannequin_mesh: Mesh) -> None:
    scene.set_dark(True)
    scene.show_bands(lines(mannequin_mesh))
    white = (picture(scene) > 250.0).all(axis=2).sum()
    scene.mark_bands(selected="Under-bust")
    assert (picture(scene) > 250.0).all(axis=2).sum() > white + 100


def test_an_unknown_part_is_refused(scene: Scene) -> None:
    with pytest.raises(KeyError):
        scene.set_visible("moustache", True)


# -- what is under the pointer


def test_the_pointer_finds_the_line_it_is_on(scene: Scene, mannequin_mesh: Mesh) -> None:
    scene.show_bands(lines(mannequin_mesh))
    scene.set_view("three-quarter")
    for name in ("Bust line", "Under-bust"):
        place = scene.band_anchor(name)
        x, y, _ = scene.view.to_picture(place, WIDTH, HEIGHT)[0]
        assert scene.band_at(x, y, WIDTH, HEIGHT) == name
    assert scene.band_at(3.0, 3.0, WIDTH, HEIGHT) == ""
    front = scene.band_anchor("Bust line")
    scene.set_view("back")
    x, y, _ = scene.view.to_picture(front, WIDTH, HEIGHT)[0]
    assert scene.band_at(x, y, WIDTH, HEIGHT) == ""


def test_a_point_behind_the_breast_is_hidden(scene: Scene, person_mesh: Mesh) -> None:
    scene.show_body(person_mesh)
    scene.frame_all()
    scene.set_view("front")
    for fold, breast in FOLDS_AND_BREASTS:
        assert scene.hidden(np.array(fold))
        assert not scene.hidden(np.array(breast))


def test_places_ride_on_the_skin_and_back(scene: Scene, mannequin_mesh: Mesh) -> None:
    places = across_front(mannequin_mesh, BUST)
    assert scene.carried_points(places) == pytest.approx(places)
    bump = 15.0 * np.exp(-(((mannequin_mesh.vertices - [80.0, -200.0, BUST]) / 60.0) ** 2).sum(axis=1))
    moved = mannequin_mesh.moved(mannequin_mesh.vertices + bump[:, None] * mannequin_mesh.vertex_normals)
    scene.move_body(np.arange(len(bump)), moved.vertices)
    carried = scene.carried_points(places)
    assert np.linalg.norm(carried - places, axis=1).max() > 10.0
    assert distance_to(moved, carried).max() < 0.5
    assert scene.at_rest(carried) == pytest.approx(places, abs=0.1)
    scene.before(True)
    assert scene.carried_points(places) == pytest.approx(places)


# -- the camera


@pytest.mark.parametrize("name", list(VIEWS))
def test_the_whole_body_fits_in_the_picture(scene: Scene, mannequin_mesh: Mesh, name: str) -> None:
    scene.set_view(name)
    scene.frame_all()
    x, y, _ = scene.view.to_picture(mannequin_mesh.vertices, WIDTH, HEIGHT).T
    assert x.min() > 0.0
    assert x.max() < WIDTH
    assert y.min() > 0.0
    assert y.max() < HEIGHT
