"""Normals and volume of what moves, against the whole body and by hand."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from core.mesh import Mesh
from core.moving import moving_faces, volume_change

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
    assert moving.normals(dented()) == pytest.approx(whole.vertex_normals[moving.vertices], abs=1e-13)
    assert moving.normals(BALL.vertices) == pytest.approx(BALL.vertex_normals[moving.vertices], abs=1e-13)


def test_no_vertex_that_turns_is_forgotten_and_no_other_taken():
    moving = moving_faces(BALL, FRONT)
    turned = np.abs(BALL.moved(dented()).vertex_normals - BALL.vertex_normals).max(axis=1) > 0.0
    assert set(np.flatnonzero(turned)) <= set(moving.vertices.tolist())
    assert 0 < len(FRONT) < len(moving.vertices) < 0.5 * len(BALL.vertices)


def test_the_volume_gained_is_the_difference_of_the_whole():
    gained = BALL.moved(dented()).enclosed_volume() - BALL.enclosed_volume()
    assert gained < -1e3
    assert volume_change(BALL, dented()) == pytest.approx(gained, rel=1e-10)
    assert moving_faces(BALL, FRONT).volume_change(dented()) == pytest.approx(gained, rel=1e-10)


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
    assert still.normals(BALL.vertices).shape == (0, 3)
    assert still.volume_change(dented()) == 0.0
