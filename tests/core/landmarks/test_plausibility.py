"""What a body seems to be that it should not be: another size, leaning, flat, clothed, of stone."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import trimesh
from altered_bodies import smooth_step

from app.cli.commands.detect import landmarks_text
from core.errors import LandmarkError
from core.geometry.mesh import Mesh, Points
from core.landmarks.as_dict import detection
from core.landmarks.body_scale import Build, measure_build, size_hint, whole_figure
from core.landmarks.detect import find_landmarks
from core.landmarks.plausibility import SMALL, clothes_hint, flat_hint, lean_hint, require_not_angular
from core.landmarks.torso.cross_sections import stable_level, trunk_levels
from core.landmarks.types import CERTAIN, Hint, Landmarks
from core.messages import EMPTY, Message
from core.scan.body import Body
from core.scan.orientation.pose import Pose
from core.scan.repair.clipping import clip_above

ROOT = Path(__file__).parents[3]
FACTOR = {"mm": 1.0, "inch": 25.4}
Y_UP = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.1]]
"""Takes a file with y up that faces +z to the canonical frame."""


@cache
def sample(name: str = "person") -> Mesh:
    mesh = trimesh.load(ROOT / f"resources/samples/{name}.ply", process=False)
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))


def body_of(vertices: Points, unit: str = "mm", name: str = "person") -> Body:
    """A body whose file was read in ``unit``: its vertices are those in mm already."""
    pose = Pose(unit, "+z", "-y", np.diag([*np.full(3, FACTOR[unit]), 1.0]), True, EMPTY, 1.0)
    return Body(sample(name).moved(vertices), pose, (), "a body")


def kinds(found: Landmarks) -> list[str]:
    return [hint.kind for hint in found.hints]


@cache
def found(name: str = "person") -> Landmarks:
    return find_landmarks(body_of(sample(name).vertices, name=name))


def leant(degrees: float) -> Build:
    """The mannequin turned stiffly forward, with its landmarks."""
    a, marks = np.radians(degrees), found("mannequin")
    turn = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(a), -np.sin(a)], [0.0, np.sin(a), np.cos(a)]])
    points = {name: replace(mark, position=turn @ mark.position) for name, mark in marks.points.items()}
    return measure_build(
        sample("mannequin").moved(sample("mannequin").vertices @ turn.T), replace(marks, points=points)
    )


@pytest.mark.parametrize("name", ["person", "mannequin"])
def test_the_samples_raise_no_doubt(name):
    assert found(name).hints == ()


def test_a_body_of_another_size_is_doubted_and_asked_about():
    body = body_of(1.5 * sample().vertices)
    again = find_landmarks(body)
    assert kinds(again) == ["size"]
    assert again.hints[0].sentence in again.warnings
    told = detection(body, again)
    assert (told["sure"], told["hints"]) == (False, ["size"])


def test_a_form_at_half_scale_in_cm_is_not_taken_for_one_in_inches():
    again = find_landmarks(body_of(0.5 * 2.54 * sample().vertices, "inch"))
    assert kinds(again) == ["size"]
    assert "half scale" in str(again.hints[0].sentence)


def test_a_small_body_in_inches_is_not_called_large():
    factor, marks = np.array([1.0, 1.0, 0.5]), found()
    points = {name: replace(mark, position=factor * mark.position) for name, mark in marks.points.items()}
    body = body_of(factor * sample().vertices, "inch")
    (hint,) = size_hint(measure_build(body.mesh, replace(marks, points=points)), body.pose)
    assert "unusually small" in str(hint.sentence)


def test_the_stature_is_that_of_a_whole_figure_alone():
    heights = np.arange(1230.0, 1640.0, 6.0)
    widths = np.interp(heights, [1230, 1330, 1380, 1400, 1500, 1640], [420, 340, 110, 110, 155, 60])
    assert whole_figure(heights, widths, 1220.0, 0.0) == pytest.approx(1640.0, abs=6.0)
    assert whole_figure(2.0 * heights, 2.0 * widths, 2440.0, 0.0) == pytest.approx(3280.0, abs=12.0)
    assert whole_figure(heights, widths, 1220.0, 900.0) == 0.0, "cut at the hips"
    cut = heights < 1400.0
    assert whole_figure(heights[cut], widths[cut], 1220.0, 820.0) == 0.0, "cut at the neck"


@pytest.mark.parametrize("degrees", [17.0, -17.0])
def test_a_lean_is_told_with_its_angle_and_the_up_that_corrects_it(degrees):
    pose = Pose("cm", "+y", "+z", 10.0 * np.array(Y_UP), True, EMPTY, 1.0)
    (hint,) = lean_hint(leant(degrees), pose)
    x, y, z = (float(number) for number in hint.up.split(","))
    true = np.array([0.0, np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    assert np.array([x, y, z]) @ true > np.cos(np.radians(5.0))
    assert ("forward" in str(hint.sentence)) == (degrees > 0.0)


def test_the_command_line_names_the_direction_that_corrects_a_lean():
    leaning = replace(found("mannequin"), hints=(Hint("lean", Message("The trunk leans."), "-0.1,0.3,0.9"),))
    told = detection(body_of(sample("mannequin").vertices, name="mannequin"), leaning)
    assert "--up=-0.1,0.3,0.9" in landmarks_text(told)


def test_a_lean_that_was_corrected_is_not_told():
    pose = Pose("mm", "+z", "-y", np.eye(4), True, EMPTY, 1.0, tilt=17.0)
    assert lean_hint(leant(17.0), pose) == ()


def flattened(share: float) -> Points:
    """The person with breasts that stand out by this share of what they do."""
    v, marks = sample().vertices.copy(), found()
    for side in ("left", "right"):
        bust, fold = marks.position(f"bust_point_{side}"), marks.position(f"fold_{side}")
        away = np.hypot((v[:, 0] - bust[0]) / 95.0, (v[:, 2] - bust[2]) / 105.0)
        near = (1.0 - smooth_step(away, 0.4, 1.0)) * (v[:, 1] < fold[1])
        v[:, 1] += (1.0 - share) * near * (fold[1] - v[:, 1])
    return v


def test_hardly_a_breast_is_told_and_no_landmark_is_sure_there():
    again = find_landmarks(body_of(flattened(0.45)))
    assert "flat" in kinds(again)
    bust = [mark for name, mark in again.points.items() if name.startswith(("bust_point", "fold", "lowest"))]
    assert max(mark.confidence for mark in bust) < CERTAIN


def test_breasts_that_stand_out_are_not_flat():
    assert flat_hint(sample(), found()) == ()


def test_a_small_bust_is_flat_only_where_its_landmarks_are_not_clear():
    v = flattened(0.45)
    mesh, marks = sample().moved(v), find_landmarks(body_of(v))
    more = trunk_levels(mesh, marks.bust_level)[0].tape / stable_level(mesh, marks.underbust_level).tape - 1.0
    assert more > SMALL
    for confidence, kinds_told in ((0.9, []), (0.4, ["flat"])):
        points = {name: replace(mark, confidence=confidence) for name, mark in marks.points.items()}
        hints = flat_hint(mesh, replace(marks, points=points))
        assert [hint.kind for hint in hints] == kinds_told


def wrinkled(top: float) -> Points:
    """The person under cloth that hangs in waves up to a height [mm]."""
    v = sample().vertices.copy()
    middle = np.array([v[:, 0].mean(), -90.0])
    turn = np.arctan2(v[:, 0] - middle[0], middle[1] - v[:, 1])
    below = 1.0 - smooth_step(v[:, 2], top - 20.0, top)
    v[:, :2] += (below * 9.0 * np.sin(11.0 * turn))[:, None] * np.stack([np.sin(turn), -np.cos(turn)], axis=1)
    return v


def test_wrinkles_of_a_loose_shirt_are_told():
    marks = found()
    assert clothes_hint(measure_build(sample(), marks), marks) == ()
    shirt = measure_build(sample().moved(wrinkled(marks.underbust_level)), marks)
    assert [hint.kind for hint in clothes_hint(shirt, marks)] == ["clothes"]


def test_wrinkles_are_told_of_a_scan_that_ends_at_the_bust():
    marks = found()
    level = marks.underbust_level - 15.0
    for mesh, kinds_told in (
        (sample(), []),
        (sample().moved(wrinkled(marks.bust_level + 80.0)), ["clothes"]),
    ):
        short, _ = clip_above(mesh, 2, level)
        assert [hint.kind for hint in clothes_hint(measure_build(short, marks), marks)] == kinds_told


def test_an_angular_trunk_is_refused():
    v, marks = sample().vertices.copy(), found()
    require_not_angular(measure_build(sample(), marks), marks)
    middle, half = np.array([0.0, -90.0]), np.array([150.0, 100.0])
    flat = (v[:, :2] - middle) / half
    v[:, :2] = middle + flat / np.abs(flat).max(axis=1, keepdims=True).clip(1e-9) * half
    with pytest.raises(LandmarkError, match="rectangular"):
        require_not_angular(measure_build(sample().moved(v), marks), marks)
