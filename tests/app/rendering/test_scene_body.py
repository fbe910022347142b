"""How the body is prepared for drawing: plates told from skin, and folds darker than what lies open."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from app.rendering.ambient_occlusion import bake_occlusion
from app.rendering.appearance import APPEARANCES, rgb
from app.rendering.body_actor import BodyActor
from app.rendering.render_mesh import plate_faces, render_mesh, split_plates
from app.rendering.vertex_colors import clay_colours
from core.geometry.mesh import Mesh

SAMPLES = Path(__file__).parents[3] / "resources" / "samples"

# The person's true landmarks [mm], left and right: the fold lies behind the breast that hangs over it.
FOLDS_AND_BREASTS = (
    ((112.64, -189.12, 232.53), (112.64, -260.52, 251.40)),
    ((-112.64, -190.60, 243.53), (-112.64, -260.52, 262.99)),
)


# -- plates


def test_all_sides_of_a_box_are_plates() -> None:
    box = pv.Box((0, 100, 0, 100, 0, 100)).triangulate().clean()
    mesh = Mesh(box.points, box.regular_faces)
    assert plate_faces(mesh).all()


def test_a_curved_skin_has_no_plates(person_mesh: Mesh) -> None:
    assert not plate_faces(person_mesh).any()
    assert len(split_plates(person_mesh).source) == len(person_mesh.vertices)


def test_the_mannequin_is_cut_at_neck_arms_and_hips(mannequin_mesh: Mesh) -> None:
    flat = plate_faces(mannequin_mesh)
    normals = mannequin_mesh.face_normals[flat]
    low = mannequin_mesh.vertices[mannequin_mesh.faces[flat]].reshape(-1, 3)[:, 2].min()
    assert normals[:, 2].max() > 0.9  # neck
    assert normals[:, 2].min() < -0.9  # hips
    assert normals[:, 0].max() > 0.7  # the two arms
    assert normals[:, 0].min() < -0.7
    assert low == pytest.approx(mannequin_mesh.vertices[:, 2].min(), abs=1.0)


def test_splitting_keeps_every_triangle_where_it_is(mannequin_mesh: Mesh) -> None:
    skin = split_plates(mannequin_mesh)
    assert np.array_equal(skin.mesh.vertices[skin.mesh.faces], mannequin_mesh.vertices[mannequin_mesh.faces])
    assert np.array_equal(
        skin.source[: len(mannequin_mesh.vertices)], np.arange(len(mannequin_mesh.vertices))
    )
    flat = plate_faces(mannequin_mesh)
    assert skin.plate[skin.mesh.faces[flat]].all()
    assert not skin.plate[skin.mesh.faces[~flat]].any()


# -- what moves


def test_what_another_control_mesh_carries_no_more_stands_where_it_rests() -> None:
    ball = pv.Icosphere(radius=150.0, nsub=4)
    mesh = Mesh(ball.points, ball.regular_faces)
    plotter = pv.Plotter(off_screen=True)
    actor = BodyActor(plotter, mesh, APPEARANCES[False])
    first, then = np.arange(0, 40), np.arange(20, 60)
    for indices, shift in ((first, 9.0), (first, 12.0), (then, 5.0)):
        actor.move(indices, mesh.vertices[indices] + shift, np.tile([0.0, 0.0, 1.0], (len(indices), 1)))
    moved = np.isin(np.arange(len(mesh.vertices)), then)
    assert np.array_equal(actor.displacement, np.where(moved[:, None], 5.0, 0.0) * np.ones(3))
    drawn = np.concatenate([pv.wrap(part.actor.mapper.GetInput()).points for part in actor._parts])
    assert np.abs(drawn[:, None] - mesh.vertices[None, :20]).max(axis=2).min(axis=0).max() < 1e-4
    assert np.array_equal(actor._normals[:20], render_mesh(mesh).normals[:20])
    plotter.close()


# -- ambient occlusion


def test_nothing_shades_a_ball() -> None:
    ball = pv.Icosphere(radius=150.0, nsub=5)
    sky = bake_occlusion(Mesh(ball.points, ball.regular_faces))
    assert sky.min() > 0.8
    assert np.ptp(sky) < 0.15


def test_the_fold_is_darker_than_the_breast(person_mesh: Mesh) -> None:
    sky = bake_occlusion(person_mesh)

    def at(*place: float) -> float:
        return float(sky[np.argmin(np.linalg.norm(person_mesh.vertices - place, axis=1))])

    for fold, breast in FOLDS_AND_BREASTS:
        assert at(*fold) < at(*breast) - 0.25


@pytest.mark.parametrize("dark", [False, True])
def test_clay_deepens_with_the_fold_and_plates_stay_plaster(dark: bool) -> None:
    look = APPEARANCES[dark]
    colours = clay_colours(np.array([0.2, 0.6, 1.0, 0.2]), np.array([False, False, False, True]), look)
    assert colours[0] == pytest.approx(rgb(look.deep))
    assert colours[2] == pytest.approx(rgb(look.clay))
    assert ((colours[0] < colours[1]) & (colours[1] < colours[2])).all()
    assert colours[3] == pytest.approx(rgb(look.plaster))
