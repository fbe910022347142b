"""Measures of waist, hips and seat: by hand, on the sample of a whole trunk, before and after."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from whole_trunk import trunk_stages, wearing

from core.document.custom_measures import CustomMeasurement
from core.geometry.mesh import Mesh
from core.geometry.plane_sections import arc_length
from core.landmarks.torso.girths import girth_at
from core.measurements.definitions import KEYS, LOWER_KEYS, definition_of
from core.measurements.figure import figure_girths
from core.measurements.lower_measures import midline_curve
from core.measurements.table import Measures, before_after, custom_before_after, measures
from core.pipeline.frame import make_frame
from core.pipeline.region_solvers import RegionSolvers
from core.pipeline.solve import Solution, solve

SLINGS = {"waist": 0.93, "sling-left": 0.92, "sling-right": 0.92}


@pytest.fixture(scope="module")
def worn() -> Solution:
    return solve(wearing(SLINGS))


@pytest.fixture(scope="module")
def both(worn: Solution) -> tuple[Measures, Measures]:
    return before_after(worn.stages, *worn.region_points)


def test_the_midline_of_a_tube_runs_down_round_and_up() -> None:
    tube = trimesh.creation.capsule(height=300.0, radius=80.0, count=[64, 65])
    skin = Mesh(np.asarray(tube.vertices), np.asarray(tube.faces))
    crotch, middle = np.array([0.0, 0.0, -230.0]), np.array([0.0, 0.0, 100.0])
    for mesh in (skin, open_above(skin, 200.0)):
        curve = midline_curve(mesh, crotch, middle)
        assert curve is not None
        assert float(arc_length(curve)[-1]) == pytest.approx(500.0 + 80.0 * np.pi, rel=2e-3)
        assert curve[[0, -1], 2] == pytest.approx([100.0, 100.0])
        assert curve[0, 1] < 0.0 < curve[-1, 1]  # from the front to the back
    assert midline_curve(open_above(skin, 90.0), crotch, middle) is None
    assert midline_curve(skin, crotch - [0.0, 0.0, 20.0], middle) is None


def open_above(mesh: Mesh, z: float) -> Mesh:
    return Mesh(mesh.vertices, mesh.faces[(mesh.vertices[mesh.faces][:, :, 2] < z).all(axis=1)])


def test_every_measure_is_there_with_unit_and_curves(both: tuple[Measures, Measures]) -> None:
    for found in both:
        assert set(found) == set(KEYS) - ({"apex_lift"} if found is both[0] else set())
        assert list(found) == [key for key in KEYS if key in found]
        for key in LOWER_KEYS:
            measure = found[key]
            assert measure.value is not None, key
            assert measure.unit == definition_of(key)[0].unit
            assert measure.curves
            assert 0.0 < measure.confidence <= 1.0
    before = both[0]
    for key in ("waist_girth", "belly_girth", "hip_girth_skin", "thigh_girth_left", "crotch_length"):
        assert float(arc_length(before[key].curves[0])[-1]) == pytest.approx(before[key].value, rel=1e-6)


def test_girths_are_those_of_another_tape_at_their_heights(both: tuple[Measures, Measures]) -> None:
    mesh = trunk_stages().body.smoothed
    for key in ("waist_girth", "belly_girth", "high_hip_girth", "hip_girth", "buttock_girth"):
        curve = both[0][key].curves[0]
        assert both[0][key].value == pytest.approx(girth_at(mesh, curve[0, 2]).tape_mm, rel=5e-4)
        assert both[1][key].curves[0][0, 2] == curve[0, 2], "before and after are taken at one height"
    value = {key: measure.value for key, measure in both[0].items()}
    assert value["waist_hip_ratio"] == pytest.approx(value["waist_girth"] / value["hip_girth"])
    assert value["hip_girth"] >= max(value["buttock_girth"], value["high_hip_girth"], value["belly_girth"])
    heights = [both[0][key].curves[0][0, 2] for key in ("waist_girth", "hip_girth")]
    assert value["waist_to_hip"] == pytest.approx(heights[0] - heights[1])


def test_without_lengths_nothing_changes() -> None:
    stages = trunk_stages()
    before, after = before_after(stages, *(each.control.mesh.vertices for each in stages.regions))
    assert {key: each.value for key, each in before.items()} == {
        key: each.value for key, each in after.items() if key != "apex_lift"
    }


def test_a_waistband_and_slings_change_what_they_are_worn_for(both: tuple[Measures, Measures]) -> None:
    change = {key: both[1][key].value - both[0][key].value for key in LOWER_KEYS | {"waist_girth"}}
    assert change["waist_girth"] < -20.0
    assert change["waist_hip_ratio"] < -0.02
    for side in ("left", "right"):
        assert change[f"gluteal_fold_height_{side}"] > 2.0
        assert abs(change[f"seat_volume_{side}"]) < 0.02 * both[0][f"seat_volume_{side}"].value
        assert abs(change[f"thigh_girth_{side}"]) < 3.0
    left, right = (both[0][f"seat_volume_{side}"].value for side in ("left", "right"))
    assert left == pytest.approx(right, rel=0.03)
    assert 1000.0 < left < 6000.0


def test_one_girth_wherever_it_is_shown(worn: Solution) -> None:
    solvers = RegionSolvers(worn.stages)
    while not solvers.is_finished:
        solvers.advance()
    frame = make_frame(1, worn.stages, solvers)
    table = before_after(frame.stages, *frame.region_points)
    for name, pair in figure_girths(frame).items():
        assert tuple(each[f"{name}_girth"].value for each in table) == pair


def test_custom_girths_see_both_regions(worn: Solution) -> None:
    waist = worn.stages.lower.landmarks.levels["waist"]
    ground = float(worn.stages.body.smoothed.vertices[:, 2].min())
    own = CustomMeasurement("Belt", "girth", (), waist - ground)
    before, after = custom_before_after(worn.stages, worn.region_points, own)
    assert after.value < before.value - 20.0


def test_an_uncertain_landmark_makes_an_estimate_with_its_rule() -> None:
    stages = trunk_stages()
    landmarks = stages.lower.landmarks
    doubtful = replace(landmarks.points["waist"], confidence=0.3)
    lower = replace(
        stages.lower, landmarks=replace(landmarks, points={**landmarks.points, "waist": doubtful})
    )
    found, _ = before_after(replace(stages, below=lower), stages.control.mesh.vertices)
    for key in ("waist_girth", "waist_hip_ratio", "crotch_length"):
        assert (found[key].estimate, found[key].note) == (True, doubtful.rule)
    assert not found["hip_girth"].estimate


def test_a_scan_alone_has_the_measures_of_the_bust() -> None:
    stages = trunk_stages()
    assert not LOWER_KEYS & set(measures(stages.body.smoothed, stages.landmarks))
    without = replace(stages, below=None)
    assert not LOWER_KEYS & set(before_after(without, stages.control.mesh.vertices)[0])
