"""A body tilted in its file is set upright, one that leans is left so, and what the user tells is obeyed."""

import numpy as np
import pytest
import trimesh
from coarse_bodies import coarse_arrays
from odd_objects import limb, together
from scipy.spatial.transform import Rotation

from core.errors import ScanError
from core.scan.orientation.pose import estimate_pose
from tests.core.scan.test_pose import angle_between, torso


def tilted(degrees, about, yaw=0.0):
    """Turn about the vertical, then tilt about a level axis."""
    level = np.array([np.cos(np.radians(about)), np.sin(np.radians(about)), 0.0])
    turn = Rotation.from_rotvec(np.radians(degrees) * level) * Rotation.from_euler("z", yaw, degrees=True)
    return turn.as_matrix()


def with_belly(vertices, forward):
    """Bulge the belly of the mannequin."""
    x, y, z = vertices.T
    share = np.exp(-((x / 95.0) ** 2) - ((z - 170.0) / 85.0) ** 2) * np.clip((-90.0 - y) / 40.0, 0.0, 1.0)
    return np.column_stack([x, y - forward * share, z])


def bent(vertices, degrees):
    """Lean back from the hips, which stay where they are."""
    x, y, z = vertices.T
    return np.column_stack([x, y + np.tan(np.radians(degrees)) * np.maximum(z - 120.0, 0.0), z])


@pytest.mark.parametrize("name", ["mannequin", "person"])
def test_any_tilt_up_to_45_degrees_is_undone(name):
    vertices, faces = coarse_arrays(name)
    for degrees, about, yaw in (
        (12.0, 35.0, 0.0),
        (22.0, 140.0, 50.0),
        (33.0, 250.0, 117.0),
        (45.0, 310.0, 20.0),
        (-6.0, 0.0, 0.0),  # to and fro alone: the plane of the cut and the trunk tell it from a lean
        (16.0, 0.0, 0.0),
    ):
        turn = tilted(degrees, about, yaw)
        pose = estimate_pose(vertices @ turn.T, faces)
        assert pose.is_certain
        assert angle_between(pose, turn) < 2.0
        assert pose.tilt == pytest.approx(abs(degrees), abs=2.0)
        assert "degrees from +z" in str(pose.reason)


def test_one_who_leans_is_left_to_lean_in_an_upright_file():
    vertices, faces = coarse_arrays("mannequin")
    for about, degrees in (
        (0.0, 8.0),
        (0.0, -8.0),
        (90.0, 3.0),
    ):  # back, forth, sideways; the hips stay level
        leaning = vertices.copy()
        high = vertices[:, 2] > 1.0
        leaning[high] = vertices[high] @ tilted(degrees, about).T
        pose = estimate_pose(leaning, faces)
        assert pose.tilt == 0.0
        assert np.array_equal(pose.file_to_mm[2, :3], [0.0, 0.0, 1.0])


@pytest.mark.parametrize("back", [0.0, 8.0, 15.0])
def test_a_foremost_belly_is_no_bust(back):
    vertices, faces = coarse_arrays("mannequin")
    turn = tilted(20.0, 70.0)
    pose = estimate_pose(bent(with_belly(vertices, 95.0), back) @ turn.T, faces)
    assert pose.is_certain
    assert angle_between(pose, turn) < 3.0


def test_legs_are_no_trunk_and_tell_what_is_down():
    vertices, faces = coarse_arrays("mannequin")
    legs = [
        limb((90.0 * side, -90.0, 20.0), (115.0 * side, -90.0, -800.0), 85.0, 40.0) for side in (-1.0, 1.0)
    ]
    whole, skin = together(trimesh.Trimesh(vertices, faces, process=False), *legs)
    pose = estimate_pose(whole, skin)
    assert pose.is_certain
    assert angle_between(pose, np.eye(3)) < 0.5
    assert pose.unit == "mm"


def test_moving_turning_or_mirroring_a_body_moves_its_pose_accordingly():
    vertices, faces = coarse_arrays("person")
    first = estimate_pose(vertices, faces)
    turn = Rotation.from_euler("xyz", (200.0, 33.0, -80.0), degrees=True).as_matrix()
    moved = estimate_pose((vertices @ turn.T + [3000.0, -200.0, 80.0]) / 25.4, faces)
    assert moved.unit == "inch"
    assert moved.file_to_mm[:3, :3] @ turn / 25.4 == pytest.approx(first.file_to_mm[:3, :3], abs=0.02)
    mirrored = estimate_pose(vertices * (-1.0, 1.0, 1.0), faces[:, ::-1])
    assert mirrored.file_to_mm == pytest.approx(first.file_to_mm, abs=0.02)
    flipped = estimate_pose(vertices, faces[:, ::-1])
    assert flipped.file_to_mm == pytest.approx(first.file_to_mm, abs=1e-9)


