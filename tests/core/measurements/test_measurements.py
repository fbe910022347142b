"""Measures: volumes and rings by hand, the samples' girths, what is missing, before and after."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from types import MappingProxyType

import numpy as np
import pytest
import trimesh
from shapes import SAMPLES

from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.geometry.mesh import Mesh
from core.geometry.plane_sections import arc_length
from core.landmarks.bust_point import ACROSS
from core.landmarks.detect import find_landmarks
from core.landmarks.lower_breast import MIRRORED
from core.landmarks.torso.cross_sections import Level, trunk_levels
from core.landmarks.torso.girths import UNDER, girth_at, girths
from core.landmarks.types import Landmarks
from core.measurements.definitions import DEFINITIONS, KEYS, LOWER_KEYS, Measure, definition_of
from core.measurements.girths import enclosed, skin_ring, tape_ring
from core.measurements.table import before_after, measure_rows, measures
from core.measurements.tracked_points import moved_landmarks, smoothed_moves, track_points
from core.pipeline.build import build
from core.pipeline.observables import Tapes
from core.pipeline.solve import Solution, solve
from core.scan.body import read_scan


@cache
def scanned(name: str) -> tuple[Mesh, Landmarks]:
    """The calm skin of a sample body and its landmarks."""
    body = read_scan(SAMPLES / f"{name}.ply")
    return body.smoothed, find_landmarks(body)


@cache
def measured(name: str) -> MappingProxyType[str, Measure]:
    """The measures of a sample body."""
    return MappingProxyType(measures(*scanned(name)))


def length(curve: np.ndarray) -> float:
    return float(arc_length(curve)[-1])


def test_rings_of_a_square_with_a_notch() -> None:
    corners = np.array([[0, 0], [40, 0], [40, 40], [20, 20], [0, 40]], dtype=float)
    ring = np.column_stack([corners, np.full(5, 7.0)])
    segments = np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)
    level = Level(7.0, segments[[3, 0, 4, 2]][:, ::-1], segments[[1]])
    assert length(tape_ring(level)) == pytest.approx(160.0)
    assert length(skin_ring(level)) == pytest.approx(120.0 + 2.0 * np.hypot(20.0, 20.0))
    assert enclosed(skin_ring(level)) == pytest.approx(1200.0)
    assert len(skin_ring(Level(0.0, np.empty((0, 2, 3))))) == 0


def test_a_ring_goes_straight_over_what_is_missing() -> None:
    tube = trimesh.creation.cylinder(100.0, 400.0, sections=360)
    whole = Mesh(np.asarray(tube.vertices), np.asarray(tube.faces))
    level = trunk_levels(whole, [10.0])[0]
    assert enclosed(skin_ring(level)) == pytest.approx(np.pi * 100.0**2, rel=1e-3)
    torn = Level(10.0, level.segments[level.segments[:, :, 0].max(axis=1) < 90.0])
    ring = skin_ring(torn)
    assert np.array_equal(ring[0], ring[-1])
    assert length(ring) < level.skin


def test_landmarks_ride_on_the_skin() -> None:
    skin, found = scanned("mannequin")
    places = np.array([mark.position for mark in found.points.values()])
    bound = track_points(skin, places)
    still = moved_landmarks(found, bound.moved(np.zeros_like(skin.vertices)))
    for name, mark in found.points.items():
        assert np.array_equal(mark.position, still.position(name))
    assert (still.bust_level, still.underbust_level) == (found.bust_level, found.underbust_level)
    up = moved_landmarks(found, bound.moved(np.full_like(skin.vertices, 5.0)))
    assert up.bust_level == pytest.approx(found.bust_level + 5.0)
    assert up.underbust_level == pytest.approx(found.underbust_level + 5.0)


def test_a_rider_keeps_its_place_on_its_triangle() -> None:
    mesh = Mesh(np.array([[0, 0, 0], [10, 0, 0], [0, 10, 0]], dtype=float), np.array([[0, 1, 2]]))
    rider = track_points(mesh, np.array([[2.0, 3.0, 1.0]]))
    assert rider.shares == pytest.approx(np.array([[0.5, 0.2, 0.3]]))
    assert rider.moved(np.array([[0, 0, 0], [0, 0, 5], [0, 0, 10]], dtype=float)) == pytest.approx(
        np.array([[2.0, 3.0, 5.0]])
    )


@pytest.fixture(scope="module")
def person() -> tuple[Mesh, Landmarks]:
    return scanned("person")


def test_every_measure_is_there_with_its_curves() -> None:
    found = measured("person")
    bust = [key for key in KEYS if key not in LOWER_KEYS and key != "apex_lift"]
    missed = [key for key in bust if key not in found]
    assert not missed, "a definition needs its value, yielded by core/measurements/girths.py or bust.py"
    assert list(found) == bust
    for key, measure in found.items():
        assert measure.unit == definition_of(key)[0].unit
        assert (measure.value is None) == bool(not measure.curves), key
        assert measure.value is not None or str(measure.note).endswith(".")
    for name in ("bust", "underbust", "high_bust"):
        tape, skin = found[f"{name}_girth"], found[f"{name}_girth_skin"]
        assert length(tape.curves[0]) == pytest.approx(tape.value)
        assert length(skin.curves[0]) == pytest.approx(skin.value, rel=1e-4)
    for key in ("bust_point_to_fold_left", "root_length_right", "bust_point_distance"):
        assert length(found[key].curves[0]) == pytest.approx(found[key].value)


def test_girths_are_those_that_are_detected() -> None:
    body = read_scan(SAMPLES / "mannequin.ply")
    found = measured("mannequin")
    for name, girth in girths(body, scanned("mannequin")[1]).items():
        assert found[f"{name}_girth"].value == girth.tape_mm
        assert found[f"{name}_girth_skin"].value == girth.skin_mm


def test_what_the_scan_does_not_show_is_missing_with_the_reason(person: tuple[Mesh, Landmarks]) -> None:
    found = measured("person")
    assert found["waist_girth"].value is None
    assert "No waist detected" in str(found["waist_girth"].note)
    mesh, landmarks = person
    points = {name: mark for name, mark in landmarks.points.items() if not name.endswith("outer_left")}
    one = measures(mesh, replace(landmarks, points=MappingProxyType(points)))
    for key in ("cup_width_left", "root_length_left", "breast_volume_left"):
        assert one[key].value is None, key
        assert str(one[key].note).endswith(".")
    assert one["bust_protrusion"].value is None
    assert one["breast_volume_right"].value == found["breast_volume_right"].value


def test_a_side_without_a_breast_is_not_measured(person: tuple[Mesh, Landmarks]) -> None:
    mesh, landmarks = person
    flat = {"bust_point_right": replace(landmarks.points["bust_point_right"], rule=ACROSS)}
    found = measures(mesh, replace(landmarks, points=MappingProxyType({**landmarks.points, **flat})))
    for key in ("cup_depth", "cup_width", "root_length", "bust_point_to_fold", "breast_volume"):
        assert found[f"{key}_right"].value is None, key
        assert "No breast" in str(found[f"{key}_right"].note)
        assert found[f"{key}_left"].value is not None, key
    assert found["asymmetry_height"].value is None
    assert found["asymmetry_volume"].value is None


def test_no_volume_is_made_of_a_fold_that_a_hole_hides(person: tuple[Mesh, Landmarks]) -> None:
    mesh, landmarks = person
    hidden = {"fold_left": replace(landmarks.points["fold_left"], rule=MIRRORED, confidence=0.3)}
    found = measures(mesh, replace(landmarks, points=MappingProxyType({**landmarks.points, **hidden})))
    assert found["breast_volume_left"].value is None
    assert found["root_length_left"].note == found["breast_volume_left"].note
    assert "fold" in str(found["root_length_left"].note)
    assert found["bust_point_to_fold_left"].estimate
    assert found["bust_point_to_fold_left"].note == MIRRORED
    assert found["cup_width_left"].value is not None
    unsure = {"fold_left": replace(landmarks.points["fold_left"], confidence=0.3)}
    found = measures(mesh, replace(landmarks, points=MappingProxyType({**landmarks.points, **unsure})))
    assert "uncertain" in str(found["breast_volume_left"].note)
    sure = measured("person")
    for key in ("root_length_left", "bust_point_to_fold_left", "bust_height"):
        assert found[key].estimate, key
        assert "uncertain" in str(found[key].note)
        assert not sure[key].estimate, key
    assert not found["root_length_right"].estimate
    unsure |= {
        name: replace(landmarks.points[name], confidence=0.3) for name in UNDER if name in landmarks.points
    }
    found = measures(mesh, replace(landmarks, points=MappingProxyType({**landmarks.points, **unsure})))
    assert found["underbust_girth"].estimate
    assert not sure["underbust_girth"].estimate


def test_a_hole_at_a_level_makes_an_estimate(person: tuple[Mesh, Landmarks]) -> None:
    mesh, landmarks = person
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    torn = (
        (np.abs(middle[:, 2] - landmarks.bust_level) < 25.0) & (middle[:, 0] > 100.0) & (middle[:, 1] > -150)
    )
    found = measures(Mesh(mesh.vertices, mesh.faces[~torn]), landmarks)
    whole = measured("person")
    assert found["bust_girth"].estimate
    assert not whole["bust_girth"].estimate
    assert "hole" in str(found["bust_girth"].note)
    assert found["bust_girth"].value == pytest.approx(whole["bust_girth"].value, rel=0.02)
    assert not found["underbust_girth"].estimate


def test_even_breasts_measure_alike_and_volumes_tell_how_unsure_they_are() -> None:
    found = measured("mannequin")
    left, right = (found[f"breast_volume_{side}"] for side in ("left", "right"))
    assert left.value == pytest.approx(right.value, rel=0.01)
    assert left.estimate
    assert 0.1 * left.value < left.plus_minus < 0.3 * left.value
    assert found["asymmetry_volume"].value is None
    assert "control mesh" in str(found["asymmetry_volume"].note)
    for name in ("cup_depth", "cup_width", "root_length", "bust_point_to_fold"):
        pair = [found[f"{name}_{side}"].value for side in ("left", "right")]
        assert pair[0] == pytest.approx(pair[1], rel=0.01)


def test_own_measures_of_each_kind(person: tuple[Mesh, Landmarks]) -> None:
    own = (
        CustomMeasurement("Span", "straight", ("bust_point_left", "bust_point_right")),
        CustomMeasurement("Fall", "skin", ("bust_point_left", "fold_left")),
        CustomMeasurement("Ribs", "girth", ("fold_left",), -30.0),
        CustomMeasurement("Up", "girth", (), 200.0),
        CustomMeasurement("Low", "girth", (), -5000.0 + 2100.0),
        CustomMeasurement("Neck", "skin", ("neck_front", "bust_point_left")),
    )
    mesh, landmarks = person
    found = measures(mesh, landmarks, own)
    assert list(found)[-6:] == [f"own:{each.name}" for each in own]
    assert found["own:Span"].value == found["bust_point_distance"].value
    assert found["own:Fall"].value == found["bust_point_to_fold_left"].value
    height = float(landmarks.position("fold_left")[2]) - 30.0
    assert found["own:Ribs"].value == girth_at(mesh, height).tape_mm
    assert found["own:Up"].value == girth_at(mesh, float(mesh.vertices[:, 2].min()) + 200.0).tape_mm
    assert found["own:Low"].value is None
    assert found["own:Neck"].value is None
    assert found["own:Low"].note != found["own:Neck"].note


@pytest.fixture(scope="module")
def worn() -> Solution:
    scan = ScanSource(str(SAMPLES / "mannequin.ply"))
    own = CustomMeasurement("Span", "straight", ("bust_point_left", "bust_point_right"))
    design = Design(scan, volume="exact").with_line("mid-bust", 0.95).with_custom_measurement(own)
    return solve(build(design))


def test_before_and_after_agree_with_what_is_followed_live(worn: Solution) -> None:
    stages, control = worn.stages, worn.control_points
    before, after = before_after(stages, control)
    then, now = stages.rest_marks, stages.watch(control)
    assert "apex_lift" not in before
    assert after["apex_lift"].value == pytest.approx(now.apex_z - then.apex_z, abs=0.05)
    moved = after["bust_protrusion"].value - before["bust_protrusion"].value
    assert moved == pytest.approx(now.apex_protrusion - then.apex_protrusion, abs=0.2)
    for side, gained in zip(("left", "right"), stages.body_change(control) / 1000.0, strict=True):
        key = f"breast_volume_{side}"
        assert after[key].value - before[key].value == pytest.approx(gained)
    level = 0.5 * (now.bust_point_left_z + now.bust_point_right_z)
    tape = Tapes(stages.moving, [level])(stages.shape(control)[0])
    assert after["bust_girth"].value == pytest.approx(float(tape[0]), abs=0.1)
    assert after["bust_girth"].value < before["bust_girth"].value - 2.0
    assert after["own:Span"].value == after["bust_point_distance"].value


def test_at_rest_after_is_before_to_the_bit(worn: Solution) -> None:
    before, after = before_after(worn.stages, worn.stages.control.mesh.vertices)
    assert {key: each.value for key, each in before.items()} == {
        key: each.value for key, each in after.items() if key != "apex_lift"
    }
    assert after["apex_lift"].value == 0.0
    with pytest.raises(ValueError, match="control points of shape"):
        before_after(worn.stages, worn.stages.control.mesh.vertices[:-1])


def test_a_thinner_calm_skin_moves_as_the_scan_does(worn: Solution) -> None:
    body = worn.stages.body
    moves = body.mesh.vertices * 0.01
    assert smoothed_moves(body, moves) is moves
    thin = replace(body)
    rows = np.arange(0, len(body.mesh.vertices), 3)
    thin.__dict__["smoothed"] = Mesh(body.mesh.vertices[rows], np.array([[0, 1, 2]]))
    assert np.array_equal(smoothed_moves(thin, moves), moves[rows])


def test_rows_tell_all_of_it(worn: Solution) -> None:
    rows = {row["key"]: row for row in measure_rows(*before_after(worn.stages, worn.control_points))}
    bust = rows["bust_girth"]
    assert bust["difference"] == bust["after"] - bust["before"]
    assert bust["iso"] == "Bust girth"
    assert bust["definition"] == DEFINITIONS["bust_girth"].text
    assert rows["apex_lift"]["before"] is None
    assert rows["apex_lift"]["difference"] is None
    assert rows["hip_girth"]["before"] is None
    assert rows["hip_girth"]["note"]
    assert rows["breast_volume_left"]["side"] == "left"
    assert rows["breast_volume_left"]["estimate"]
    assert rows["own:Span"]["title"] == "Span"


def test_definitions_stand_on_their_own() -> None:
    for each in DEFINITIONS.values():
        assert str(each.text).endswith(".")
        assert each.unit in ("mm", "cm2", "ml", "")
        plain = each.key in ("bust_point_distance", "bust_point_to_fold", "waist_hip_ratio")
        assert bool(each.iso) != str(each.text).startswith("Defined by Busk") or plain
    with pytest.raises(KeyError):
        definition_of("own:Span")
