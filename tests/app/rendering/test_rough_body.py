"""A large body that stands still is drawn by a rough copy where nobody sees the difference."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import pyvista as pv
from PySide6.QtWidgets import QApplication

from app.gui.theme.stylesheet import apply_theme
from app.gui.viewport.screenshot import fine_picture
from app.gui.viewport.split_view import SplitView
from app.gui.viewport.viewport import Viewport
from app.presenters.lines import bands
from app.rendering import render_mesh as piece_module
from app.rendering import ribbon_mesh as ribbon_module
from app.rendering.band import Band
from app.rendering.prepare import prepare_scene
from app.rendering.render_mesh import CELL, mesh_parts, render_mesh
from core.document.design import Design, ScanSource
from core.geometry.mesh import Mesh
from core.pipeline.build import build

RADIUS = 30.0


@pytest.fixture
def ball(monkeypatch) -> Mesh:
    monkeypatch.setattr(piece_module, "LARGE", 1000)
    fine = pv.Icosphere(radius=RADIUS, nsub=6)
    return Mesh(fine.points, fine.regular_faces)


def upper(ball: Mesh) -> np.ndarray:
    return np.flatnonzero(ball.vertices[:, 2] > 0.5 * RADIUS)


def test_a_rough_copy_has_few_faces_and_lies_on_the_skin(ball):
    still, _, rough = mesh_parts(render_mesh(ball), upper(ball))
    assert len(rough.faces) < 0.25 * len(still.faces)
    off = np.abs(np.linalg.norm(rough.places, axis=1) - RADIUS)
    assert off.max() < CELL**2 / (2.0 * RADIUS)  # the sag of a cell
    outward = np.einsum("ij,ij->i", rough.normals, rough.places) / RADIUS
    assert outward.min() > 0.97


def test_a_rough_copy_ends_where_the_moving_part_begins(ball):
    still, moving, rough = mesh_parts(render_mesh(ball), upper(ball))
    shared = np.intersect1d(still.rows, moving.rows)
    rim = np.isin(rough.rows, shared)
    assert np.array_equal(np.sort(rough.rows[rim]), shared)
    assert np.allclose(rough.places[rim], ball.vertices[rough.rows[rim]], atol=1e-5)


def test_sheets_back_to_back_in_one_cell_stay_apart(monkeypatch):
    monkeypatch.setattr(piece_module, "LARGE", 10)
    grid = pv.Plane(i_size=60.0, j_size=60.0, i_resolution=60, j_resolution=60).triangulate()
    places, faces = np.asarray(grid.points, float), grid.regular_faces
    apart = np.array([0.0, 0.0, 0.5])  # both nearer than a cell is wide
    mesh = Mesh(
        np.vstack([places + apart, places - apart]),
        np.vstack([faces, faces[:, ::-1] + len(places)]),
    )
    _, _, rough = mesh_parts(render_mesh(mesh), np.empty(0, dtype=np.int64))
    assert set(np.round(rough.places[:, 2], 3)) == {0.5, -0.5}


def test_usual_bodies_have_no_rough_copy():
    small = pv.Icosphere(radius=RADIUS, nsub=3)
    assert (
        mesh_parts(render_mesh(Mesh(small.points, small.regular_faces)), np.empty(0, dtype=np.int64)).rough
        is None
    )


def test_the_rough_copy_is_drawn_in_place_of_what_stands_still(ball, scene):
    scene.show_body(ball, upper(ball))
    shown = lambda: {n for n, a in scene.plotter.renderer.actors.items() if "body" in n and a.GetVisibility()}  # noqa: E731
    assert shown() == {"body", "body that moves"}
    scene.body.set_detail(math.inf)
    assert shown() == {"rough body", "body that moves"}
    scene.set_visible("body", False)
    assert not shown()
    scene.set_visible("body", True)
    scene.body.set_detail(0.5 * CELL)
    assert shown() == {"body", "body that moves"}


def test_colours_reach_the_rough_copy(ball, scene):
    scene.show_body(ball, upper(ball))
    scene.body.set_occlusion(np.where(ball.vertices[:, 0] > 0.0, 1.0, 0.0))
    rough = scene.body._rough
    drawn = np.asarray(rough._data.point_data["Colour"])
    assert np.array_equal(drawn, scene.body.colours[rough.rows])
    assert len(np.unique(drawn, axis=0)) == 2


def test_sights_meet_a_large_body_where_it_is(ball, scene):
    scene.show_body(ball, upper(ball))
    met = scene.hit_body(np.array([0.0, -100.0, -10.0]), np.array([0.0, 0.0, -10.0]))
    assert np.allclose(met, [0.0, -math.sqrt(RADIUS**2 - 100.0), -10.0], atol=0.1)


def test_bands_that_were_made_ready_are_not_laid_again(mannequin, scene, monkeypatch):
    stages = build(Design(ScanSource(str(mannequin))))
    prepare_scene(stages)
    monkeypatch.setattr(ribbon_module, "centre_line", _refuse)
    scene.show_body(stages.body.mesh, stages.moving.vertices)
    scene.show_bands(bands(stages, ()))
    scene.mark_bands("mid-bust")  # its casing too
    assert set(scene.bands.names) == {line.name for line in stages.model.lines}
    with pytest.raises(AssertionError, match="laid again"):
        scene.show_bands([Band("other", stages.control.mesh.vertices[:5], "#000000")])


def test_what_a_body_was_moved_by_is_told_as_it_is_shown(ball, scene):
    scene.show_body(ball, upper(ball))
    rows = upper(ball)
    scene.move_body(rows, ball.vertices[rows] * 1.1, ball.vertex_normals[rows])
    assert np.allclose(scene.body.displacement[rows], 0.1 * ball.vertices[rows])
    assert np.count_nonzero(scene.body.displacement.any(axis=1)) == len(rows)
    scene.before(True)
    assert not scene.body.displacement.any()
    scene.before(False)
    assert np.allclose(scene.body.displacement[rows], 0.1 * ball.vertices[rows])


def test_the_view_draws_every_detail_only_of_what_is_seen_near(qtbot, ball, monkeypatch):
    apply_theme(QApplication.instance(), dark=False)
    view = Viewport()
    panes = SplitView(view)
    qtbot.addWidget(panes)
    view.motion = False
    panes.resize(360, 270)
    panes.show()
    qtbot.waitExposed(panes)
    view.scene.show_body(ball, upper(ball))
    known = []
    monkeypatch.setattr(view.scene.body, "set_detail", known.append)
    for distance, near in ((1200.0, False), (150.0, True)):
        view.look_from(replace(view.scene.view, distance=distance))
        view.request_draw()
        assert known[-1] == math.inf  # while it moves
        view.picture()
        assert (known[-1] < CELL) is near
    view.look_from(replace(view.scene.view, distance=1200.0))
    known.clear()
    fine_picture(panes, 2.0)
    assert 0.0 in known  # what others get is whole
    view.close_view()


def _refuse(*_: object, **__: object) -> None:
    raise AssertionError("laid again")
