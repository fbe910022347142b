"""Girths: a cylinder by hand, arms left out, and what the samples are known to measure."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from core.geometry.mesh import Mesh
from core.landmarks.torso.cross_sections import stable_level, trunk_levels
from core.landmarks.torso.girths import Girth, girth_at, girth_warnings, girths
from core.landmarks.types import Landmark, Landmarks
from core.messages import EMPTY
from core.scan.body import Body
from core.scan.orientation.pose import Pose
from core.scan.repair.denoise import denoise

ROOT = Path(__file__).parents[3]
TRUTH = json.loads((ROOT / "tests/data/truth.json").read_text(encoding="utf-8"))
SAMPLES = ("mannequin", "person")
SURE = {"left": 0.8, "right": 0.2}


def sample(name: str) -> Mesh:
    mesh = trimesh.load(ROOT / f"resources/samples/{name}.ply", process=False)
    return Mesh(np.asarray(mesh.vertices), np.asarray(mesh.faces))


def cylinder(radius: float, x: float = 0.0, height: float = 400.0) -> Mesh:
    tube = trimesh.creation.cylinder(radius, height, sections=720)
    return shifted(Mesh(np.asarray(tube.vertices), np.asarray(tube.faces)), x, 0.0, 0.0)


def shifted(mesh: Mesh, x: float, y: float, z: float) -> Mesh:
    return mesh.moved(mesh.vertices + np.array([x, y, z]))


def together(*meshes: Mesh) -> Mesh:
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes[:-1]])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=True)]
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]), np.concatenate(faces))


def test_a_tape_round_a_cylinder_reads_its_circumference():
    girth = girth_at(cylinder(100.0), 10.0)
    assert girth.level_mm == 10.0
    assert girth.tape_mm == pytest.approx(628.3, abs=0.05)
    assert girth.skin_mm == pytest.approx(628.3, abs=0.05)


def test_arms_are_left_out_however_near_they_hang():
    body = together(cylinder(130.0), cylinder(40.0, 172.0), cylinder(40.0, -300.0))
    assert girth_at(body, 0.0).tape_mm == pytest.approx(2.0 * np.pi * 130.0, abs=0.1)


def test_what_hangs_in_front_of_the_trunk_is_measured_with_it():
    breast = shifted(cylinder(30.0, 80.0, 90.0), 0.0, -120.0, 0.0)
    body = together(cylinder(130.0), breast)
    alone = 2.0 * np.pi * 130.0
    assert girth_at(body, 0.0).tape_mm > alone + 10.0
    assert girth_at(body, 0.0).skin_mm == pytest.approx(alone + 2.0 * np.pi * 30.0, abs=0.1)


def test_a_tape_bridges_a_hollow_and_the_skin_follows_it():
    tube = cylinder(100.0)
    x, y, z = tube.vertices.T
    body = tube.moved(np.stack([x, np.where(np.abs(x) < 30.0, 0.7 * y, y), z], axis=1))
    girth = girth_at(body, 0.0)
    assert girth.tape_mm < 628.0 < girth.skin_mm


def test_there_is_no_girth_above_the_body():
    girth = girth_at(cylinder(100.0), 500.0)
    assert (girth.tape_mm, girth.skin_mm) == (0.0, 0.0)


def test_the_stable_level_of_a_cone_is_where_one_asks_and_under_a_breast_it_is_below_it():
    x, y, z = cylinder(100.0).vertices.T
    cone = cylinder(100.0).moved(np.stack([x * (1.0 + z / 2000.0), y * (1.0 + z / 2000.0), z], axis=1))
    assert stable_level(cone, 50.0).z == 50.0
    tip = trimesh.creation.cone(60.0, 100.0)
    breast = shifted(Mesh(tip.vertices * [1.0, -1.0, -1.0], tip.faces), 80.0, -160.0, 141.0)  # ends at z = 41
    assert stable_level(together(cylinder(130.0), breast), 50.0).z == 40.0


def test_all_levels_at_once_are_the_levels_one_by_one():
    mesh = sample("person")
    heights = np.array([100.0, 219.35, 257.19, 380.0])
    for z, level in zip(heights, trunk_levels(mesh, heights), strict=True):
        alone = trunk_levels(mesh, z)[0]
        assert level.tape == pytest.approx(alone.tape, abs=1e-9)
        assert np.allclose(level.points[:, 2], z)


@pytest.mark.parametrize("name", SAMPLES)
@pytest.mark.parametrize("girth", ["bust", "underbust_stable", "waist"])
def test_the_samples_measure_what_they_are_known_to(name, girth):
    truth = TRUTH[name]["girths"][girth]
    assert girth_at(sample(name), truth["level_z"]).tape_mm == pytest.approx(truth["tape"], abs=1.0)


@pytest.mark.parametrize("name", SAMPLES)
def test_underbust_is_read_where_the_breast_is_no_longer_in_the_way(name):
    truth = TRUTH[name]["girths"]
    mesh = sample(name)
    body = Body(mesh, Pose("mm", "+z", "-y", np.eye(4), True, EMPTY, 1.0), (), name)
    levels = Landmarks({}, truth["bust"]["level_z"], truth["underbust"]["level_z"])
    found = girths(body, levels)
    assert set(found) == {"bust", "underbust"}
    assert found["underbust"].level_mm == pytest.approx(truth["underbust_stable"]["level_z"], abs=0.01)
    assert found["underbust"].tape_mm == pytest.approx(truth["underbust_stable"]["tape"], abs=1.0)


def test_the_under_bust_girth_is_no_surer_than_the_folds():
    girth = Girth(0.0, 800.0, 800.0)
    assert girth_warnings({"underbust": girth}) == []
    assert "folds" in str(girth_warnings({"underbust": replace(girth, confidence=0.3)})[0])
    marks = [Landmark(name, np.zeros(3), 0.3, EMPTY) for name in ("fold_left", "fold_right")]
    body = Body(cylinder(130.0), Pose("mm", "+z", "-y", np.eye(4), True, EMPTY, 1.0), (), "a tube")
    found = girths(body, Landmarks({mark.name: mark for mark in marks}, 20.0, 0.0))
    assert found["underbust"].confidence == 0.3
    marks = [Landmark(f"bust_point_{side}", np.zeros(3), sure, EMPTY) for side, sure in SURE.items()]
    found = girths(body, Landmarks({mark.name: mark for mark in marks}, 20.0, 0.0))
    assert found["bust"].confidence == 0.8, "the level of the bust is as sure as its surer point"


def test_a_clean_body_is_left_alone_and_the_noise_of_a_scan_is_not_measured():
    mesh = sample("mannequin")
    assert denoise(mesh) is mesh
    rough = np.random.default_rng(7).normal(0.0, 1.0, (len(mesh.vertices), 1))
    noisy = mesh.moved(mesh.vertices + mesh.vertex_normals * rough)
    z = TRUTH["mannequin"]["girths"]["bust"]["level_z"]
    clean, raw, calm = (girth_at(m, z).tape_mm for m in (mesh, noisy, denoise(noisy)))
    assert raw > clean + 3.0
    assert calm == pytest.approx(clean, abs=2.5)
