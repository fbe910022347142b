"""Landmarks of the lower trunk on a body with known ones, placed points, refusals and degraded forms."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.errors import LandmarkError
from core.geometry.mesh import Mesh
from core.landmarks.detect import find_landmarks
from core.landmarks.lower_trunk.detect import find_lower_landmarks
from core.landmarks.lower_trunk.girths import lower_girths
from core.landmarks.lower_trunk.levels import tape_profile, waist
from core.landmarks.lower_trunk.outline_profiles import crossings, peak
from core.landmarks.lower_trunk.sections import lower_sections
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.types import CERTAIN, LOWER_NAMES, Landmarks
from core.scan.body import Body, read_scan

ROOT = Path(__file__).parents[4]
TRUTH = json.loads((ROOT / "tests/data/lower_truth.json").read_text())["trunk"]
LEVELS, PLACES = TRUTH["levels"], TRUTH["landmarks"]
LEVEL_NAMES = {"crotch": "crotch", "hip": "hip_largest", "waist": "waist_natural", "belly": "belly"}
LIMITS = {"crotch": 1.2, "hip": 3.0, "waist": 12.2, "belly": 3.5}


@pytest.fixture(scope="module")
def body() -> Body:
    return read_scan(ROOT / "resources/samples/trunk.ply", unit="mm", up="+z", front="-y")


@pytest.fixture(scope="module")
def bust(body: Body) -> Landmarks:
    return find_landmarks(body)


@pytest.fixture(scope="module")
def found(body: Body, bust: Landmarks) -> LowerLandmarks:
    return find_lower_landmarks(body, bust)


def without(body: Body, gone: np.ndarray) -> Body:
    """Return the body without the faces all corners of which are ``gone``, shape (n,)."""
    mesh = body.mesh
    return replace(body, mesh=Mesh(mesh.vertices, mesh.faces[~gone[mesh.faces].all(axis=1)]))


def test_all_landmarks_are_found(found: LowerLandmarks) -> None:
    assert tuple(found.points) == LOWER_NAMES
    assert found.warnings == ()


@pytest.mark.parametrize("name", LEVEL_NAMES)
def test_levels_are_those_of_the_body(found: LowerLandmarks, name: str) -> None:
    assert found.levels[name] == pytest.approx(LEVELS[LEVEL_NAMES[name]], abs=LIMITS[name])
    assert found.points[name].confidence >= CERTAIN
    assert found.points[name].position[2] == found.levels[name]


@pytest.mark.parametrize("side", ["left", "right"])
def test_buttocks_and_folds_are_those_of_the_body(found: LowerLandmarks, side: str) -> None:
    point, fold = (found.points[f"{name}_{side}"] for name in ("buttock", "gluteal_fold"))
    assert point.position[1] == pytest.approx(PLACES[f"buttock_{side}"][1], abs=1.0)
    assert point.position[2] == pytest.approx(PLACES[f"buttock_{side}"][2], abs=8.0)
    assert fold.position[2] == pytest.approx(PLACES[f"gluteal_fold_{side}"][2], abs=12.0)
    assert fold.position[1] < point.position[1] - 20.0


def test_suggestions_are_not_sure(found: LowerLandmarks) -> None:
    for name, mark in found.points.items():
        if name.startswith(("iliac_crest", "side_seam", "leg_opening")):
            assert mark.confidence < CERTAIN
            assert mark.position[0] * (1.0 if name.endswith("left") else -1.0) > 80.0


def test_the_leg_opening_is_a_closed_curve_round_one_leg(found: LowerLandmarks) -> None:
    curve = found.points["leg_opening_left"].evidence
    np.testing.assert_array_equal(curve[0], curve[-1])
    assert curve[:, 0].min() >= -1.0
    assert curve[:, 2].min() == pytest.approx(found.levels["gluteal_fold_left"], abs=5.0)


def test_girths_are_those_of_the_body(body: Body, bust: Landmarks, found: LowerLandmarks) -> None:
    girths = lower_girths(lower_sections(body.smoothed, bust.underbust_level), found)
    tapes = TRUTH["tape_mm"]
    assert girths["hip"].tape_mm == pytest.approx(tapes["hip_largest"], abs=1.0)
    assert girths["waist"].tape_mm == pytest.approx(tapes["waist_natural"], abs=1.0)
    assert girths["belly"].tape_mm == pytest.approx(tapes["belly"], abs=5.4)
    assert girths["buttock"].tape_mm == pytest.approx(tapes["buttock_level"], abs=5.3)
    assert set(girths) == {"waist", "belly", "hip", "buttock", "thigh_left", "thigh_right"}
    assert girths["hip"].skin_mm > girths["hip"].tape_mm


def test_a_placed_point_stands_and_its_level_follows(body: Body, bust: Landmarks) -> None:
    skin = body.smoothed.vertices
    spot = skin[np.argmin(np.linalg.norm(skin - [0.0, -200.0, 170.0], axis=1))]
    found = find_lower_landmarks(body, bust, {"waist": spot})
    assert found.points["waist"].by_hand
    assert found.points["waist"].confidence == 1.0
    assert found.levels["waist"] == pytest.approx(float(spot[2]), abs=1e-6)
    assert found.points["waist"].off > 30.0


@pytest.mark.parametrize(
    ("name", "place", "text"),
    [
        ("knee", (0.0, -80.0, -91.0), "no landmark knee"),
        ("crotch", (0.0, np.nan, 0.0), "three numbers"),
        ("crotch", (0.0, -900.0, 0.0), "off the skin"),
    ],
)
def test_a_wrong_placed_point_is_refused(
    body: Body, bust: Landmarks, name: str, place: tuple[float, ...], text: str
) -> None:
    with pytest.raises(LandmarkError, match=text):
        find_lower_landmarks(body, bust, {name: np.array(place)})


def test_a_scan_that_ends_above_the_crotch_is_refused(body: Body, bust: Landmarks) -> None:
    torso = without(body, body.mesh.vertices[:, 2] < -60.0)
    with pytest.raises(LandmarkError, match="ends above the crotch"):
        find_lower_landmarks(torso, bust)
    with pytest.raises(LandmarkError, match="ends above the crotch"):
        find_lower_landmarks(torso, bust, {"crotch": np.array(PLACES["hip_front"])})


def test_a_hole_between_the_legs_makes_the_crotch_unsure(body: Body, bust: Landmarks) -> None:
    away = np.linalg.norm(body.mesh.vertices - PLACES["crotch"], axis=1)
    found = find_lower_landmarks(without(body, away < 35.0), bust)
    assert found.points["crotch"].confidence < CERTAIN
    assert any("crotch" in str(warning) for warning in found.warnings)


def test_a_leg_that_ends_higher_changes_nothing(body: Body, bust: Landmarks, found: LowerLandmarks) -> None:
    x, _, z = body.mesh.vertices.T
    short = find_lower_landmarks(without(body, (z < -180.0) & (x > 0.0)), bust)
    for name in ("crotch", "hip", "waist", "belly", "buttock"):
        assert short.levels[name] == pytest.approx(found.levels[name], abs=0.3)


def test_a_body_without_a_waist_gets_one_by_proportion() -> None:
    z = np.arange(0.0, 300.0, 4.0)
    level = waist((z, 1000.0 - z), 20.0, 300.0, 1.2)
    assert level.z == pytest.approx(300.0 - 80.0 * 1.2)
    assert level.confidence < CERTAIN


def test_a_waist_is_the_least_tape() -> None:
    z = np.arange(0.0, 300.0, 4.0)
    level = waist((z, 700.0 + 0.01 * (z - 190.0) ** 2), 20.0, 300.0, 1.0)
    assert level.z == pytest.approx(190.0)
    assert level.confidence >= CERTAIN


def test_crossings_of_a_square() -> None:
    square = np.array([[-1.0, -2.0, 5.0], [1.0, -2.0, 5.0], [1.0, 2.0, 5.0], [-1.0, 2.0, 5.0]])
    np.testing.assert_allclose(crossings(square, 0.25), [-2.0, 2.0])
    np.testing.assert_allclose(crossings(square, 0.5, axis=1), [-1.0, 1.0])
    assert len(crossings(square, 3.0)) == 0


def test_the_peak_of_a_parabola_is_between_its_values() -> None:
    at = np.arange(5.0)
    assert peak(at, -((at - 2.3) ** 2)) == (pytest.approx(2.3), True)
    assert peak(at, at) == (4.0, False)


def test_tapes_are_smoothed_over_the_trunk(body: Body, bust: Landmarks) -> None:
    z, tape = tape_profile(lower_sections(body.smoothed, bust.underbust_level), LEVELS["crotch"] + 4.0)
    assert np.isfinite(tape).all()
    assert tape.max() == pytest.approx(TRUTH["tape_mm"]["hip_largest"], abs=2.0)
    assert z[-1] <= bust.underbust_level
