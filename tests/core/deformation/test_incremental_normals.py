"""Normals and volume of what moves, against the whole body and by hand."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from core.deformation.incremental_normals import moving_faces, volume_change
from core.geometry.mesh import Mesh

SPHERE = trimesh.creation.icosphere(subdivisions=3, radius=50.0)
BALL = Mesh(SPHERE.vertices + np.array([300.0, -200.0, 1000.0]), SPHERE.faces)
FRONT = np.flatnonzero(BALL.vertices[:, 1] < -220.0)


def dented() -> np.ndarray:
    positions = BALL.vertices.copy()
    positions[FRONT] += np.random.default_rng(4).normal((0.0, 6.0, 0.0), 2.0, size=(len(FRONT), 3))
    return positions


def test_normals_are_those_of_the_whole_body():
    moving = moving_faces(BALL, FRONT)
    whole = BALL.moved(dented())
    places = dented()[moving.vertices]
    assert moving.normals(places) == pytest.approx(whole.vertex_normals[moving.vertices], abs=1e-13)
    assert moving.normals(moving.rest) == pytest.approx(BALL.vertex_normals[moving.vertices], abs=1e-13)


def test_what_moves_comes_first_as_it_was_given():
    moving = moving_faces(BALL, FRONT[::-1])
    assert np.array_equal(moving.vertices[: moving.count], FRONT[::-1])
    assert len(set(moving.vertices.tolist())) == len(moving.vertices) > moving.count
    assert np.array_equal(moving.rest, BALL.vertices[moving.vertices])
    lonely = Mesh(np.concatenate([BALL.vertices, [[0.0, 0, 0]]]), BALL.faces)
    with_lonely = moving_faces(lonely, np.append(FRONT, len(BALL.vertices)))
    assert with_lonely.vertices[len(FRONT)] == len(BALL.vertices)
    assert with_lonely.normals(with_lonely.rest)[len(FRONT)].tolist() == [0.0, 0.0, 0.0]


def test_no_vertex_that_turns_is_forgotten_and_no_other_taken():
    moving = moving_faces(BALL, FRONT)
    turned = np.abs(BALL.moved(dented()).vertex_normals - BALL.vertex_normals).max(axis=1) > 0.0
    assert set(np.flatnonzero(turned)) <= set(moving.vertices.tolist())
    assert 0 < len(FRONT) < len(moving.vertices) < 0.5 * len(BALL.vertices)


def test_the_volume_gained_is_the_difference_of_the_whole():
    gained = BALL.moved(dented()).enclosed_volume() - BALL.enclosed_volume()
    assert gained < -1e3
    assert volume_change(BALL, dented()) == pytest.approx(gained, rel=1e-10)
    moving = moving_faces(BALL, FRONT)
    assert moving.volume_change(dented()[moving.vertices]) == pytest.approx(gained, rel=1e-10)


@pytest.mark.parametrize("middle", [None, 300.0, 320.0, 0.0])
def test_both_sides_together_gain_the_volume(middle):
    moving = moving_faces(BALL, FRONT, middle)
    places = dented()[moving.vertices]
    gained = BALL.moved(dented()).enclosed_volume() - BALL.enclosed_volume()
    assert moving.side_volume_changes(places).sum() == moving.volume_change(places)
    assert moving.volume_change(places) == pytest.approx(gained, rel=1e-9)


def test_each_side_gains_what_is_done_to_it():
    """A dent on the left only, far from the middle: the right gains nothing, whatever the left loses."""
    for side, chosen in enumerate([BALL.vertices[:, 0] > 325.0, BALL.vertices[:, 0] < 275.0]):
        dent = BALL.vertices.copy()
        dent[chosen & (BALL.vertices[:, 1] < -210.0), 1] += 3.0
        moving = moving_faces(BALL, np.flatnonzero(BALL.vertices[:, 1] < -200.0), 300.0)
        changes = moving.side_volume_changes(dent[moving.vertices])
        gained = BALL.moved(dent).enclosed_volume() - BALL.enclosed_volume()
        assert gained < -1e3
        assert changes[side] == pytest.approx(gained, rel=1e-9)
        assert changes[1 - side] == pytest.approx(0.0, abs=1e-6)


def test_a_tent_on_an_open_sheet_by_hand():
    ring = np.array([[0.0, 0.0], [2, 0], [1, 2], [-1, 2], [-2, 0], [-1, -2], [1, -2]])
    sheet = Mesh(
        np.column_stack([ring, np.full(7, 70.0)]), np.array([[0, k, k % 6 + 1] for k in range(1, 7)])
    )
    tent = sheet.vertices.copy()
    tent[0, 2] += 3.0
    # A pyramid 3 high over a hexagon of area 12.
    assert volume_change(sheet, tent) == pytest.approx(12.0, abs=1e-12)


def test_nothing_moves_nothing_changes():
    assert volume_change(BALL, BALL.vertices) == 0.0
    still = moving_faces(BALL, np.array([], dtype=np.int64))
    assert still.normals(still.rest).shape == (0, 3)
    assert still.volume_change(still.rest) == 0.0
