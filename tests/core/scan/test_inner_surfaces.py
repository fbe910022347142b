"""Whole figures: legs under the trunk, or reaching into it, leave the landmarks where they are."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import trimesh
from worn_scans import ply_bytes, with_legs

from core.landmarks.detect import find_landmarks
from core.scan.body import Body, body_of, read_scan
from core.scan.repair import inner_surfaces as inner
from core.scan.repair.editable_mesh import EditableMesh
from core.scan.repair.inner_surfaces import BURIED, remove_occluded
from core.scan.repair.repair import repair


@cache
def alone(person: Path) -> Body:
    return read_scan(person)


@pytest.mark.parametrize(("into", "said"), [(-1.0, False), (290.0, True)])
def test_legs_leave_the_landmarks_where_they_are(person: Path, into: float, said: bool) -> None:
    trunk = alone(person)
    figure = body_of("figure.ply", ply_bytes(with_legs((trunk.mesh.vertices, trunk.mesh.faces), into)))
    assert figure.pose.is_certain
    assert any("extend into the body" in str(sentence) for sentence in figure.repairs) == said
    was, now = find_landmarks(trunk), find_landmarks(figure)
    shift = figure.pose.file_to_mm[:3, 3]
    for name in ("bust_point_left", "bust_point_right", "fold_left", "fold_right"):
        assert np.linalg.norm(now.position(name) - was.position(name) - shift) < 1.0, name
        assert now.points[name].confidence > was.points[name].confidence - 0.15, name


def together(*shapes: trimesh.Trimesh) -> EditableMesh:
    whole = trimesh.util.concatenate(shapes)
    return EditableMesh(np.array(whole.vertices), np.array(whole.faces))


def ball(detail: int, radius: float, x: float = 0.0) -> trimesh.Trimesh:
    made = trimesh.creation.icosphere(detail, radius)
    return made.apply_translation([x, 0.0, 0.0])


def of_the_last(skin: EditableMesh, last: trimesh.Trimesh) -> float:
    """Return which share of the faces of the last shape is left; all others are to stay."""
    left, count = remove_occluded(skin)
    others = len(skin.faces) - len(last.faces)
    assert np.allclose(left.vertices[left.faces[:others]], skin.vertices[skin.faces[:others]])
    return 1.0 - count / len(last.faces)


# at 69 it ends on the skin of the large one: too near to it to be told in or out, but cut off with what is in
@pytest.mark.parametrize(
    ("away", "left"), [(60.0, 0.0), (69.0, 0.0), (100.0, 0.6), (145.0, 1.0), (200.0, 1.0)]
)
def test_of_a_ball_in_a_ball_only_what_reaches_out_of_it_is_left(away: float, left: float) -> None:
    small = ball(4, 30.0, away)
    skin = together(ball(5, 100.0), small)
    assert of_the_last(skin, small) == pytest.approx(left, abs=0.2 if 0.0 < left < 1.0 else 0.0)
    middle = remove_occluded(skin)[0].centres[-len(small.faces) :]
    assert left == 0.0 or (np.linalg.norm(middle, axis=1) > 100.0 - 12.0).all()


@pytest.mark.parametrize(("radius", "left"), [(70.0, 0.0), (40.0, 1.0)])
def test_only_what_is_large_beside_the_largest_piece_hides_others(radius: float, left: float) -> None:
    small = ball(3, 15.0, 300.0)
    assert of_the_last(together(ball(5, 100.0), ball(4, radius, 300.0), small), small) == left


def test_a_layer_nearer_than_the_triangles_of_a_coarse_skin_are_wide_is_not_taken_for_hidden() -> None:
    layer = ball(4, 96.0)
    cap = trimesh.Trimesh(layer.vertices, layer.faces[layer.triangles_center[:, 2] > 30.0])
    assert of_the_last(together(ball(2, 100.0), cap), cap) == 1.0


@pytest.fixture(scope="module")
def coat(person: Path) -> EditableMesh:
    """A body, and a wide coat over it up to the shoulders."""
    mesh = alone(person).mesh
    middle, low = mesh.vertices.mean(axis=0), mesh.vertices[mesh.faces].mean(axis=1)[:, 2]
    worn = mesh.faces[low < np.percentile(low, 85.0)]
    vertices = np.concatenate([mesh.vertices, (mesh.vertices - middle) * [1.2, 1.3, 1.0] + middle])
    return EditableMesh(vertices, np.concatenate([mesh.faces, worn + len(mesh.vertices)]))


def test_clothes_over_a_body_are_told_of_with_its_landmarks(person: Path, coat: EditableMesh) -> None:
    *_, sentences = repair(coat.vertices, coat.faces)
    assert BURIED in sentences
    body = alone(person)
    assert BURIED not in find_landmarks(body).warnings
    assert BURIED in find_landmarks(replace(body, repairs=sentences)).warnings


def test_a_lining_is_no_clothes(person: Path) -> None:
    mesh = alone(person).mesh
    lining = mesh.vertices - 6.0 * mesh.vertex_normals, mesh.faces[:, ::-1]
    vertices = np.concatenate([mesh.vertices, lining[0]])
    *_, sentences = repair(vertices, np.concatenate([mesh.faces, lining[1] + len(mesh.vertices)]))
    assert any("duplicating its surface" in str(sentence) for sentence in sentences)
    assert BURIED not in sentences


def test_a_coat_over_a_body_is_asked_for_few_places(
    coat: EditableMesh, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked, winding = [], inner._winding

    def counting(middle, dipole, places, *rest):  # type: ignore[no-untyped-def]
        asked.append(len(middle) * len(places))
        return winding(middle, dipole, places, *rest)

    monkeypatch.setattr(inner, "_winding", counting)
    remove_occluded(coat)
    assert 0 < sum(asked) < 6e7  # a thousand a face: half a second