def test_other_readings_are_offered_each_another():
    pose = estimate_pose(*coarse_arrays("person"))
    assert 1 <= len(pose.others) <= 3
    turns = [matrix[:3, :3] for matrix in (pose.file_to_mm, *pose.others)]
    for k, turn in enumerate(turns):
        assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-9)
        assert np.linalg.det(turn) == pytest.approx(1.0)
        assert all(min(turn[1] @ old[1], turn[2] @ old[2]) < np.cos(np.radians(20.0)) for old in turns[:k])


def test_a_told_axis_is_the_nearest_one_and_a_told_direction_is_meant_exactly():
    vertices, faces = coarse_arrays("mannequin")
    turn = tilted(30.0, 60.0, 15.0)
    near = estimate_pose(vertices @ turn.T, faces, up="+z", front="-y")
    assert angle_between(near, turn) < 2.0
    for words in ("0,0.2,1", "0.1, 0.0, 0.99"):
        direction = np.array([float(word) for word in words.split(",")])
        told = estimate_pose(vertices, faces, up=words)
        assert told.file_to_mm[2, :3] == pytest.approx(direction / np.linalg.norm(direction), abs=1e-9)
    both = estimate_pose(vertices, faces, up="0,0,-2", front="1,0,0")
    expected = [[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]
    assert both.file_to_mm[:3, :3] == pytest.approx(np.array(expected), abs=1e-9)
    assert "set manually" in str(both.reason)


@pytest.mark.parametrize("words", ["up", "1,2", "0,0,0", "nan,0,1", "+w"])
def test_a_direction_that_is_none_is_refused(words):
    with pytest.raises(ScanError, match="Unknown axis"):
        estimate_pose(*torso(), up=words)


def test_a_girth_that_fits_two_units_is_said_not_to_be_sure():
    vertices, faces = torso()
    girth = float(str(estimate_pose(vertices, faces).reason).split("trunk girth is ")[1].split(" ")[0])
    slim = estimate_pose(vertices * 62.0 / girth, faces)
    assert slim.unit == "cm"
    assert not slim.is_certain
    assert "may also be inch (157" in str(slim.reason)
    stout = estimate_pose(vertices * 58.0 / girth, faces)
    assert stout.unit == "inch"
    assert not stout.is_certain
    assert estimate_pose(vertices * 900.0 / girth, faces).is_certain


def test_a_told_up_is_believed_before_the_front_and_neither_is_overruled():
    vertices, faces = coarse_arrays("person")
    for up, front in (("+z", "0,-1,0.5"), ("0,0.05,1", "0,-1,0"), (" Z", "-y")):
        pose = estimate_pose(vertices, faces, up=up, front=front, unit="MM")
        assert (pose.up, pose.front, pose.unit) == ("+z", "-y", "mm")
        assert pose.tilt == pytest.approx(0.0 if "z" in up.lower() else np.degrees(np.arctan(0.05)), abs=0.1)
    against = estimate_pose(vertices, faces, up="-z", front="+y")
    assert (against.up, against.front, against.is_certain) == ("-z", "+y", False)
    assert "set manually. This contradicts the detected shape" in str(against.reason)
    assert estimate_pose(vertices, faces, up="+z", front="-y").is_certain
    for up in ("+y", "-y"):
        with pytest.raises(ScanError, match="or set the up and front axes"):
            estimate_pose(vertices, faces, up=up)


@pytest.mark.parametrize(
    ("radius", "length"), [(18.0, 900.0), (48.0, 200.0)]
)  # slim, or slimmer than its foot
def test_a_pole_in_one_piece_with_the_body_is_no_body_and_tells_no_size(radius, length):
    vertices, faces = coarse_arrays("mannequin")
    pole = trimesh.creation.cylinder(radius, length).apply_translation([0.0, -95.0, 10.0 - 0.5 * length])
    foot = trimesh.creation.cylinder(170.0, 20.0).apply_translation([0.0, -95.0, 10.0 - length])
    pose = estimate_pose(*together(trimesh.Trimesh(vertices, faces, process=False), pole, foot))
    assert (pose.unit, pose.up, pose.front, pose.is_certain) == ("mm", "+z", "-y", True)
    assert pose.stand == pytest.approx(vertices[:, 2].min(), abs=20.0)


def test_neither_a_neck_nor_a_torn_ring_of_skin_is_a_pole():
    vertices, faces = coarse_arrays("mannequin")
    assert estimate_pose(vertices, faces).stand == -np.inf
    assert estimate_pose(vertices, faces, up="-z", front="+y").stand == -np.inf
    x, y, z = vertices[faces].mean(axis=1).T
    patch = (np.abs(x) < 25.0) & (y < -95.0)
    for height in (25.0, 80.0):  # the taller does not go round
        torn = faces[patch | (np.abs(z - 130.0) > 0.5 * height)]
        assert estimate_pose(vertices, torn).stand == -np.inf
    cut = trimesh.Trimesh(vertices, faces[np.abs(z - 130.0) > 15.0], process=False)
    tube = trimesh.creation.cylinder(18.0, 200.0).apply_translation([0.0, -95.0, 110.0])
    assert estimate_pose(*together(cut, tube)).stand == -np.inf  # too little of it shows
