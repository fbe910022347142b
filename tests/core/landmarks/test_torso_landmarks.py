"""Landmarks of trunk and breast roots: where they must lie, mirrored, on the skin, absent if not shown."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest
import trimesh
from scipy.interpolate import PchipInterpolator
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance

from core.geometry.mesh import Mesh
from core.landmarks.breast_root import breast_root_landmarks
from core.landmarks.torso.girths import girth_levels
from core.landmarks.torso_landmarks import torso_landmarks
from core.landmarks.types import NAMES, SIDES, Landmark, Landmarks
from core.messages import EMPTY, Message

ROOT = Path(__file__).parents[3]
TRUTH = json.loads((ROOT / "tests/data/truth.json").read_text(encoding="utf-8"))
SAMPLES = ("mannequin", "person")
MIRROR = np.array([-1.0, 1.0, 1.0])


@cache
def sample(name: str) -> Mesh:
    mesh = trimesh.load(ROOT / f"resources/samples/{name}.ply", process=False)
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))


def bust(name: str, turn: np.ndarray, shift: np.ndarray) -> Landmarks:
    """The true bust points and levels of a sample, mirrored by ``turn`` and shifted."""
    known = {side: np.array(TRUTH[name]["landmarks"][f"nipple_{side}"]) * turn for side in SIDES}
    sides = SIDES if turn[0] > 0.0 else SIDES[::-1]
    points = {
        f"bust_point_{side}": Landmark(f"bust_point_{side}", known[other] + shift, 1.0, Message("true"))
        for side, other in zip(SIDES, sides, strict=True)
    }
    levels = [TRUTH[name]["girths"][level]["level_z"] + shift[2] for level in ("bust", "underbust")]
    return Landmarks(MappingProxyType(points), *levels)


def marks_of(mesh: Mesh, found: Landmarks) -> dict[str, Landmark]:
    return {mark.name: mark for mark in (*torso_landmarks(mesh, found), *breast_root_landmarks(mesh, found))}


@cache
def found(name: str) -> dict[str, Landmark]:
    return marks_of(sample(name), bust(name, np.ones(3), np.zeros(3)))


def off_the_skin(mesh: Mesh, points: np.ndarray) -> float:
    corners, faces, skin = vtkPoints(), vtkCellArray(), vtkPolyData()
    corners.SetData(numpy_to_vtk(mesh.vertices))
    rows = np.column_stack([np.full(len(mesh.faces), 3), mesh.faces]).ravel()
    faces.ImportLegacyFormat(numpy_to_vtkIdTypeArray(rows, deep=True))
    skin.SetPoints(corners)
    skin.SetPolys(faces)
    distance = vtkImplicitPolyDataDistance()
    distance.SetInput(skin)
    return max(abs(distance.EvaluateFunction(point)) for point in points.tolist())


@pytest.mark.parametrize("name", SAMPLES)
def test_places_and_the_curves_that_tell_them_lie_on_the_skin(name):
    near = sample(name)
    for mark in found(name).values():
        assert mark.name in NAMES
        assert 0.0 < mark.confidence < 0.9
        assert str(mark.rule).endswith(".")
        assert len(mark.evidence) > 10
        points = np.concatenate([mark.position[None], mark.evidence[:: max(1, len(mark.evidence) // 20)]])
        assert off_the_skin(near, points) < 0.2, mark.name
        assert np.linalg.norm(mark.evidence - mark.position, axis=1).min() < 6.0, mark.name


@pytest.mark.parametrize("name", SAMPLES)
def test_the_front_centre_is_where_it_is_known_to_be(name):
    for mark, known in (
        ("front_centre", "front_mid_bust"),
        ("front_centre_underbust", "front_mid_underbust"),
    ):
        away = found(name)[mark].position - np.array(TRUTH[name]["landmarks"][known])
        assert np.linalg.norm(away) < 4.0, mark


@pytest.mark.parametrize("name", SAMPLES)
def test_marks_lie_in_order_round_the_trunk(name):
    at = {key: mark.position for key, mark in found(name).items()}
    assert at["root_outer_right"][0] < at["root_inner_right"][0] < at["front_centre"][0]
    assert at["front_centre"][0] < at["root_inner_left"][0] < at["root_outer_left"][0]
    assert at["side_right"][0] < -100.0
    assert at["side_left"][0] > 100.0
    assert at["back_centre"][1] > at["side_left"][1] > at["front_centre"][1]
    for side in SIDES:
        assert at[f"armpit_{side}"][2] > TRUTH[name]["girths"]["bust"]["level_z"] + 20.0
        assert found(name)[f"root_outer_{side}"].confidence < 0.5


@pytest.mark.parametrize("name", SAMPLES)
def test_a_mirrored_body_has_mirrored_marks(name):
    mesh = sample(name)
    twin = marks_of(Mesh(mesh.vertices * MIRROR, mesh.faces[:, ::-1]), bust(name, MIRROR, np.zeros(3)))
    assert len(twin) == len(found(name))
    for key, mark in found(name).items():
        other = key.replace("left", "RIGHT").replace("right", "left").replace("RIGHT", "right")
        ends = key.startswith(("side", "armpit"))  # flat places: only how far out they lie is certain
        away = np.abs(twin[other].position * MIRROR - mark.position)
        assert away[[0, 2]].max() < 1.0, key
        assert away[1] < (12.0 if ends else 1.0), key
        assert twin[other].confidence == pytest.approx(mark.confidence, abs=0.1)


def test_marks_move_with_the_body():
    shift = np.array([431.0, -87.0, 1250.0])
    mesh = sample("person")
    moved = marks_of(mesh.moved(mesh.vertices + shift), bust("person", np.ones(3), shift))
    for key, mark in found("person").items():
        assert np.allclose(moved[key].position, mark.position + shift, atol=0.5), key


def test_the_centre_follows_a_body_that_stands_askew():
    mesh = sample("person")
    tilt = 0.08 * (mesh.vertices[:, 2] - 250.0)
    askew = mesh.moved(mesh.vertices + np.stack([tilt, 0.0 * tilt, 0.0 * tilt], axis=1))
    straight = bust("person", np.ones(3), np.zeros(3))
    points = {
        key: Landmark(
            key, mark.position + np.array([0.08 * (mark.position[2] - 250.0), 0.0, 0.0]), 1.0, Message("true")
        )
        for key, mark in straight.points.items()
    }
    marks = marks_of(
        askew, Landmarks(MappingProxyType(points), straight.bust_level, straight.underbust_level)
    )
    for key in ("front_centre", "side_left", "side_right", "root_inner_left"):
        where = found("person")[key].position
        assert marks[key].position[0] == pytest.approx(where[0] + 0.08 * (where[2] - 250.0), abs=4.0), key


def test_what_the_scan_does_not_show_is_absent():
    for name in SAMPLES:
        assert not {"hip_front", "neck_front", "neck_back"} & set(found(name))
    mesh = sample("mannequin")
    low, high = TRUTH["mannequin"]["girths"]["waist"]["level_z"] + 90.0, 380.0
    middle = mesh.vertices[mesh.faces].mean(axis=1)[:, 2]
    band = Mesh(mesh.vertices, mesh.faces[(middle > low) & (middle < high)])
    marks = marks_of(band, bust("mannequin", np.ones(3), np.zeros(3)))
    assert "front_centre" in marks
    assert not {"waist_front", "hip_front", "armpit_left", "armpit_right"} & set(marks)


def test_waist_hip_and_neck_of_a_whole_figure():
    """A figure turned on a lathe: a cylinder whose girth is known at every height, with a head on it."""
    z = np.arange(-530.0, 480.0, 4.0)
    heights = [-530.0, -330.0, -130.0, 0.0, 150.0, 220.0, 290.0, 390.0, 480.0]
    widths = [0.85, 1.15, 0.85, 1.0, 1.0, 0.42, 0.42, 0.6, 0.3]
    size = PchipInterpolator(heights, widths)(z)
    turn = np.radians(np.arange(0.0, 360.0, 3.0))
    rings = [
        np.stack([140.0 * s * np.sin(turn), -100.0 * s * np.cos(turn), np.full(len(turn), h)], axis=1)
        for s, h in zip(size, z, strict=True)
    ]
    corner = np.arange((len(z) - 1) * len(turn)).reshape(-1, len(turn))
    after, up = np.roll(corner, -1, axis=1), len(turn)
    sides = ([corner, after, after + up], [corner, after + up, corner + up])
    faces = np.concatenate([np.stack(side, axis=-1).reshape(-1, 3) for side in sides])
    figure = Mesh(np.concatenate(rings), faces)
    points = {
        f"bust_point_{side}": Landmark(f"bust_point_{side}", np.array([x, -86.6, 20.0]), 1.0, EMPTY)
        for side, x in zip(SIDES, (70.0, -70.0), strict=True)
    }
    found_bust = Landmarks(MappingProxyType(points), 20.0, -10.0)
    marks = {mark.name: mark for mark in torso_landmarks(figure, found_bust)}
    assert marks["waist_front"].position == pytest.approx([0.0, -85.0, -130.0], abs=4.0)
    assert marks["hip_front"].position == pytest.approx([0.0, -115.0, -330.0], abs=4.0)
    assert marks["neck_front"].position[2] == pytest.approx(220.0, abs=8.0)
    assert marks["neck_back"].position == pytest.approx([0.0, 99.0, 155.0], abs=5.0)
    assert not {"armpit_left", "armpit_right"} & set(marks)
    levels = girth_levels(Landmarks(MappingProxyType(marks), 20.0, -10.0))
    assert set(levels) == {"waist", "hip"}
