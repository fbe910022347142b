"""Arms, legs and holes: the girth of the trunk is that of the trunk, however the arms are posed."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import trimesh
from posed_bodies import POSES, apart, arms, grown
from scipy.special import ellipe

from core.geometry.mesh import Mesh
from core.landmarks.torso.cross_sections import scan_torso, trunk_levels

ROOT = Path(__file__).parents[3]
TRUTH = json.loads((ROOT / "tests/data/truth.json").read_text(encoding="utf-8"))["person"]
BUST, UNDER, WAIST = (TRUTH["girths"][name]["level_z"] for name in ("bust", "underbust_stable", "waist"))
TOUCHING = ("touching", "a little behind")


@cache
def person() -> Mesh:
    mesh = trimesh.load(ROOT / "resources/samples/person.ply", process=False)
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))


@cache
def column() -> Mesh:
    """An upright elliptic cylinder, 280 mm wide and 200 mm deep, 700 mm high."""
    round_, z = np.meshgrid(np.radians(np.arange(0.0, 360.0, 1.5)), np.arange(-350.0, 350.1, 10.0))
    points = np.stack([140.0 * np.cos(round_), 100.0 * np.sin(round_), z], axis=-1).reshape(-1, 3)
    corner = np.arange(70 * 240).reshape(70, 240)
    after = np.roll(corner, -1, axis=1)
    faces = [[corner, after, after + 240], [corner, after + 240, corner + 240]]
    return Mesh(points, np.concatenate([np.stack(side, axis=-1).reshape(-1, 3) for side in faces]))


ROUND = 4.0 * 140.0 * ellipe(1.0 - (100.0 / 140.0) ** 2)


def tape(mesh: Mesh, z: float) -> float:
    return trunk_levels(mesh, [z])[0].tape


def without(mesh: Mesh, gone: Callable[[np.ndarray], np.ndarray]) -> Mesh:
    return Mesh(mesh.vertices, mesh.faces[~gone(mesh.vertices[mesh.faces].mean(axis=1))])


@pytest.mark.parametrize("pose", POSES)
def test_arms_apart_from_a_column_are_left_out_of_its_girth(pose):
    body = apart(column(), arms(pose, 140.0, (0.0, 0.0), 100.0))
    for z in (-150.0, -20.0, 60.0, 100.0):
        assert tape(body, z) == pytest.approx(ROUND, rel=2e-3), z


@pytest.mark.parametrize("pose", TOUCHING)
def test_arms_grown_together_with_a_column_are_cut_off(pose):
    body = grown(column(), arms(pose, 140.0, (0.0, 0.0), 100.0)[::2], cell=6.0)
    for z in (-150.0, -50.0, -20.0, 0.0, 40.0):
        level = trunk_levels(body, [z])[0]
        assert level.tape == pytest.approx(ROUND, rel=5e-3), z
    assert level.bridged_mm > 60.0
    assert np.abs(level.points[:, 0]).max() < 146.0


@pytest.mark.parametrize("pose", POSES)
def test_the_bust_girth_of_a_person_does_not_depend_on_arms_apart(pose):
    body = apart(person(), arms(pose, 150.0, (0.0, -120.0), BUST))
    for z in (UNDER, BUST):
        assert tape(body, z) == pytest.approx(tape(person(), z), rel=1e-3)


def test_the_girths_of_a_person_do_not_depend_on_arms_that_touch():
    upper = arms("touching", 150.0, (0.0, -120.0), BUST)[::2]
    body = grown(person(), upper, cell=7.0, low=UNDER - 60.0)
    assert trunk_levels(body, [BUST])[0].bridged_mm > 40.0
    for z in (UNDER, BUST):
        assert tape(body, z) == pytest.approx(tape(person(), z), rel=5e-3)


def test_arms_can_be_asked_for():
    body = grown(column(), arms("touching", 140.0, (0.0, 0.0), 100.0)[::2], cell=8.0)
    bare, whole = (trunk_levels(body, [0.0], arms=asked)[0] for asked in (False, True))
    assert whole.tape > bare.tape + 100.0
    assert whole.bridged_mm == 0.0


def _side(c: np.ndarray, out: float, high: float) -> np.ndarray:
    return (np.abs(c[:, 0]) > out) & (np.abs(c[:, 2] - BUST) < high)


HOLES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "on a bust point": lambda c: np.linalg.norm(c - TRUTH["landmarks"]["nipple_left"], axis=1) < 30.0,
    "in the back": lambda c: (np.abs(c[:, 0]) < 30.0) & (np.abs(c[:, 2] - BUST) < 60.0) & (c[:, 1] > -90.0),
    "in the side": lambda c: _side(c, 100.0, 70.0) & (c[:, 0] > 0.0),
    "under both armpits": lambda c: _side(c, 110.0, 60.0) & (np.abs(c[:, 1] + 125.0) < 45.0),
    "in front and back": lambda c: (np.abs(c[:, 0]) < 25.0) & (np.abs(c[:, 2] - BUST) < 25.0),
}


@pytest.mark.parametrize("where", HOLES)
def test_a_hole_does_not_lose_a_part_of_the_girth(where):
    level = trunk_levels(without(person(), HOLES[where]), [BUST])[0]
    assert level.bridged_mm > 40.0
    assert level.tape == pytest.approx(tape(person(), BUST), abs=5.0)


def test_a_whole_outline_is_not_bridged():
    levels = trunk_levels(person(), [WAIST, UNDER, BUST])
    assert [level.bridged_mm for level in levels] == [0.0, 0.0, 0.0]
    assert all(np.allclose(level.points[:, 2], level.z) for level in levels)


def test_half_a_body_is_not_made_whole():
    level = trunk_levels(without(person(), lambda c: c[:, 1] > -110.0), [UNDER])[0]
    assert level.longest_straight > 200.0


def test_legs_are_no_trunk_apart_or_touching():
    x, y, z = column().vertices.T
    waisted = column().moved(
        np.stack([x, np.where(z < 0.0, y * (0.15 + 0.85 * (x / 140.0) ** 2), y), z], axis=1)
    )
    assert tape(waisted, 100.0) == pytest.approx(ROUND, rel=2e-3)
    assert tape(waisted, -100.0) == 0.0
    legs = [((sign * 80.0, 0.0, -300.0), (sign * 80.0, 0.0, -900.0), 60.0) for sign in (1.0, -1.0)]
    walking = apart(column(), legs)
    assert tape(walking, -600.0) == 0.0
    assert scan_torso(walking).tape[:80].max() == 0.0


def test_above_the_armpits_the_trunk_is_no_wider_than_below_them():
    mesh = person()
    widths = [np.ptp(level.points[:, 0]) for level in trunk_levels(mesh, BUST + np.arange(60.0, 160.0, 10.0))]
    shoulders = [np.ptp(level.points[:, 0]) for level in trunk_levels(mesh, [BUST + 120.0], arms=True)]
    assert max(widths) < widths[0] + 60.0
    assert shoulders[0] > max(widths) + 60.0
