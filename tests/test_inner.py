"""Whole figures: legs under the trunk, or reaching into it, leave the landmarks where they are."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import trimesh
from worn_scans import ply_bytes, with_legs

from core.body import Body, body_of, read_scan
from core.cleaning.inner import drop_hidden
from core.cleaning.skin import Skin
from core.landmarks import find_landmarks


@cache
def alone(person: Path) -> Body:
    return read_scan(person)


@pytest.mark.parametrize(("into", "said"), [(-1.0, False), (290.0, True)])
def test_legs_leave_the_landmarks_where_they_are(person: Path, into: float, said: bool) -> None:
    trunk = alone(person)
    figure = body_of("figure.ply", ply_bytes(with_legs((trunk.mesh.vertices, trunk.mesh.faces), into)))
    assert figure.pose.sure
    assert any("reach into the body" in sentence for sentence in figure.repairs) == said
    was, now = find_landmarks(trunk), find_landmarks(figure)
    shift = figure.pose.file_to_mm[:3, 3]
    for name in ("bust_point_left", "bust_point_right", "fold_left", "fold_right"):
        assert np.linalg.norm(now.position(name) - was.position(name) - shift) < 1.0, name
        assert now.points[name].confidence > was.points[name].confidence - 0.15, name


@pytest.mark.parametrize(("away", "left"), [(60.0, 0.0), (100.0, 0.6), (145.0, 1.0), (200.0, 1.0)])
def test_of_a_ball_in_a_ball_only_what_reaches_out_of_it_is_left(away: float, left: float) -> None:
    large, small = trimesh.creation.icosphere(5, 100.0), trimesh.creation.icosphere(4, 30.0)
    small.apply_translation([away, 0.0, 0.0])
    vertices = np.concatenate([large.vertices, small.vertices])
    faces = np.concatenate([large.faces, small.faces + len(large.vertices)])
    skin, count = drop_hidden(Skin(vertices, faces))
    share = 1.0 - count / len(small.faces)
    assert share == pytest.approx(left, abs=0.2 if 0.0 < left < 1.0 else 0.0)
    assert len(skin.faces) == len(large.faces) + len(small.faces) - count
    middle = skin.centres[len(large.faces) :]
    assert (np.linalg.norm(middle, axis=1) > 100.0 - 12.0).all()
