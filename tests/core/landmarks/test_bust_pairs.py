"""Bust points as a mirrored pair of spots: a damaged side, hanging breasts, a bridge of cloth, noise."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core.errors import LandmarkError
from core.geometry.mesh import Mesh
from core.geometry.mirror_plane import MIRROR
from core.landmarks.anchor import Anchor, find_anchor
from core.landmarks.bust_point import NIPPLE, SMOOTH
from core.landmarks.chest import forward_places
from core.landmarks.nipple import in_front
from core.landmarks.torso.cross_sections import scan_torso
from core.landmarks.types import CERTAIN
from core.landmarks.validation import check_anchor
from tests.core.landmarks.test_landmarks import SIDES, found, landmarks_of, sample, truth


def off(landmarks, name, side):
    return float(np.linalg.norm(landmarks.position(f"bust_point_{side}") - truth(name, "nipple", side)))


def test_a_bulge_at_one_side_does_not_draw_the_pair_away():
    mesh = sample("mannequin")
    v = mesh.vertices
    at = truth("mannequin", "nipple", "left") + np.array([55.0, 45.0, 75.0])
    share = np.exp(-0.5 * (np.linalg.norm(v - at, axis=1) / 22.0) ** 2)
    bulged = mesh.moved(v + 30.0 * np.outer(share, [0.6, -0.8, 0.0]))  # cloth that bunches at an arm-pit
    places = forward_places(scan_torso(bulged), find_anchor(scan_torso(bulged)))
    for side, place in zip(SIDES, places, strict=True):
        assert np.linalg.norm(place - truth("mannequin", "nipple", side)) < 25.0
    assert max(off(landmarks_of(bulged), "mannequin", side) for side in SIDES) < 10.0


@cache
def hanging(down: float) -> Mesh:
    """The person with breasts that hang over the skin below them: the further out, the lower [mm]."""
    mesh = sample("person")
    v, sunk = mesh.vertices, np.zeros(len(mesh.vertices))
    for side in SIDES:
        nipple, fold = (truth("person", what, side) for what in ("nipple", "fold"))
        away = np.abs((v - nipple) / [70.0, 400.0, 85.0]) ** 2
        own = (away.sum(axis=1) < 1.0) * (1.0 - away.sum(axis=1))
        sunk += own * np.clip((fold[1] + 15.0 - v[:, 1]) / (fold[1] + 15.0 - nipple[1]), 0.0, 1.2) ** 1.5
    return mesh.moved(v - down * np.outer(sunk, [0.0, 0.0, 1.0]))


def sunk_nipple(side: str, down: float) -> np.ndarray:
    """Where the nipple of a hanging breast went, shape (3,) [mm]."""
    rest = sample("person").vertices
    row = np.argmin(np.linalg.norm(rest - truth("person", "nipple", side), axis=1))
    return hanging(down).vertices[row] + truth("person", "nipple", side) - rest[row]


@pytest.mark.parametrize("side", SIDES)
def test_the_rounded_lower_edge_of_a_hanging_breast_is_no_nipple(side):
    landmarks = landmarks_of(hanging(30.0))
    bust = landmarks.points[f"bust_point_{side}"]
    assert bust.rule == NIPPLE
    assert np.linalg.norm(bust.position - sunk_nipple(side, 30.0)) < 4.0


def test_the_skin_behind_a_hanging_breast_is_not_seen_through_it():
    across, along = (each.ravel() for each in np.meshgrid(*[np.arange(-50.0, 51.0, 4.0)] * 2))
    breast = np.stack([across, along, 0.0 * across], axis=1)[along > 0.0]
    chest = np.stack([across + 2.0, along + 2.0, 0.0 * across - 40.0], axis=1)
    shown = in_front(np.concatenate([breast, chest]))
    assert len(shown[shown[:, 2] == 0.0]) == len(breast)
    behind = shown[shown[:, 2] < 0.0]
    assert behind[:, 1].min() < -40.0
    assert behind[:, 1].max() < 5.0


@cache
def in_a_bra() -> Mesh:
    """The mannequin with cloth from breast to breast, down to a band under them."""
    mesh = sample("mannequin")
    v = mesh.vertices
    left = truth("mannequin", "nipple", "left")
    low, high = truth("mannequin", "fold", "left")[2] - 10.0, left[2] + 70.0
    tall = np.clip((v[:, 2] - low) / 60.0, 0.0, 1.0) * np.clip((high - v[:, 2]) / 50.0, 0.0, 1.0)
    inside = np.clip((0.9 * left[0] - np.abs(v[:, 0])) / 30.0, 0.0, 1.0)
    cloth = np.where(v[:, 1] < -90.0, np.minimum(v[:, 1], left[1] + 5.0), v[:, 1])
    share = 0.9 * tall * inside
    return mesh.moved(np.stack([v[:, 0], v[:, 1] + share * (cloth - v[:, 1]), v[:, 2]], axis=1))


def test_a_bridge_between_the_breasts_is_a_bust_all_the_same():
    bare, clad = (find_anchor(scan_torso(mesh)) for mesh in (sample("mannequin"), in_a_bra()))
    assert clad.middle_kink > bare.middle_kink + 5.0
    assert clad.z == pytest.approx(bare.z, abs=5.0)
    landmarks = landmarks_of(in_a_bra())
    assert max(off(landmarks, "mannequin", side) for side in SIDES) < 6.0


def test_the_middle_may_come_forward_as_far_as_the_breasts_where_cloth_spans_from_one_to_the_other():
    check_anchor(Anchor(0.0, 40.0, 20.0, 150.0, ridge=-30.0))
    clad = Anchor(0.0, 40.0, 36.0, 150.0, ridge=2.0)
    check_anchor(clad)
    for ridge in (20.0, -20.0):  # one bump, or two with a cleft that no cloth spans
        with pytest.raises(LandmarkError):
            check_anchor(replace(clad, ridge=ridge))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_noise_on_smooth_breasts_is_no_nipple(seed):
    mesh = sample("mannequin")
    rough = np.random.default_rng(seed).normal(0.0, 1.2, (len(mesh.vertices), 1))
    noisy = landmarks_of(mesh.moved(mesh.vertices + mesh.vertex_normals * rough))
    assert [noisy.points[f"bust_point_{side}"].rule for side in SIDES] == [SMOOTH, SMOOTH]
    assert max(off(noisy, "mannequin", side) for side in SIDES) < 12.0


def test_a_broad_smooth_bust_has_its_points_in_front_and_not_at_its_sides():
    mesh = sample("mannequin")
    v, point = mesh.vertices, truth("mannequin", "nipple", "left")
    tall = np.exp(-0.5 * ((v[:, 2] - point[2]) / 45.0) ** 2)
    out = np.abs(v[:, 0])
    beside = np.clip((out - 0.8 * point[0]) / 40.0, 0.0, 1.0) * np.clip((170.0 - out) / 30.0, 0.0, 1.0)
    wide = v + 35.0 * np.outer(tall * beside * np.sign(v[:, 0]), [1.0, 0.0, 0.0])
    landmarks = landmarks_of(mesh.moved(wide))
    left, right = (landmarks.position(f"bust_point_{side}") for side in SIDES)
    assert np.linalg.norm(left - right * MIRROR) < 4.0
    assert left[0] < point[0] + 15.0


def test_the_samples_open_without_a_doubt_about_their_bust_points():
    for name in ("mannequin", "person"):
        for side in SIDES:
            assert found(name).points[f"bust_point_{side}"].confidence >= CERTAIN
