"""The part of a mesh that cloth covers."""

from __future__ import annotations

import numpy as np
import pytest

from app.rendering.cup_actors import cut_out
from core.geometry.mesh import Mesh


def grid(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points of a unit square and its triangles."""
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.linspace(0.0, 1.0, count)] * 2))
    corner = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    lower = np.stack([corner, corner + 1, corner + count + 1], axis=1)
    upper = np.stack([corner, corner + count + 1, corner + count], axis=1)
    return np.stack([x, y, 0.0 * x], axis=1), np.concatenate([lower, upper])


@pytest.mark.parametrize("slope", [(1.0, 0.0), (0.3, 0.9), (-0.6, 0.5)])
def test_a_plane_field_cuts_along_a_straight_line_and_keeps_the_side_of_triangles(
    slope: tuple[float, float],
) -> None:
    points, faces = grid(9)
    value = points[:, :2] @ slope + 0.5 - 0.5 * sum(slope) + 0.013
    part = cut_out(faces, value)
    at = part.at(points)
    inside = at[:, :2] @ slope + 0.5 - 0.5 * sum(slope) + 0.013
    assert inside.min() > 0.5 - 1e-9
    assert np.abs(inside[np.unique(part.border)] - 0.5).max() < 1e-9
    made = Mesh(at, part.faces)
    towards = np.cross(*(at[part.faces[:, k]] - at[part.faces[:, 0]] for k in (1, 2)))[:, 2]
    assert (towards > -1e-15).all()
    dense = np.random.default_rng(0).random((200_000, 2))
    share = float((dense @ slope + 0.5 - 0.5 * sum(slope) + 0.013 >= 0.5).mean())
    assert made.face_areas.sum() == pytest.approx(share, abs=0.01)


def test_nothing_is_cut_out_of_nothing() -> None:
    points, faces = grid(4)
    part = cut_out(faces, np.zeros(len(points)))
    assert part.faces.shape == (0, 3)
    assert len(part.at(points)) == 0
