"""Edits of a scan: crop, mirror and fill act on the upright body, and are kept in the document."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree
from shapes import SAMPLES

from app.cli.commands.symmetry import compare
from app.presenters.symmetry import symmetry_view
from core.document.design import Design, ScanSource
from core.document.serialization import from_json, to_json
from core.errors import LandmarkError, UserError
from core.geometry.mesh import Mesh
from core.landmarks.detect import ESTIMATED, find_landmarks
from core.landmarks.types import CERTAIN
from core.landmarks.warnings import collect_warnings
from core.pipeline.build import IncompleteBuildError, build
from core.scan.body import read_scan
from core.scan.edited_body import apply_edits, is_estimated, mirror_sentence
from core.scan.orientation.symmetry_planes import middle_of, sample_uniformly
from core.scan.repair.clipping import clip_above, mirrored_half
from core.scan.repair.holes import fill_large_holes, find_holes
from core.scan.source import ScanEdits
from tests.core.scan.test_hole_filling import is_sound, pierced


@pytest.fixture(scope="module")
def person():
    return read_scan(SAMPLES / "person.ply")


def ball():
    shape = trimesh.creation.icosphere(subdivisions=5, radius=80.0)
    return Mesh(shape.vertices, shape.faces)


@pytest.mark.parametrize("level", [0.0, 13.7, -41.0])
def test_a_ball_is_cut_to_the_cap_above_a_plane(level):
    cap, cut = clip_above(ball(), 2, level)
    assert is_sound(cap)
    assert cap.vertices[:, 2].min() == level
    assert len(cap.boundary_loops) == 1
    assert set(cap.boundary_loops[0].tolist()) == set(np.flatnonzero(cut).tolist())
    assert cap.face_areas.sum() == pytest.approx(2.0 * np.pi * 80.0 * (80.0 - level), rel=2e-3)


def test_half_a_ball_is_mirrored_without_a_seam():
    whole = mirrored_half(ball(), 30.0, -1.0)
    assert is_sound(whole)
    assert whole.boundary_loops == ()
    mirrored = whole.vertices * (-1.0, 1.0, 1.0) + (60.0, 0.0, 0.0)
    assert cKDTree(whole.vertices).query(mirrored)[0].max() < 1e-9
    cap = np.pi * 110.0**2 * (3.0 * 80.0 - 110.0) / 3.0
    assert whole.enclosed_volume() == pytest.approx(2.0 * cap, rel=3e-3)


def test_the_middle_is_found_with_one_side_bad(person):
    bad = (person.mesh.vertices[:, 0] > 60.0) & (np.abs(person.mesh.vertices[:, 2] - 260.0) < 80.0)
    spoilt = person.mesh.vertices + np.where(bad, 25.0, 0.0)[:, None] * (1.0, 0.3, 0.0)
    side = np.array([1.0, 0.0, 0.0])
    sound = middle_of(sample_uniformly(person.mesh.vertices, person.mesh.faces), side)
    assert sound == pytest.approx(0.0, abs=0.5)
    assert middle_of(sample_uniformly(spoilt, person.mesh.faces), side) == pytest.approx(sound, abs=2.0)


@pytest.mark.parametrize(("radius", "deep"), [(30.0, 1.0), (55.0, 5.0)])
def test_a_large_hole_in_a_ball_is_filled_onto_the_ball(radius, deep):
    place = 80.0 * np.array([0.6, -0.8, 0.0])
    holed = pierced(ball(), (place, radius))
    whole, new, unfilled = fill_large_holes(holed, find_holes(holed))
    assert unfilled == 0
    assert is_sound(whole)
    assert whole.boundary_loops == ()
    off = np.abs(np.linalg.norm(whole.vertices[new], axis=1) - 80.0)
    assert off.max() < deep  # a flat lid would be 6 and 22 mm deep
    sides = np.linalg.norm(np.diff(whole.vertices[whole.edges], axis=1), axis=2).ravel()
    assert sides.max() < 2.5 * np.median(sides)


def test_a_hole_that_crosses_itself_from_outside_is_filled_all_round():
    most = pierced(ball(), (np.array([0.0, 0.0, 80.0]), 40.0))
    bent = most.vertices.copy()
    border = find_holes(most)[0].border
    angle = np.arctan2(bent[border, 1], bent[border, 0])
    bent[border, :2] *= (1.0 + 0.9 * np.cos(5.0 * angle + bent[border, 2] / 9.0))[:, None]
    holed = Mesh(bent, most.faces)
    whole, new, unfilled = fill_large_holes(holed, find_holes(holed))
    assert unfilled == 0
    assert whole.boundary_loops == ()
    assert np.isfinite(whole.vertices).all()
    assert np.abs(whole.vertices[new]).max() < 120.0


def test_a_crop_is_no_hole_and_the_landmarks_stay(person):
    before = find_landmarks(person)
    cropped = apply_edits(person, ScanEdits(low=60.0, high=420.0))
    assert np.ptp(cropped.mesh.vertices[:, 2]) == pytest.approx(360.0)
    assert cropped.holes == ()
    assert cropped.heights == person.heights
    after = find_landmarks(cropped)
    for name in ("bust_point_left", "bust_point_right", "fold_left", "fold_right"):
        assert after.position(name) == pytest.approx(before.position(name), abs=0.5)


def test_a_mirrored_body_is_even_and_says_so_in_its_doubts(person):
    body = apply_edits(person, ScanEdits(kept="left"))
    marks = find_landmarks(body)
    left, right = marks.position("bust_point_left"), marks.position("bust_point_right")
    assert right[1:] == pytest.approx(left[1:], abs=0.5)
    assert mirror_sentence("left") in collect_warnings(body, marks)


def test_landmarks_on_a_filled_hole_are_no_surer_than_without_it(person):
    before = find_landmarks(person)
    place = before.position("bust_point_left")
    holed = replace(person, mesh=pierced(person.mesh, (place, 25.0)))
    centre = tuple(holed.holes[0].centre.tolist())
    body = apply_edits(holed, ScanEdits().with_filled(centre))
    assert body.holes == ()
    marks = find_landmarks(body)
    names = [name for name, mark in marks.points.items() if is_estimated(body, mark.position[None])[0]]
    assert "bust_point_left" in names
    assert before.points["bust_point_left"].confidence > CERTAIN
    assert all(marks.points[name].confidence <= ESTIMATED for name in names)
    assert marks.points["bust_point_right"].confidence > CERTAIN


def test_a_hole_is_known_again_by_its_centre_and_others_stay_open(person):
    holed = replace(
        person, mesh=pierced(person.mesh, ((0.0, 30.0, 260.0), 30.0), ((140.0, -80.0, 180.0), 40.0))
    )
    first, second = holed.holes
    body = apply_edits(holed, ScanEdits().with_filled(tuple((second.centre + 4.0).tolist())))
    assert [hole.length for hole in body.holes] == pytest.approx([first.length])
    assert apply_edits(holed, ScanEdits(fill_all=True)).holes == ()
    assert len(apply_edits(holed, ScanEdits().with_filled((0.0, 0.0, 900.0))).holes) == 2


@pytest.mark.parametrize(
    "wrong",
    [
        {"low": -1.0},
        {"low": float("nan")},
        {"low": 200.0, "high": 250.0},
        {"kept": "front"},
        {"filled": ((1.0, 2.0),)},
    ],
)
def test_what_is_no_edit_is_refused(wrong):
    with pytest.raises(UserError):
        ScanEdits(**wrong)


def test_far_too_long_a_unit_or_axis_is_refused_with_what_to_specify():
    for wrong in ("unit", "up", "front"):
        with pytest.raises(UserError) as refused:
            ScanSource("a.ply", **{wrong: "z" * 1000})
        assert all(word in str(refused.value.hint) for word in ("unit", "axes"))


def test_edits_are_read_again_and_designs_without_them_are_written_as_before():
    plain = Design(ScanSource("a.ply"))
    assert "edits" not in to_json(plain)
    edits = ScanEdits(20.0, 400.0, "right", ((1.0, -2.5, 3.0),))
    design = replace(plain, scan=replace(plain.scan, edits=edits))
    assert from_json(to_json(design)) == design
    assert json.loads(to_json(design))["format"] == 5
    assert design.scan.set_up(unit="cm").edits == ScanEdits()
    assert design.scan.set_up(unit=None) == design.scan


def test_a_crop_without_a_bust_is_refused_and_the_last_build_is_reused(person):
    source = ScanSource(str(SAMPLES / "person.ply"))
    stages = build(Design(source))
    with pytest.raises(IncompleteBuildError, match="No bust detected on the edited scan"):
        build(Design(replace(source, edits=ScanEdits(low=300.0))), stages)
    cropped = build(Design(replace(source, edits=ScanEdits(low=40.0))), stages)
    assert cropped.scan is stages.scan
    assert build(Design(source), cropped).body.mesh.faces.shape == stages.body.mesh.faces.shape
    with pytest.raises(LandmarkError):
        apply_edits(person, ScanEdits(low=5000.0))


def test_the_symmetry_of_a_mirrored_body_comes_with_the_warning():
    source = ScanSource(str(SAMPLES / "person.ply"), edits=ScanEdits(kept="right"))
    found = compare(build(Design(source)), balance=False)
    assert found.compared.before.largest_difference < 0.5
    assert mirror_sentence("right") in found.warnings
    assert str(mirror_sentence("right")) in symmetry_view(found.compared, found.stages).says
