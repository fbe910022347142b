"""Volumes of breasts: caps of balls on chests, with formulas."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from breast_shapes import cap

from core.geometry.mesh import Mesh
from core.measurements.breast_root import Root, root_of
from core.measurements.breast_volume import breast_of


@pytest.mark.parametrize(("height", "radius"), [(60.0, 60.0), (30.0, 60.0), (25.0, 80.0), (90.0, 60.0)])
@pytest.mark.parametrize("chest", ["flat", "round", "oval"])
def test_the_volume_of_a_cap_is_right_on_any_chest(height: float, radius: float, chest: str) -> None:
    side, root, volume = cap(height, radius, chest=chest)
    breast = breast_of(side, root)
    assert breast is not None
    assert not breast.holed
    assert breast.volume == pytest.approx(volume, rel=0.002)


@pytest.mark.parametrize("overhang", [0.5, 1.2])
def test_a_breast_that_hangs_over_its_fold_keeps_its_volume(overhang: float) -> None:
    side, root, volume = cap(60.0, overhang=overhang)
    breast = breast_of(side, root)
    assert side.piece.vertices[:, 2].min() < root.loop[:, 2].min()
    assert breast is not None
    assert breast.volume == pytest.approx(volume, rel=0.002)


def test_a_hole_in_a_breast_is_closed_and_told() -> None:
    side, root, volume = cap(40.0)
    middle = side.piece.vertices[side.piece.faces].mean(axis=1)
    near = np.linalg.norm(middle - side.bust_point + [0.0, 0.0, 22.0], axis=1) < 8.0
    breast = breast_of(replace(side, piece=Mesh(side.piece.vertices, side.piece.faces[~near])), root)
    assert near.sum() > 20
    assert breast is not None
    assert breast.holed
    assert breast.volume == pytest.approx(volume, rel=0.01)


def test_an_open_root_gives_no_volume() -> None:
    side, root, _ = cap(40.0)
    above = Root(root.loop[: root.lower], root.lower, root.chart, 1.0)
    assert breast_of(side, above) is None


def test_a_root_is_laid_through_its_ends_the_fold_and_a_half_circle() -> None:
    side, known, volume = cap(40.0, chest="round")
    root = root_of(side)
    assert root is not None
    assert np.linalg.norm(root.loop[0] - known.loop[0]) < 1.0
    assert np.linalg.norm(root.under[-1] - known.under[-1]) < 1.0
    away = np.linalg.norm(root.loop[:, None] - known.closed[None], axis=2).min(axis=1)
    assert away.max() < 4.0
    breast = breast_of(side, root)
    assert breast is not None
    assert breast.volume == pytest.approx(volume, rel=0.01)
    high = root_of(side, 12.0)
    assert high is not None
    assert high.loop[:, 2].max() > root.loop[:, 2].max() + 8.0
