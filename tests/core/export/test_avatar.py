"""The avatar as other programs read it: the body and its seams by name, in their place and unit."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

from core.document.block import Seam
from core.errors import UserError
from core.export.avatar import seam_lines, write_avatar
from core.geometry.mesh import Mesh, Points
from core.pattern.seam_curves import SeamCurve
from core.pipeline.build import Stages

SEAMS = ("cup seam left", "wire left")


def ball() -> tuple[Mesh, dict[str, Points]]:
    """A ball, wider than deep, with two seams on it."""
    shape = trimesh.creation.icosphere(subdivisions=4, radius=100.0)
    body = Mesh(np.asarray(shape.vertices) * [1.0, 0.6, 1.5], np.asarray(shape.faces))
    return body, {name: body.vertices[rows] for name, rows in zip(SEAMS, ([3, 9, 12], [40, 41]), strict=True)}


def y_up(points: Points) -> Points:
    return np.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=1)


def test_an_obj_has_the_body_and_a_named_line_for_each_seam_in_millimetres(tmp_path: Path) -> None:
    body, seams = ball()
    file = tmp_path / "avatar.obj"
    write_avatar(file, body, seams)
    loaded = trimesh.load(file, process=False, maintain_order=True, skip_materials=True)
    meshes = loaded.geometry.values() if isinstance(loaded, trimesh.Scene) else [loaded]
    (shape,) = [each for each in meshes if isinstance(each, trimesh.Trimesh)]
    assert len(shape.faces) == len(body.faces)
    assert shape.is_watertight
    assert shape.volume == pytest.approx(body.enclosed_volume(), rel=1e-6), "faces outward"
    np.testing.assert_allclose(shape.extents, [200.0, 300.0, 120.0], atol=1.0)
    vertices, group, lines = [], "", {}
    for row in file.read_text(encoding="ascii").splitlines():
        word, *rest = row.split()
        if word == "v":
            vertices.append([float(value) for value in rest])
        elif word == "g":
            (group,) = rest
        elif word == "l":
            lines[group] = [int(number) - 1 for number in rest]
    assert list(lines) == ["cup_seam_left", "wire_left"]
    for name, points in zip(lines, seams.values(), strict=True):
        np.testing.assert_allclose(np.array(vertices)[lines[name]], y_up(points), atol=1e-4)


def test_a_glb_has_the_same_in_metres(tmp_path: Path) -> None:
    body, seams = ball()
    file = tmp_path / "avatar.glb"
    write_avatar(file, body, seams)
    scene = trimesh.load(file, process=False)
    assert set(scene.graph.nodes_geometry) == {"body", "cup_seam_left", "wire_left"}
    shape = scene.geometry["body"]
    np.testing.assert_allclose(shape.vertices, y_up(body.vertices) / 1000.0, atol=1e-6)
    assert shape.volume == pytest.approx(body.enclosed_volume() / 1e9, rel=1e-5)
    for name, points in zip(("cup_seam_left", "wire_left"), seams.values(), strict=True):
        path = scene.geometry[name]
        (line,) = path.entities
        steps = line.discrete(path.vertices).reshape(-1, 2, 3)
        ends = np.stack([points[:-1], points[1:]], axis=1).reshape(-1, 3)
        np.testing.assert_allclose(steps.reshape(-1, 3), y_up(ends) / 1000.0, atol=1e-6)


def test_seams_move_with_the_skin_that_they_are_drawn_on(built: Callable[[str], Stages]) -> None:
    skin = built("mannequin").body.smoothed
    points = skin.vertices[skin.faces[:200]].mean(axis=1)
    curve = SeamCurve(Seam("dart", "way", True, ("apex", "root 180")), "left", points)
    there = seam_lines([curve], skin, skin.vertices)
    np.testing.assert_allclose(there["dart left"], points, atol=1e-6)
    moved = skin.vertices * 1.1 + np.array([0.0, 4.0, 0.0])
    np.testing.assert_allclose(
        seam_lines([curve], skin, moved)["dart left"], points * 1.1 + np.array([0.0, 4.0, 0.0]), atol=1e-6
    )


def test_other_formats_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="fbx"):
        write_avatar(tmp_path / "avatar.fbx", *ball())
    assert not list(tmp_path.iterdir())
