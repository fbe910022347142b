"""What is no upper body is refused with its reason, at any tilt; a body worn hard is not."""

import numpy as np
import pytest
import trimesh
from coarse_bodies import coarse_arrays
from odd_objects import objects, pieces
from scipy.spatial.transform import Rotation

from app.presenters.samples import sample_path
from core.errors import UserError
from core.geometry.mesh import Mesh
from core.landmarks.detect import find_landmarks
from core.scan.body import Body
from core.scan.orientation.pose import estimate_pose
from tests.core.scan.test_pose import angle_between

OBJECTS = objects()
TILTED = Rotation.from_euler("xyz", (25.0, -20.0, 70.0), degrees=True).as_matrix()


WHOLE = trimesh.load(sample_path("mannequin"), process=False)
PIECES = pieces((np.array(WHOLE.vertices), np.array(WHOLE.faces)), fold=299.0, bust=347.0)


def understood(vertices, faces):
    """Take a shape through pose and landmarks. Raises UserError."""
    pose = estimate_pose(vertices, faces)
    turn = pose.file_to_mm[:3, :3]
    find_landmarks(Body(Mesh(vertices @ turn.T, faces), pose, (), "thing"))


@pytest.mark.parametrize("name", OBJECTS)
def test_things_of_human_size_are_refused_at_any_tilt(name):
    vertices, faces = OBJECTS[name]
    with pytest.raises(UserError, match=r"bust|too flat"):  # not for their size
        understood(vertices @ TILTED.T, faces)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("left half", "only half of an upper body|not alike"),
        ("right half", "only half of an upper body|not alike"),
        ("front half", "only half of an upper body|too flat"),
        ("back half", "only half of an upper body|too flat"),
        ("belly", "too little|inframammary folds not detected"),
        ("above the bust", "no bust"),
    ],
)
def test_a_piece_of_a_body_is_refused_with_its_reason(name, words):
    with pytest.raises(UserError, match=words):
        understood(*PIECES[name])


def holes(vertices, faces, radius=28.0):
    """Cut round holes, one of them large, under a breast."""
    middles = np.array(
        [(105.0, -190.0, 285.0), (-60.0, 0.0, 350.0), (0.0, -200.0, 150.0), (90.0, -30.0, 450.0)]
    )
    away = np.linalg.norm(vertices[:, None] - middles, axis=2) - [20.0, 0.0, 0.0, 0.0]
    return vertices, faces[(away.min(axis=1) > radius)[faces].all(axis=1)]


def without_left_breast(vertices, faces):
    """Press the left breast flat."""
    out = vertices.copy()
    near = (
        (np.abs(vertices[:, 0] - 95.0) < 85.0)
        & (np.abs(vertices[:, 2] - 345.0) < 85.0)
        & (vertices[:, 1] < -90.0)
    )
    out[near, 1] = np.maximum(vertices[near, 1], -165.0)
    return out, faces


def with_a_gap(vertices, faces):
    """Take out a level of the trunk, all round, as if a belt had hidden it."""
    return vertices, faces[(np.abs(vertices[:, 2] - 200.0) > 8.0)[faces].all(axis=1)]


@pytest.mark.parametrize("worn", [holes, without_left_breast, with_a_gap])
def test_a_body_that_was_worn_hard_is_understood(worn):
    vertices, faces = worn(*coarse_arrays("mannequin"))
    pose = estimate_pose(vertices @ TILTED.T, faces)
    assert pose.unit == "mm"
    assert angle_between(pose, TILTED) < 3.0
