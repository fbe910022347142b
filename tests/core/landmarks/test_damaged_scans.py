"""Bust landmarks on what scanners and lives leave: holes, other meshes, one breast; points placed by hand."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from worn_scans import decimated

from core.errors import LandmarkError
from core.geometry.mesh import Mesh
from core.landmarks.anchor import find_anchor
from core.landmarks.breast_profiles import OFFSETS, OWN, Profile, profiles
from core.landmarks.chest import find_poles
from core.landmarks.detect import find_landmarks
from core.landmarks.inframammary_fold import Trace, _rival
from core.landmarks.lower_breast import CREASE, MIRRORED, _apart, _confidence, _less_sure
from core.landmarks.manual import project_to_skin
from core.landmarks.torso.cross_sections import scan_torso
from core.landmarks.types import Landmark, Landmarks
from core.landmarks.validation import check
from core.messages import EMPTY
from core.scan.body import Body
from core.scan.orientation.pose import Pose
from tests.core.landmarks.test_landmarks import NAMES, SIDES, found, part, sample, truth


def body(mesh: Mesh) -> Body:
    return Body(mesh, Pose("mm", "+z", "-y", np.eye(4), True, EMPTY, 1.0), (), "a body")


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
    assert any("left" in str(warning) for warning in landmarks.warnings)


def test_holes_under_both_breasts_are_no_refusal() -> None:
    landmarks = holed("mannequin", 35.0, *SIDES)
    assert all(landmarks.points[f"fold_{side}"].confidence < 0.3 for side in SIDES)
    assert len(landmarks.warnings) == 2


def test_a_narrow_gap_all_round_under_the_fold_loses_nothing() -> None:
    whole = sample("person")
    trunk = scan_torso(whole)
    height = find_anchor(trunk).z - 12.0
    level = trunk.z[np.abs(trunk.z - height).argmin()]  # what prominence is measured from
    apart = np.abs(whole.vertices[whole.faces, 2].mean(axis=1) - level) > 1.5
    split = find_landmarks(body(part(whole, apart)))
    for name in ("bust_point_left", "bust_point_right"):
        assert np.linalg.norm(split.position(name) - found("person").position(name)) < 1.0


@cache
def one_sided() -> Body:
    mesh = sample("person")
    x, y, z = mesh.vertices.T
    centre = truth("person", "nipple", "left") + np.array([0.0, 45.0, 5.0])
    inside = np.clip(1.6 - ((x - centre[0]) / 75.0) ** 2 - ((z - centre[2]) / 75.0) ** 2, 0.0, 1.0)
    chest = truth("person", "fold", "left")[1] + 5.0
    flat = np.where((x > 0.0) & (y < chest), y + inside * (chest - y), y)
    return body(mesh.moved(np.stack([x, flat, z], axis=1)))


def test_a_body_with_one_breast_is_taken_with_a_warning() -> None:
    landmarks = find_landmarks(one_sided())
    assert len(landmarks.warnings) == 1
    assert "left" in str(landmarks.warnings[0])
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


def test_a_bust_point_placed_where_no_breast_is_counts() -> None:
    place = truth("person", "nipple", "left") + np.array([0.0, 0.0, 20.0])
    away = np.hypot(*(one_sided().mesh.vertices - place)[:, [0, 2]].T)
    front = one_sided().mesh.vertices[away < 10.0]
    place = front[np.argmin(front[:, 1])]
    landmarks = find_landmarks(one_sided(), {"bust_point_left": place})
    heights = [landmarks.position(f"bust_point_{side}")[2] for side in SIDES]
    assert landmarks.bust_level == pytest.approx(np.mean(heights))
    assert not any("no breast" in str(warning) for warning in landmarks.warnings)


def test_placed_folds_are_no_hole() -> None:
    places = {f"fold_{side}": found("person").position(f"fold_{side}") for side in SIDES}
    assert find_landmarks(body(sample("person")), places).warnings == ()


def test_a_fold_placed_above_its_bust_point_is_doubted() -> None:
    above = found("person").position("bust_point_left") + np.array([0.0, 0.0, 15.0])
    landmarks = find_landmarks(body(sample("person")), {"fold_left": above})
    assert ["left" in str(warning) and "above" in str(warning) for warning in landmarks.warnings] == [True]
    assert landmarks.points["lowest_left"].confidence < 0.5


@pytest.mark.parametrize("more", [(), ("fold",)])
def test_swapped_sides_are_called_swapped(more: tuple[str, ...]) -> None:
    names = [f"{what}_{side}" for what in ("bust_point", *more) for side in SIDES]
    others = [name.replace("left", "R").replace("right", "left").replace("R", "right") for name in names]
    places = {name: found("person").position(other) for name, other in zip(names, others, strict=True)}
    with pytest.raises(LandmarkError, match="swapped") as refusal:
        find_landmarks(body(sample("person")), places)
    assert "Open" not in str(refusal.value.hint), "the scan is not what is wrong"


@pytest.mark.parametrize(
    ("shift", "why"),
    [
        ((60.0, 60.0, 0.0, 0.0), "off the centre of the body"),
        ((0.0, 0.0, 0.0, 70.0), "very different heights"),
        ((-90.0, 90.0, 0.0, 0.0), "mm apart"),
        ((0.0, 0.0, 200.0, 200.0), "no inframammary fold at a plausible height"),
    ],
)
def test_what_cannot_be_a_bust_is_refused_for_its_reason(shift: tuple[float, ...], why: str) -> None:
    mesh, before = sample("person"), found("person")
    trunk = scan_torso(mesh)
    points = dict(before.points)
    for k, side in enumerate(SIDES):
        mark = points[f"bust_point_{side}"]
        points[mark.name] = replace(mark, position=mark.position + np.array([shift[k], 0.0, shift[k + 2]]))
    moved = replace(before, points=points, bust_level=before.bust_level + 0.5 * (shift[2] + shift[3]))
    anchor = find_anchor(trunk)
    poles = find_poles(trunk, anchor)
    assert check(mesh, trunk, anchor, poles, (), before) == ()
    with pytest.raises(LandmarkError, match=why):
        check(mesh, trunk, anchor, poles, (), moved)


def test_a_fold_is_no_surer_than_the_place_of_its_profile() -> None:
    x = OFFSETS.astype(float)
    bust = Landmark("bust_point_left", np.array([0.0, -20.0, 50.0]), 1.0, EMPTY)
    for slope, lost in ((0.0, 1.0), (1.5, 0.35)):
        crease = Trace(np.stack([x, 0.0 * x, slope * x], axis=1), x > -99.0, 0.1, 0.1, 0.0, OWN)
        sure, unsure = (_confidence(crease, replace(bust, confidence=c)) for c in (1.0, 0.3))
        assert sure == 1.0
        assert unsure <= lost
        assert _confidence(replace(crease, rival=1.5), bust) < 0.5, "another place is far more hollow"


def test_the_hollowest_other_place_of_the_profile_rivals_the_fold() -> None:
    arc = np.arange(120.0)
    points = np.stack([0.0 * arc, 0.0 * arc, 60.0 - arc], axis=1)
    bend = 0.03 * np.exp(-0.5 * ((arc - 50.0) / 6.0) ** 2) + 0.06 * np.exp(-0.5 * ((arc - 80.0) / 6.0) ** 2)
    profile = Profile(points, bend, arc > -1.0, True)
    assert _rival(profile, points[50], 10.0) == pytest.approx(2.0, abs=0.05)
    assert _rival(profile, points[80], 10.0) == pytest.approx(0.5, abs=0.05)
    assert _rival(replace(profile, seen=arc < 70.0), points[50], 10.0) == 0.0, "what a hole does not show"


def test_one_of_two_folds_that_contradict_each_other_is_wrong() -> None:
    folds = [
        Landmark(f"fold_{side}", np.array([0.0, 0.0, z]), 0.9, EMPTY)
        for side, z in zip(SIDES, (0.0, 14.0), strict=True)
    ]
    level, hanging = [np.zeros(3)] * 2, [np.zeros(3), np.array([0.0, 0.0, 14.0])]
    assert _apart(folds, hanging) == 0.0, "one breast hangs lower, fold and all"
    apart = _apart(folds, level)
    assert all(_less_sure(fold, other, apart).confidence < 0.5 for fold, other in (folds, folds[::-1]))
    for fold, other in ((True, False), (False, True)):
        pair = replace(folds[0], by_hand=fold), replace(folds[1], by_hand=other)
        assert _less_sure(*pair, apart).confidence == 0.9, "what was placed by hand is no witness"


def test_a_coarse_scan_is_called_coarse() -> None:
    fine = find_landmarks(body(sample("person")))
    vertices, faces = decimated((sample("person").vertices, sample("person").faces), 1500)
    coarse = find_landmarks(body(Mesh(vertices, faces)))
    assert any("coarse" in str(warning) for warning in coarse.warnings)
    assert all(coarse.points[name].confidence < 0.5 * fine.points[name].confidence for name in NAMES)


def test_a_marker_on_the_skin_is_no_profile_of_it() -> None:
    mesh, bust = sample("person"), found("person").position("bust_point_left")
    corners = [(-20.0, -2.0, -10.0), (20.0, -2.0, -10.0), (20.0, -2.0, 10.0), (-20.0, -2.0, 10.0)]
    plate = np.array([[0, 1, 2], [0, 2, 3]]) + len(mesh.vertices)
    marked = Mesh(np.concatenate([mesh.vertices, bust + corners]), np.concatenate([mesh.faces, plate]))
    at = bust - [0.0, 2.0, 0.0]  # on the marker
    bare, seen = (profiles(skin, at, bust[2] - 150.0)[OWN] for skin in (mesh, marked))
    assert np.array_equal(seen.points, bare.points)
    assert seen.whole


@pytest.mark.parametrize(("off", "taken"), [(29.0, True), (31.0, False)])
def test_a_point_is_laid_on_the_skin_from_30_mm_off_and_no_further(off: float, taken: bool) -> None:
    wall = Mesh(np.array([[0.0, 0.0, 0.0], [90.0, 0.0, 0.0], [0.0, 0.0, 90.0]]), np.array([[0, 1, 2]]))
    place = {"fold_left": np.array([20.0, off, 20.0])}
    if taken:
        assert project_to_skin(wall, place)["fold_left"].position == pytest.approx([20.0, 0.0, 20.0])
    else:
        with pytest.raises(LandmarkError, match="more than 30 mm off"):
            project_to_skin(wall, place)


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
