"""Bust landmarks: the samples against their truth, identities, and what has no bust."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import trimesh

from core.errors import LandmarkError
from core.geometry.mesh import Mesh
from core.landmarks.bust_point import MIRRORED, NIPPLE, SMOOTH
from core.landmarks.detect import find_landmarks
from core.landmarks.nipple import relief_kernels
from core.landmarks.types import CERTAIN, Landmarks
from core.messages import EMPTY
from core.scan.body import Body
from core.scan.orientation.pose import Pose

ROOT = Path(__file__).parents[3]
TRUTH = json.loads((ROOT / "tests/data/truth.json").read_text(encoding="utf-8"))
SAMPLES = ("mannequin", "person")
SIDES = ("left", "right")
NAMES = {f"{what}_{side}" for what in ("bust_point", "fold", "lowest") for side in SIDES}


@cache
def sample(name: str) -> Mesh:
    mesh = trimesh.load(ROOT / f"resources/samples/{name}.ply", process=False)
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))


def landmarks_of(mesh: Mesh) -> Landmarks:
    return find_landmarks(Body(mesh, Pose("mm", "+z", "-y", np.eye(4), True, EMPTY, 1.0), (), "a body"))


@cache
def found(name: str) -> Landmarks:
    return landmarks_of(sample(name))


def truth(name: str, what: str, side: str) -> np.ndarray:
    return np.array(TRUTH[name]["landmarks"][f"{what}_{side}"])


def part(mesh: Mesh, keep: np.ndarray) -> Mesh:
    used, faces = np.unique(mesh.faces[keep], return_inverse=True)
    return Mesh(mesh.vertices[used], faces.reshape(-1, 3))


@pytest.mark.parametrize("side", SIDES)
def test_a_nipple_is_found_by_its_relief(side):
    bust = found("person").points[f"bust_point_{side}"]
    assert bust.rule == NIPPLE
    assert bust.confidence > 0.5
    assert np.linalg.norm(bust.position - truth("person", "nipple", side)) < 3.0


@pytest.mark.parametrize("side", SIDES)
def test_a_smooth_breast_gets_a_point_by_its_shape_and_says_so(side):
    bust = found("mannequin").points[f"bust_point_{side}"]
    assert bust.rule == SMOOTH
    assert CERTAIN < bust.confidence < found("person").points[f"bust_point_{side}"].confidence - 0.2
    assert np.linalg.norm(bust.position - truth("mannequin", "nipple", side)) < 10.0


@pytest.mark.parametrize("name", SAMPLES)
@pytest.mark.parametrize("side", SIDES)
def test_fold_and_lowest_point_lie_at_their_heights(name, side):
    assert found(name).position(f"fold_{side}")[2] == pytest.approx(truth(name, "fold", side)[2], abs=2.0)
    lowest = truth(name, "breast_lowest", side)[2]
    assert found(name).position(f"lowest_{side}")[2] == pytest.approx(lowest, abs=2.0)


@pytest.mark.parametrize("name", SAMPLES)
def test_levels_follow_from_the_points(name):
    landmarks = found(name)
    assert set(landmarks.points) >= NAMES
    busts = [landmarks.position(f"bust_point_{side}")[2] for side in SIDES]
    assert landmarks.bust_level == pytest.approx(np.mean(busts))
    rest = [landmarks.position(mark)[2] for mark in NAMES if not mark.startswith("bust")]
    assert landmarks.underbust_level == min(rest)


@pytest.mark.parametrize("name", SAMPLES)
def test_what_was_never_held_against_an_answer_claims_no_certainty(name):
    further = {key: mark for key, mark in found(name).points.items() if key not in NAMES}
    sure = [key for key, mark in further.items() if mark.confidence >= CERTAIN]
    assert all(key.startswith("front_centre") for key in sure), sure
    assert sum(not key.startswith("front_centre") for key in further) > 6


def test_left_is_positive_x_and_an_overhanging_breast_ends_below_its_fold():
    person = found("person")
    for sign, side in zip((1.0, -1.0), SIDES, strict=True):
        assert sign * person.position(f"bust_point_{side}")[0] > 0.0
        assert person.position(f"lowest_{side}")[2] < person.position(f"fold_{side}")[2] - 8.0
    assert person.position("bust_point_left")[2] < person.position("bust_point_right")[2] - 8.0


def test_a_mirrored_body_has_mirrored_landmarks():
    mesh = sample("person")
    twin = landmarks_of(Mesh(mesh.vertices * [-1.0, 1.0, 1.0], mesh.faces[:, ::-1]))
    for name in NAMES:
        other = name.replace("left", "RIGHT").replace("right", "left").replace("RIGHT", "right")
        expected = found("person").position(name) * [-1.0, 1.0, 1.0]
        assert np.linalg.norm(twin.position(other) - expected) < 0.5, name


def test_landmarks_move_with_the_body():
    mesh, shift = sample("person"), np.array([431.0, -87.0, 1250.0])
    moved = landmarks_of(mesh.moved(mesh.vertices + shift))
    for name in NAMES:
        assert np.allclose(moved.position(name), found("person").position(name) + shift, atol=0.5), name


def test_noise_of_a_scanner_moves_the_points_little():
    mesh = sample("person")
    rough = np.random.default_rng(3).normal(0.0, 0.8, (len(mesh.vertices), 1))
    noisy = landmarks_of(mesh.moved(mesh.vertices + mesh.vertex_normals * rough))
    for side in SIDES:
        assert np.linalg.norm(noisy.position(f"bust_point_{side}") - truth("person", "nipple", side)) < 4.0
        assert noisy.position(f"fold_{side}")[2] == pytest.approx(truth("person", "fold", side)[2], abs=6.0)


@cache
def without_left_nipple() -> Mesh:
    """The person with a quadric through the ring round the left nipple in place of it."""
    mesh = sample("person")
    from_left = np.linalg.norm(mesh.vertices - truth("person", "nipple", "left"), axis=1)
    vertices = mesh.vertices.copy()
    flat = from_left < 14.0
    ring = mesh.vertices[(from_left > 14.0) & (from_left < 24.0)]
    vertices[flat, 1] = _basis(vertices[flat]) @ np.linalg.lstsq(_basis(ring), ring[:, 1], rcond=None)[0]
    return mesh.moved(vertices)


def test_one_plain_nipple_helps_the_other_breast():
    landmarks = landmarks_of(without_left_nipple())
    assert landmarks.points["bust_point_right"].rule == NIPPLE
    assert landmarks.points["bust_point_left"].rule == MIRRORED
    left = landmarks.position("bust_point_left")
    assert np.linalg.norm(left - truth("person", "nipple", "left")) < 8.0


def test_a_bump_that_the_other_breast_does_not_bear_out_is_doubted():
    mesh = without_left_nipple()
    marker = mesh.vertices[
        np.argmin(
            np.linalg.norm(mesh.vertices - truth("person", "nipple", "left") - [9.0, 0.0, 12.0], axis=1)
        )
    ]
    off = np.linalg.norm(mesh.vertices - marker, axis=1)
    bump = np.sqrt(np.maximum(6.0**2 - off**2, 0.0))[:, None]  # half a ball, taped on
    marked = landmarks_of(mesh.moved(mesh.vertices + bump * mesh.vertex_normals))
    left, right = (marked.points[f"bust_point_{side}"] for side in SIDES)
    assert np.linalg.norm(left.position - marker) < 7.0
    assert left.confidence < 0.3
    assert right.confidence > 0.5
    assert marked.points["front_centre"].confidence == left.confidence


def _basis(points: np.ndarray) -> np.ndarray:
    x, _, z = (points - truth("person", "nipple", "left")).T
    return np.stack([np.ones_like(x), x, z, x * x, x * z, z * z], axis=1)


def test_relief_of_any_quadric_is_zero_and_of_a_bump_its_height():
    spot, slope_u, slope_v = relief_kernels(2.0)
    reach = len(spot) // 2
    u, v = np.meshgrid(*[np.arange(-reach, reach + 1) * 2.0] * 2)
    quadric = 3.0 + 0.2 * u - 0.1 * v + 0.01 * u * u - 0.02 * u * v + 0.004 * v * v
    assert np.sum(spot * quadric) == pytest.approx(0.0, abs=1e-9)
    assert np.sum(slope_u * quadric) == pytest.approx(0.2)
    assert np.sum(slope_v * quadric) == pytest.approx(-0.1)
    plateau = np.where(np.hypot(u, v) < 8.9, 2.0, 0.0)
    assert np.sum(spot * (quadric + plateau)) == pytest.approx(2.0, abs=0.05)


def _box(size: tuple[float, float, float]) -> Mesh:
    box = trimesh.creation.box(size).subdivide_to_size(25.0)
    return Mesh(np.asarray(box.vertices), np.asarray(box.faces))


def _cylinder() -> Mesh:
    tube = trimesh.creation.cylinder(130.0, 500.0, sections=64).subdivide_to_size(25.0)
    return Mesh(np.asarray(tube.vertices), np.asarray(tube.faces))


def _one_bump() -> Mesh:
    """A tube with a bump in the middle of its front, both sides of which come forward."""
    tube = trimesh.creation.cylinder(130.0, 500.0, sections=64).subdivide_to_size(12.0)
    x, y, z = np.asarray(tube.vertices).T
    bump = np.where(y < 0.0, 80.0 * np.exp(-((np.hypot(x, z - 50.0) / 80.0) ** 4)), 0.0)
    return Mesh(np.stack([1.15 * x, 0.85 * y - bump, z], axis=1), np.asarray(tube.faces))


def _torus() -> Mesh:
    ring = trimesh.creation.torus(150.0, 60.0)
    return Mesh(np.asarray(ring.vertices), np.asarray(ring.faces))


def _half(axis: int, at: float, sign: float) -> Mesh:
    mesh = sample("person")
    return part(mesh, sign * (mesh.vertices[mesh.faces].mean(axis=1)[:, axis] - at) > 0.0)


def _turned(x: float, y: float, z: float) -> Mesh:
    return sample("person").moved(sample("person").vertices * [x, y, z])


NO_BUST = {
    "a cube": lambda: _box((300.0, 300.0, 300.0)),
    "a cylinder": _cylinder,
    "one bump in the middle": _one_bump,
    "a torus": _torus,
    "the back": lambda: _half(1, -100.0, 1.0),
    "the front": lambda: _half(1, -100.0, -1.0),
    "the left half": lambda: _half(0, 0.0, 1.0),
    "the belly": lambda: _half(2, 190.0, -1.0),
    "the shoulders": lambda: _half(2, 330.0, 1.0),
    "turned round": lambda: _turned(-1.0, -1.0, 1.0),
    "upside down": lambda: _turned(1.0, -1.0, -1.0),
    "in metres": lambda: _turned(1e-3, 1e-3, 1e-3),
}


@pytest.mark.parametrize("what", NO_BUST)
def test_what_shows_no_bust_is_refused_in_a_sentence(what):
    with pytest.raises(LandmarkError) as refusal:
        landmarks_of(NO_BUST[what]())
    assert str(refusal.value.message).endswith(".")
    assert str(refusal.value.hint).endswith(".")
