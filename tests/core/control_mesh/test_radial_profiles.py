"""Rays out of a body and folds on its profiles, against answers known by hand."""

import numpy as np
import pytest
import trimesh

from core.control_mesh.radial_profiles import Profile, azimuth_direction, find_fold, profile, ray_exits
from core.geometry.mesh import Mesh
from core.geometry.plane_sections import arc_length

AXIS = np.zeros(3)


def box(*sizes):
    shape = trimesh.creation.box(extents=sizes)
    return Mesh(shape.vertices, shape.faces)


def joined(*meshes):
    shift = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    faces = [mesh.faces + k for mesh, k in zip(meshes, shift[:-1], strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def profile_through(corners):
    """A profile over straight stretches in the plane of reach and height, walked from the top."""
    reach, z = np.array(corners, dtype=float).T
    points = np.column_stack([0.0 * reach, -reach, z])
    return Profile(points, arc_length(points), reach)


def test_heading_is_forward_at_zero_and_left_at_ninety_degrees():
    np.testing.assert_allclose(azimuth_direction(0.0), (0.0, -1.0, 0.0), atol=1e-15)
    np.testing.assert_allclose(azimuth_direction(np.pi / 2), (1.0, 0.0, 0.0), atol=1e-15)


@pytest.mark.parametrize("degrees", [0.0, 17.0, 45.0, -90.0, 180.0])
@pytest.mark.parametrize("height", [0.0, 3.0])
def test_ray_out_of_a_box_also_through_its_edges_and_corners(degrees, height):
    direction = azimuth_direction(np.radians(degrees))
    (ways,) = ray_exits(box(20.0, 20.0, 40.0), np.array([[0.0, 0.0, height]]), direction[None])
    np.testing.assert_allclose(ways, 10.0 / np.abs(direction).max())
    assert len(ways) >= 1


def test_exits_of_nested_bodies_come_in_order_and_entries_do_not_count():
    arm = box(2.0, 2.0, 2.0)
    mesh = joined(box(10.0, 10.0, 10.0), arm.moved(arm.vertices + np.array([20.0, 0.0, 0.0])))
    ways = ray_exits(
        mesh, np.array([[0.1, 0.2, 0.3], [0.1, 0.2, 0.3]]), np.array([[3.0, 0, 0], [-3.0, 0, 0]])
    )
    np.testing.assert_allclose(np.unique(ways[0]), [4.9, 20.9])
    np.testing.assert_allclose(np.unique(ways[1]), [5.1])


def test_ray_through_a_hole_finds_nothing():
    closed = box(20.0, 20.0, 20.0)
    holed = Mesh(closed.vertices, closed.faces[closed.face_normals[:, 1] > -0.5])
    ways = ray_exits(holed, np.array([[1.0, 0.0, 2.0]]), azimuth_direction(0.0)[None])
    assert len(ways[0]) == 0


def test_profile_runs_down_the_front_of_a_box_to_the_bottom_asked_for():
    mesh = box(20.0, 20.0, 200.0)
    start = np.array([3.0, -10.0, 50.0])
    down = profile(mesh, AXIS, start, -60.0)
    np.testing.assert_allclose(down.points[0], start)
    np.testing.assert_allclose(down.reach, np.hypot(3.0, 10.0))
    assert down.points[-1, 2] < -60.0
    np.testing.assert_allclose(down.at(30.0), (3.0, -10.0, 20.0))
    assert down.at(down.next_below(0.0, 0.0))[2] < 0.0
    assert down.next_below(70.0, 0.0) >= 70.0
    assert down.next_below(0.0, -500.0) == down.arc[-1]


def test_profile_ended_by_a_hole_is_none():
    mesh = box(20.0, 20.0, 200.0)
    holed = Mesh(mesh.vertices * (1.0, 1.0, 0.2), mesh.faces[mesh.face_normals[:, 2] > -0.5])
    assert profile(holed, AXIS, np.array([3.0, -10.0, 10.0]), -60.0) is None


def test_convex_profile_has_no_fold_worth_naming():
    angle = np.linspace(0.0, np.pi / 2, 60)
    round_one = profile_through(np.column_stack([100.0 * np.cos(angle), -100.0 * np.sin(angle)]))
    fold = find_fold(round_one, sharpest=True)
    assert fold is None or fold.depth < 0.1


@pytest.mark.parametrize("sharpest", [True, False])
def test_fold_of_an_overhanging_breast_lies_in_the_corner(sharpest):
    # From the bust point forward and down, back under the breast and up into the crease, then down the ribs.
    down = profile_through([(200.0, 0.0), (210.0, -30.0), (190.0, -45.0), (130.0, -30.0), (130.0, -140.0)])
    fold = find_fold(down, sharpest)
    assert fold.arc == pytest.approx(float(down.arc[3]), abs=2.1)
    assert fold.z == pytest.approx(-30.0, abs=2.0)
    # The outline runs straight from (210, -30) to the end: 80 mm before the crease, and 80 / 110 steep.
    assert fold.depth == pytest.approx(80.0 * 110.0 / np.hypot(80.0, 110.0), abs=1.0)


def test_sharpest_fold_leaves_the_deepest_place_for_the_crease():
    # The deepest place under the outline is the middle of the flat stretch; the crease is its upper end.
    flat = [(200.0, 0.0), (190.0, -30.0), (140.0, -35.0), (139.0, -70.0), (150.0, -110.0), (150.0, -120.0)]
    deepest, crease = (find_fold(profile_through(flat), sharpest) for sharpest in (False, True))
    assert deepest.depth == crease.depth
    assert crease.z == pytest.approx(-35.0, abs=2.0)
    assert deepest.arc >= crease.arc
