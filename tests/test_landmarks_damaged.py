"""Bust landmarks on what scanners and lives leave: holes, other meshes, one breast; points placed by hand."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from test_landmarks import NAMES, SIDES, found, part, sample, truth

from core.body import Body
from core.errors import LandmarkError
from core.finding.chest import find_anchor
from core.finding.under_breast import CREASE, MIRRORED
from core.landmark import Landmarks
from core.landmarks import find_landmarks
from core.mesh import Mesh
from core.standing.upright import Pose
from core.trunk import survey


def body(mesh: Mesh) -> Body:
    return Body(mesh, Pose("mm", "+z", "-y", np.eye(4), True, "", 1.0), (), "a body")


def holed(name: str, radius: float, *sides: str) -> Landmarks:
    mesh = sample(name)
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    away = [np.linalg.norm(centres - truth(name, "fold", side), axis=1) for side in sides]
    return find_landmarks(body(part(mesh, np.min(away, axis=0) > radius)))


@pytest.mark.parametrize("name", ["mannequin", "person"])
def test_a_fold_in_a_hole_is_estimated_and_said(name: str) -> None:
    landmarks = holed(name, 35.0, "left")
    fold = landmarks.points["fold_left"]
    assert fold.rule == MIRRORED
    assert fold.confidence < 0.5
    assert fold.position[2] == pytest.approx(truth(name, "fold", "left")[2], abs=4.0)
    assert landmarks.points["fold_right"].rule == CREASE
    assert any("left" in warning for warning in landmarks.warnings)


def test_holes_under_both_breasts_are_no_refusal() -> None:
    landmarks = holed("mannequin", 35.0, *SIDES)
    assert all(landmarks.points[f"fold_{side}"].confidence < 0.3 for side in SIDES)
    assert len(landmarks.warnings) == 2


def test_a_narrow_gap_all_round_under_the_fold_loses_nothing() -> None:
    whole = sample("person")
    trunk = survey(whole)
    level = trunk.z[trunk.level_at(find_anchor(trunk).z - 12.0)]  # what prominence is measured from
    apart = np.abs(whole.vertices[whole.faces, 2].mean(axis=1) - level) > 1.5
    split = find_landmarks(body(part(whole, apart)))
    for name in ("bust_point_left", "bust_point_right"):
        assert np.linalg.norm(split.position(name) - found("person").position(name)) < 1.0


@cache
def one_sided() -> Landmarks:
    mesh = sample("person")
    x, y, z = mesh.vertices.T
    centre = truth("person", "nipple", "left") + np.array([0.0, 45.0, 5.0])
    inside = np.clip(1.6 - ((x - centre[0]) / 75.0) ** 2 - ((z - centre[2]) / 75.0) ** 2, 0.0, 1.0)
    chest = truth("person", "fold", "left")[1] + 5.0
    flat = np.where((x > 0.0) & (y < chest), y + inside * (chest - y), y)
    return find_landmarks(body(mesh.moved(np.stack([x, flat, z], axis=1))))


def test_a_body_with_one_breast_is_taken_with_a_warning() -> None:
    landmarks = one_sided()
    assert len(landmarks.warnings) == 1
    assert "left" in landmarks.warnings[0]
    assert all(landmarks.points[f"{what}_left"].confidence < 0.3 for what in ("bust_point", "fold"))
    right = landmarks.points["bust_point_right"]
    assert right.confidence > 0.5
    assert landmarks.bust_level == pytest.approx(right.position[2])


def test_a_finer_mesh_moves_the_points_little() -> None:
    mesh = sample("person")
    faces = mesh.faces
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    unique, where = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = len(mesh.vertices) + where.reshape(3, -1)
    a, b, c = faces.T
    fine = np.concatenate(
        [np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    )
    vertices = np.concatenate([mesh.vertices, mesh.vertices[unique].mean(axis=1)])
    again = find_landmarks(body(Mesh(vertices, fine)))
    for name in NAMES:
        assert np.linalg.norm(again.position(name) - found("person").position(name)) < 1.0, name


def test_every_point_shows_what_it_was_read_from() -> None:
    for name in NAMES:
        mark = found("person").points[name]
        assert len(mark.evidence) > 5, name
        assert np.linalg.norm(mark.evidence - mark.position, axis=1).min() < 14.0, name


def test_what_depends_on_a_placed_bust_point_follows_it() -> None:
    there = found("person").position("bust_point_left") + np.array([-15.0, 0.0, 0.0])
    landmarks = find_landmarks(body(sample("person")), {"bust_point_left": there})
    bust = landmarks.points["bust_point_left"]
    assert bust.by_hand
    assert bust.confidence == 1.0
    assert landmarks.position("fold_left")[0] == pytest.approx(bust.position[0], abs=0.5)
    assert not landmarks.points["fold_left"].by_hand
    assert np.allclose(landmarks.position("fold_right"), found("person").position("fold_right"))
    heights = [landmarks.position(f"bust_point_{side}")[2] for side in SIDES]
    assert landmarks.bust_level == pytest.approx(np.mean(heights))


def test_placed_points_let_a_body_in_whose_bust_is_not_found() -> None:
    mesh = sample("mannequin")
    squeezed = body(mesh.moved(mesh.vertices * [1.0, 0.3, 1.0]))
    with pytest.raises(LandmarkError):
        find_landmarks(squeezed)
    names = [f"{what}_{side}" for what in ("bust_point", "fold") for side in SIDES]
    placed = {name: found("mannequin").position(name) * [1.0, 0.3, 1.0] for name in names}
    landmarks = find_landmarks(squeezed, placed)
    assert all(landmarks.points[name].by_hand for name in names)
    assert landmarks.underbust_level == pytest.approx(min(placed[name][2] for name in names[2:]), abs=3.0)


@pytest.mark.parametrize(
    "placed",
    [
        {"nose": [0.0, 0.0, 0.0]},
        {"fold_left": [0.0, 0.0]},
        {"fold_left": [0.0, -900.0, 0.0]},
        {"fold_left": [0.0, np.nan, 0.0]},
    ],
)
def test_a_place_that_makes_no_sense_is_refused(placed: dict[str, list[float]]) -> None:
    with pytest.raises(LandmarkError) as refusal:
        find_landmarks(body(sample("person")), {name: np.array(at) for name, at in placed.items()})
    assert refusal.value.hint
