"""Triangle meshes: hand values, identities, refused writes."""

import numpy as np
import pytest
import trimesh
from shapes import octahedron, tent, torso

from app.research.sphere import sphere
from core.geometry.mesh import Mesh, boundary_loops, incidence, unit

CORNER = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def test_volume_of_a_corner_tetrahedron_and_its_reversal():
    assert Mesh(CORNER, TETRAHEDRON).enclosed_volume() == pytest.approx(1 / 6, abs=1e-16)
    assert Mesh(CORNER, TETRAHEDRON[:, ::-1]).enclosed_volume() == pytest.approx(-1 / 6, abs=1e-16)


def test_volume_of_an_octahedron_grows_with_the_cube():
    assert octahedron(1.0).enclosed_volume() == pytest.approx(4 / 3, abs=1e-15)
    assert octahedron(10.0).enclosed_volume() == pytest.approx(4000 / 3, abs=1e-11)


def test_volume_of_a_closed_mesh_does_not_depend_on_the_apex():
    ball = sphere()
    assert ball.enclosed_volume((300.0, -20.0, 5.0)) == pytest.approx(ball.enclosed_volume(), rel=1e-12)


def test_volume_of_an_open_tent_is_that_of_its_pyramid():
    mesh, _ = tent(height=3.0)
    assert mesh.enclosed_volume() == pytest.approx(64.0, abs=1e-13)
    assert mesh.enclosed_volume((0.0, 0.0, 3.0)) == pytest.approx(0.0, abs=1e-13)


def test_areas_and_normals_of_a_right_triangle():
    triangle = Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    np.testing.assert_allclose(triangle.area_vectors, [[0, 0, 6]])
    np.testing.assert_allclose(triangle.face_areas, [6])
    np.testing.assert_allclose(triangle.face_normals, [[0, 0, 1]])
    np.testing.assert_allclose(triangle.vertex_normals, [[0, 0, 1]] * 3)


def test_a_degenerate_face_has_no_normal_and_no_warning():
    flat = Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    np.testing.assert_array_equal(flat.face_normals, [[0, 0, 0]])
    np.testing.assert_array_equal(unit(np.zeros((2, 3))), np.zeros((2, 3)))


def test_normals_of_a_ball_point_away_from_its_centre():
    ball = sphere(rings=15, spokes=24)
    outward = np.einsum("ij,ij->i", ball.vertex_normals, unit(ball.vertices))
    assert outward.min() > 0.99


def test_area_vectors_of_a_closed_mesh_cancel():
    ball = sphere()
    np.testing.assert_allclose(ball.area_vectors.sum(axis=0), 0.0, atol=1e-9)


def test_edges_of_a_closed_mesh_obey_euler():
    ball = sphere()
    assert len(ball.vertices) - len(ball.edges) + len(ball.faces) == 2
    assert (ball.edges[:, 0] < ball.edges[:, 1]).all()
    assert len(np.unique(ball.edges, axis=0)) == len(ball.edges)


def test_edges_areas_and_volume_agree_with_an_independent_library():
    mesh = sphere()
    other = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    np.testing.assert_allclose(mesh.face_areas, other.area_faces, rtol=1e-12)
    assert mesh.enclosed_volume() == pytest.approx(other.volume, rel=1e-12)
    assert len(mesh.edges) == len(other.edges_unique)


def test_a_closed_mesh_has_no_border():
    assert octahedron().boundary_loops == ()


def test_the_border_of_a_patch_is_one_loop_in_face_order():
    mesh = torso().mesh
    (loop,) = mesh.boundary_loops
    assert len(loop) == 2 * (12 + 7) == len(set(loop.tolist()))
    half_edges = {tuple(face[[k, (k + 1) % 3]]) for face in mesh.faces for k in range(3)}
    assert all(pair in half_edges for pair in zip(loop, np.roll(loop, -1), strict=True))


def test_the_longest_border_comes_first():
    small = np.array([[0, 1, 2]])
    large = np.array([[3, 4, 5], [3, 5, 6], [3, 6, 7]])
    for faces in (np.concatenate([small, large]), np.concatenate([large, small])):
        assert [len(loop) for loop in boundary_loops(faces)] == [5, 3]


def test_two_patches_that_touch_in_a_point_keep_all_their_border():
    bow_tie = np.array([[0, 1, 2], [0, 3, 4]])
    assert sum(len(loop) for loop in boundary_loops(bow_tie)) == 6


def test_incidence_sums_face_values_at_corners():
    sums = incidence(np.array([[0, 1, 2], [0, 2, 3]]), 5) @ np.array([1.0, 10.0])
    np.testing.assert_array_equal(sums, [11, 1, 11, 10, 0])


def test_arrays_are_copies_that_nobody_can_write_to():
    points = CORNER.copy()
    mesh = Mesh(points, TETRAHEDRON)
    points[0] = 9.0
    assert mesh.vertices[0, 0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        mesh.faces[0] = 1


def test_a_moved_mesh_keeps_its_triangles_and_the_old_one_its_place():
    ball = octahedron()
    moved = ball.moved(ball.vertices * 2.0 + 5.0)
    assert moved.enclosed_volume() == pytest.approx(8 * ball.enclosed_volume())
    np.testing.assert_array_equal(moved.faces, ball.faces)
    assert ball.enclosed_volume() == pytest.approx(4 / 3)
