"""Folds that no scanner has seen: the skin under both breasts is missing, as behind every bust."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import maximum_filter

from core.geometry.mesh import Mesh
from core.landmarks.detect import find_landmarks
from core.landmarks.lower_breast import CREASE
from tests.core.landmarks.test_damaged_scans import body
from tests.core.landmarks.test_landmarks import SIDES, part, sample, truth


def seen_from(mesh: Mesh, azimuth: float, elevation: float) -> np.ndarray:
    """Return which triangles a scanner sees from beside the front, looking so many degrees downward."""
    (sine, cosine), (high, flat) = (
        (np.sin(np.radians(a)), np.cos(np.radians(a))) for a in (azimuth, elevation)
    )
    towards, up = (sine * flat, -cosine * flat, high), (-sine * high, cosine * high, flat)
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    places = np.concatenate([mesh.vertices, centres])
    cells = np.floor(np.stack([places @ (cosine, sine, 0.0), places @ up], axis=1) / 3.0).astype(int)
    cells -= cells.min(axis=0) - 1
    depth = np.full(cells.max(axis=0) + 2, -np.inf)
    np.maximum.at(depth, tuple(cells.T), places @ towards)
    depth = maximum_filter(depth, 3)
    return (centres @ towards > depth[tuple(cells[len(mesh.vertices) :].T)] - 7.0) & (
        mesh.area_vectors @ towards > 0.1 * np.linalg.norm(mesh.area_vectors, axis=1)
    )


@pytest.mark.parametrize(("name", "elevation"), [("mannequin", 25.0), ("mannequin", 40.0), ("person", 10.0)])
def test_folds_in_the_shadow_of_both_breasts_are_estimated_and_said(name: str, elevation: float) -> None:
    mesh = sample(name)
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    under = np.zeros(len(centres), dtype=bool)
    for side in SIDES:
        away = centres - truth(name, "fold", side)
        under |= (np.abs(away[:, 0]) < 80.0) & (np.abs(away[:, 2]) < 45.0) & (away[:, 1] < 60.0)
    shadow = under & ~np.any([seen_from(mesh, turn, elevation) for turn in (-40.0, 0.0, 40.0)], axis=0)
    landmarks = find_landmarks(body(part(mesh, ~shadow)))
    for side in SIDES:
        fold = landmarks.points[f"fold_{side}"]
        assert fold.position[2] == pytest.approx(truth(name, "fold", side)[2], abs=7.0)
        assert fold.rule != CREASE
        assert fold.confidence < 0.5
