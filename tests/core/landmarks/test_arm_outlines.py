"""Outlines drawn by hand, as columns: what is an arm, and how the skin goes on where one was cut off."""

from __future__ import annotations

import numpy as np
import pytest
from posed_bodies import apart

from core.geometry.level_outlines import BEARINGS, BINS
from core.geometry.mesh import Mesh
from core.geometry.plane_sections import resample
from core.landmarks.torso.arm_removal import necks
from core.landmarks.torso.cross_sections import trunk_levels
from core.landmarks.torso.gap_filling import bridge
from core.landmarks.torso_landmarks import torso_landmarks
from core.landmarks.types import SIDES, Landmark, Landmarks
from core.messages import EMPTY

TRUNK = 280.0, 140.0
"""Width and depth of the trunk [mm]."""

BUSTS = tuple(zip(SIDES, (60.0, -60.0), strict=True))


def outline(neck: float, lobe: tuple[float, float]) -> np.ndarray:
    """A box of a trunk with a box (width, depth) joined to its left by a neck 6 mm long, from above."""
    (x, y), (wide, deep) = (TRUNK[0] / 2, TRUNK[1] / 2), (lobe[0], lobe[1] / 2)
    half = [(0, -y), (x, -y), (x, -neck / 2), (x + 6, -neck / 2), (x + 6, -deep), (x + 6 + wide, -deep)]
    corners = np.array([*half, *[(a, -b) for a, b in half[::-1]], (-x, y), (-x, -y), (0, -y)], dtype=float)
    return resample(corners, 3.0)


def column(ring: np.ndarray, low: float = -160.0, high: float = 160.0) -> Mesh:
    """An upright column over a closed ring."""
    at, count = ring[:-1], len(ring) - 1
    z = np.arange(low, high + 1.0, 20.0)
    points = np.column_stack([np.tile(at, (len(z), 1)), np.repeat(z, count)])
    corner = np.arange((len(z) - 1) * count).reshape(-1, count)
    after = np.roll(corner, -1, axis=1)
    faces = [[corner, after, after + count], [corner, after + count, corner + count]]
    return Mesh(points, np.concatenate([np.stack(side, axis=-1).reshape(-1, 3) for side in faces]))


@pytest.mark.parametrize(
    ("neck", "lobe", "is_arm"),
    [
        (60.0, (80.0, 90.0), True),
        (60.0, (220.0, 125.0), False),
        (100.0, (40.0, 130.0), True),
        (116.0, (40.0, 130.0), False),
    ],
    ids=["an arm", "as large as the trunk", "a broad neck", "a neck as deep as the trunk"],
)
def test_an_arm_is_less_than_the_trunk_and_its_neck_less_deep(neck, lobe, is_arm):
    left, right = necks(outline(neck, lobe), np.zeros(2))
    assert right is None
    assert (left is not None) == is_arm


def test_an_arm_between_shallow_hollows_is_cut_off():
    """A tape on this outline bridges only a fifteenth of its length."""
    level = trunk_levels(column(outline(80.0, (40.0, 90.0))), [1.0])[0]
    assert level.tape == pytest.approx(2.0 * sum(TRUNK), rel=5e-3)
    assert level.bridged_mm > 60.0


@pytest.mark.parametrize(("high", "is_arm"), [(200.0, True), (40.0, False)])
def test_what_stands_upright_before_the_trunk_is_an_arm_unless_it_is_low(high, is_arm):
    """The lower lip of an overhanging breast is a piece of outline of its own too: a tape goes round it."""
    limb = ((70.0, -120.0, -high / 2), (70.0, -120.0, high / 2), 24.0)
    bare = column(outline(60.0, (0.0, 60.0)))
    tape = trunk_levels(apart(bare, [limb]), [0.0])[0].tape
    assert (tape == pytest.approx(2.0 * sum(TRUNK), rel=5e-3)) == is_arm


@pytest.mark.parametrize("half", [10, 16])
def test_the_side_that_an_arm_hid_bulges_a_little(half):
    """On a circle as round as the side of a trunk: most of the way from the chord to it, never beyond."""
    skin = np.abs(np.arange(BINS) - BINS // 4) > half
    whole = bridge(np.where(skin, 75.0, np.nan), skin, np.full(BINS, np.nan), True)
    assert (whole[skin] == 75.0).all()
    turn = BEARINGS[~skin]
    chord = 75.0 * np.cos((half + 1) * 2.0 * np.pi / BINS) / np.cos(turn - turn.mean())
    share = (whole[~skin] - chord) / (75.0 - chord)
    assert share[half] > 0.6
    assert (share > 0.0).all()
    assert whole.max() < 76.0


def joined(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def armpit(body: Mesh, bust: float) -> Landmark:
    """The left armpit of a body whose bust points and folds are told."""
    points = [Landmark(f"bust_point_{side}", np.array([x, -70.0, bust]), 1.0, EMPTY) for side, x in BUSTS]
    return next(
        mark
        for mark in torso_landmarks(body, Landmarks({mark.name: mark for mark in points}, bust, bust - 30.0))
        if mark.name == "armpit_left"
    )


def test_an_armpit_is_surest_under_an_arm_that_hangs_free_and_least_sure_below_the_bust():
    """An arm is joined from 60 mm up; below that level it hangs beside the trunk, or there is none."""
    shoulders = column(outline(60.0, (80.0, 90.0)), 60.0, 160.0)
    trunk = column(outline(60.0, (0.0, 60.0)), -80.0, 60.0)
    square = np.array([(160, -45), (240, -45), (240, 45), (160, 45), (160, -45)], dtype=float)
    arm = column(resample(square, 3.0), -80.0, 60.0)
    stump = armpit(joined(shoulders, trunk), 0.0)
    free = armpit(joined(shoulders, trunk, arm), 0.0)
    below = armpit(joined(shoulders, trunk), 80.0)
    for mark in (stump, free, below):
        assert mark.position[2] == pytest.approx(57.5, abs=6.0)
        assert mark.position[0] == pytest.approx(140.0, abs=8.0)
    assert free.confidence > 1.5 * stump.confidence > 2.0 * below.confidence > 0.0
