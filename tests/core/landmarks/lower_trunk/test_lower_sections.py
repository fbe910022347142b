"""Sections of the lower trunk: two cylinders as legs, a whole trunk with a known crotch, an arm beside it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from core.geometry.mesh import Mesh
from core.geometry.plane_sections import hull_perimeter
from core.landmarks.lower_trunk.sections import LowerSections, lower_sections
from core.scan.body import read_scan

ROOT = Path(__file__).parents[4]
TRUTH = json.loads((ROOT / "tests/data/lower_truth.json").read_text())["trunk"]


def tube(x: float, radius: float, low: float, high: float) -> Mesh:
    made = trimesh.creation.cylinder(radius, high - low, sections=48)
    return Mesh(made.vertices + np.array([x, 0.0, 0.5 * (low + high)]), made.faces)


def together(*parts: Mesh) -> Mesh:
    first = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = [part.faces + begin for part, begin in zip(parts, first, strict=False)]
    return Mesh(np.concatenate([part.vertices for part in parts]), np.concatenate(faces))


@pytest.fixture(scope="module")
def doll() -> LowerSections:
    """Return a trunk on two legs, with an arm on the left: all of them cylinders."""
    parts = tube(0.0, 150.0, 0.0, 400.0), tube(70.0, 60.0, -300.0, 0.0), tube(-70.0, 60.0, -300.0, 0.0)
    return lower_sections(together(*parts, tube(210.0, 40.0, -150.0, 399.0)), 380.0)


@pytest.fixture(scope="module")
def trunk() -> LowerSections:
    body = read_scan(ROOT / "resources/samples/trunk.ply", unit="mm", up="+z", front="-y")
    return lower_sections(body.mesh, 260.0)


def area(outline: np.ndarray) -> float:
    x, y = outline[:, :2].T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def test_the_trunk_is_its_circle_without_the_arm(doll: LowerSections) -> None:
    section = doll.at(200.0)
    assert section.legs == (None, None)
    assert section.trunk is not None
    assert hull_perimeter(section.trunk) == pytest.approx(96 * 150.0 * np.sin(np.pi / 48), rel=1e-9)
    assert area(section.trunk) > 0.0
    assert doll.middle == pytest.approx(0.0, abs=1e-9)


def test_legs_are_left_and_right_and_the_arm_is_none(doll: LowerSections) -> None:
    section = doll.at(-100.0)
    left, right = section.legs
    assert section.trunk is None
    assert left is not None
    assert right is not None
    assert (left[:, 0].min(), left[:, 0].max()) == pytest.approx((10.0, 130.0), abs=1e-9)
    assert (right[:, 0].min(), right[:, 0].max()) == pytest.approx((-130.0, -10.0), abs=1e-9)
    assert min(area(left), area(right)) > 0.0


def test_the_crotch_is_where_the_trunk_begins(doll: LowerSections) -> None:
    assert doll.search == "found"
    assert doll.crotch == pytest.approx(0.0, abs=0.1)


def test_a_level_along_edges_is_shifted(doll: LowerSections) -> None:
    section = doll.at(0.0)
    assert section.z == 0.0
    assert section.trunk is not None
    assert section.trunk[0, 2] == 0.0
    assert doll.at(0.0) is section


def test_many_levels_come_in_the_order_asked(doll: LowerSections) -> None:
    assert [section.z for section in doll.many([120.5, 20.5, 120.5])] == [120.5, 20.5, 120.5]


def test_off_the_scan_there_is_nothing(doll: LowerSections) -> None:
    section = doll.at(-900.0)
    assert section.trunk is None
    assert section.legs == (None, None)


def test_a_scan_that_ends_above_the_crotch_says_so() -> None:
    found = lower_sections(tube(0.0, 150.0, 0.0, 400.0), 380.0)
    assert (found.crotch, found.search) == (None, "ends")


def test_the_crotch_of_a_body(trunk: LowerSections) -> None:
    assert trunk.crotch == pytest.approx(TRUTH["levels"]["crotch"], abs=1.0)


def test_tapes_of_a_body(trunk: LowerSections) -> None:
    levels, tapes = TRUTH["levels"], TRUTH["tape_mm"]
    section = trunk.at(levels["hip_largest"])
    assert section.trunk is not None
    assert hull_perimeter(section.trunk) == pytest.approx(tapes["hip_largest"], rel=0.002)
    for name, down in (("thigh_crotch", 15.0),):
        legs = trunk.at(levels["crotch"] - down).legs
        for side, leg in zip(("left", "right"), legs, strict=True):
            assert leg is not None
            assert hull_perimeter(leg) == pytest.approx(tapes[f"{name}_{side}"], rel=0.003)


def test_a_hole_is_bridged(trunk: LowerSections) -> None:
    centres = trunk.mesh.vertices[trunk.mesh.faces].mean(axis=1)
    hole = np.linalg.norm(centres - TRUTH["landmarks"]["belly_front"], axis=1) < 15.0
    torn = lower_sections(Mesh(trunk.mesh.vertices, trunk.mesh.faces[~hole]), 260.0)
    section, whole = (each.at(TRUTH["levels"]["belly"]) for each in (torn, trunk))
    assert hole.any()
    assert section.trunk is not None
    assert whole.trunk is not None
    assert 20.0 < section.bridged < 40.0
    assert whole.bridged == pytest.approx(0.0, abs=1e-6)
    assert area(section.trunk) == pytest.approx(area(whole.trunk), rel=0.002)


def loft(outline: np.ndarray, heights: list[float]) -> Mesh:
    """Return a tube of one closed outline, shape (k, 2) [mm], between two heights, open at both ends."""
    count, rings = len(outline), []
    for z in heights:
        rings.append(np.column_stack([outline, np.full(count, z)]))
    here, after = np.arange(count), np.roll(np.arange(count), -1)
    faces = np.concatenate(
        [np.column_stack([here, after, after + count]), np.column_stack([here, after + count, here + count])]
    )
    return Mesh(np.concatenate(rings), faces)


def test_thighs_that_touch_all_the_way_say_so() -> None:
    turn = 2.0 * np.pi * np.arange(96) / 96
    joined = 80.0 * np.stack([2.0 * np.cos(turn), np.sin(turn) * (0.1 + 0.9 * np.abs(np.cos(turn)))], axis=1)
    parts = loft(joined, [-300.0, 0.0]), tube(0.0, 150.0, 1.0, 400.0)
    found = lower_sections(together(*parts), 380.0)
    assert (found.crotch, found.search) == (None, "touch")
