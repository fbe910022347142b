"""Plane sections: circles, squares, open patches, and planes that run through vertices."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapes import octahedron, torso

from app.research.sphere import sphere
from core.geometry.mesh import Mesh
from core.geometry.plane_sections import arc_length, cut, hull_perimeter, join_segments, resample

BALL = sphere(rings=31, spokes=64)


def cut_level(mesh, z):
    return cut(mesh, (0.0, 0.0, z), (0.0, 0.0, 1.0))


def length_of(section):
    return np.linalg.norm(section.segments[:, 0] - section.segments[:, 1], axis=1).sum()


def test_an_octahedron_is_cut_in_a_square():
    section = cut_level(octahedron(10.0), 4.0)
    ((curve, closed),) = join_segments(section)
    assert closed
    assert arc_length(curve)[-1] == pytest.approx(4 * 6 * np.sqrt(2), rel=1e-14)
    np.testing.assert_allclose(np.abs(curve).sum(axis=1), 10.0, atol=1e-13)


@pytest.mark.parametrize("z", [-77.0, 0.0, 3.5, 50.0])
def test_a_ball_is_cut_in_circles(z):
    ((curve, closed),) = join_segments(cut_level(BALL, z))
    assert closed
    round_it = 2 * np.pi * np.sqrt(100.0**2 - z**2)
    assert arc_length(curve)[-1] == pytest.approx(round_it, rel=5e-3)
    assert arc_length(curve)[-1] < round_it


@settings(deadline=None)
@given(st.floats(-95, 95), st.floats(0, np.pi), st.floats(0, 2 * np.pi))
def test_every_plane_through_a_ball_gives_one_closed_curve_in_that_plane(offset, polar, turn):
    normal = np.array([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)])
    section = cut(BALL, offset * normal, normal)
    ((curve, closed),) = join_segments(section)
    assert closed
    np.testing.assert_allclose(curve @ normal, offset, atol=1e-9)
    assert arc_length(curve)[-1] == pytest.approx(length_of(section), rel=1e-9)


def test_a_plane_through_vertices_still_gives_one_closed_curve():
    ((curve, closed),) = join_segments(cut_level(BALL, float(BALL.vertices[15 * 64, 2])))
    assert closed
    assert len(curve) == 129


def test_both_faces_at_an_edge_give_the_very_same_point():
    section = cut(BALL, (1.0, 2.0, 3.0), (0.2, 0.3, 0.9))
    order = np.argsort(section.edge_ids.ravel(), kind="stable")
    pairs = section.points[order].reshape(-1, 2, 3)
    np.testing.assert_array_equal(pairs[:, 0], pairs[:, 1])


def test_a_plane_beside_the_body_cuts_nothing():
    section = cut_level(BALL, 101.0)
    assert section.segments.shape == (0, 2, 3)
    assert join_segments(section) == []


def test_an_open_patch_gives_an_open_curve_from_border_to_border():
    mesh = torso().mesh
    shuffled = Mesh(mesh.vertices, np.random.default_rng(4).permutation(mesh.faces))
    ((curve, closed),) = join_segments(cut_level(shuffled, 10.0))
    assert not closed
    assert np.abs(curve[[0, -1], 0]).min() > 120.0


def test_two_bodies_give_two_curves_the_longer_first():
    far = BALL.vertices * 0.5 + [300.0, 0.0, 0.0]
    both = Mesh(np.concatenate([far, BALL.vertices]), np.concatenate([BALL.faces, BALL.faces + len(far)]))
    (big, _), (small, _) = join_segments(cut_level(both, 0.0))
    assert arc_length(big)[-1] == pytest.approx(2 * arc_length(small)[-1], rel=1e-9)
    assert big[:, 0].max() < 101.0


def test_the_face_pairs_of_a_section_agree_with_the_plane_on_a_torso():
    section = cut(torso().mesh, (0, 0, 20), (0.1, 0.2, 1.0))
    np.testing.assert_allclose((section.points - [0, 0, 20]) @ [0.1, 0.2, 1.0], 0.0, atol=1e-11)


def test_arc_length_of_a_right_angle():
    np.testing.assert_allclose(arc_length(np.array([[0, 0, 0], [3, 0, 0], [3, 4, 0]])), [0, 3, 7])


def test_resampling_keeps_the_ends_and_the_step():
    curve = np.array([[0.0, 0, 0], [1, 0, 0], [10, 0, 0]])
    points = resample(curve, 2.5)
    np.testing.assert_allclose(points, np.stack([[0, 2.5, 5, 7.5, 10], [0] * 5, [0] * 5], axis=1))
    assert len(resample(curve, 1000.0)) == 2


def test_the_tape_bridges_hollows():
    cross = np.array([[2, 0], [1, 1], [0, 2], [-1, 1], [-2, 0], [-0.1, 0], [0, -2], [1, -1]], dtype=float)
    points = np.column_stack([cross, np.full(len(cross), 7.0)])
    assert hull_perimeter(points) == pytest.approx(4 * 2 * np.sqrt(2))


@pytest.mark.parametrize("points", [np.empty((0, 3)), np.zeros((2, 3)), np.ones((5, 3))])
def test_no_tape_goes_round_nothing(points):
    assert hull_perimeter(points) == 0.0
