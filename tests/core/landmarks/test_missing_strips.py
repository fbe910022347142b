"""Strips that a scanner missed, all round the body or down its front and back, are bridged and said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from core.geometry.level_outlines import BINS
from core.geometry.mesh import Mesh
from core.landmarks.detect import find_landmarks
from core.landmarks.torso.cross_sections import trunk_levels
from core.landmarks.torso.gap_filling import over_strips
from core.landmarks.torso.girths import girth_warnings, girths
from core.landmarks.types import Landmarks
from core.scan.body import Body, read_scan

SAMPLES = Path(__file__).parents[3] / "resources" / "samples"


def without(body: Body, axis: int, at: float, wide: float) -> Body:
    mesh = body.mesh
    apart = np.abs(mesh.vertices[mesh.faces].mean(axis=1)[:, axis] - at) > 0.5 * wide
    return Body(Mesh(mesh.vertices, mesh.faces[apart]), body.pose, (), body.name)


@pytest.fixture(scope="module", params=["mannequin", "person"])
def whole(request: pytest.FixtureRequest) -> tuple[Body, Landmarks]:
    body = read_scan(Path(SAMPLES / f"{request.param}.ply"))
    return body, find_landmarks(body)


@pytest.mark.parametrize("wide", [3.0, 20.0])
@pytest.mark.parametrize("name", ["bust", "underbust"])
def test_a_strip_all_round_on_a_girth_is_bridged_and_said(
    whole: tuple[Body, Landmarks], name: str, wide: float
) -> None:
    body, landmarks = whole
    known = girths(body, landmarks)
    split = without(body, 2, known[name].level_mm, wide)
    again = find_landmarks(split)
    found = girths(split, again)
    for side in ("left", "right"):
        away = again.position(f"bust_point_{side}") - landmarks.position(f"bust_point_{side}")
        assert np.linalg.norm(away) < 4.0
    assert found[name].tape_mm == pytest.approx(known[name].tape_mm, rel=0.01)
    assert found[name].bridged_mm > 500.0
    assert any("estimate" in str(doubt) for doubt in girth_warnings(found))


def test_a_patch_that_is_left_of_a_level_does_not_lead_it_astray(whole: tuple[Body, Landmarks]) -> None:
    body, landmarks = whole
    (level,) = trunk_levels(body.mesh, landmarks.bust_level)
    x, y, z = (body.mesh.vertices[body.mesh.faces].mean(axis=1) - landmarks.position("front_centre")).T
    patch = (np.abs(x) < 50.0) & (y < 60.0)
    missing = (np.abs(z + landmarks.position("front_centre")[2] - level.z) < 12.0) & ~patch
    torn = Mesh(body.mesh.vertices, body.mesh.faces[~missing])
    (found,) = trunk_levels(torn, level.z)
    assert found.tape == pytest.approx(level.tape, rel=0.005)


def test_a_body_that_strips_in_front_and_behind_cut_in_two_is_one(whole: tuple[Body, Landmarks]) -> None:
    body, landmarks = whole
    middle = landmarks.position("front_centre")[0]
    split = without(body, 0, middle + 30.0, 16.0)
    again = find_landmarks(split)
    for name in ("bust_point_left", "bust_point_right", "fold_left", "fold_right"):
        assert np.linalg.norm(again.position(name) - landmarks.position(name)) < 2.0
    known, found = girths(body, landmarks), girths(split, again)
    for name in ("bust", "underbust"):
        assert found[name].tape_mm == pytest.approx(known[name].tape_mm, abs=4.0)


@pytest.mark.parametrize(("low", "high"), [(0, 3), (1, 4), (5, 14), (15, 18), (16, 19)])
def test_a_strip_goes_on_as_an_even_taper_does_near_the_ends_too(low: int, high: int) -> None:
    taper = np.tile(100.0 + 3.0 * np.arange(20.0)[:, None], BINS)
    missing = (low < np.arange(20)) & (np.arange(20) < high)
    far = np.where(missing[:, None], np.nan, taper)
    filled, shown = over_strips(far, ~missing, 5.0 * np.arange(20))
    assert shown.all()
    assert np.allclose(filled, taper)


def test_more_than_a_strip_is_not_made_up() -> None:
    missing = (np.arange(20) > 5) & (np.arange(20) < 15)  # 50 mm from skin to skin
    far = np.where(missing[:, None], np.nan, np.full((20, BINS), 100.0))
    filled, shown = over_strips(far, ~missing, 5.0 * np.arange(20))
    assert np.array_equal(shown, ~missing)
    assert np.isnan(filled[missing]).all()
