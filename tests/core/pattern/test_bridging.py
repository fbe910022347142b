"""A taut cloth: over a groove it is straight, on round skin it stays, and it never enters the skin."""

from __future__ import annotations

import numpy as np
from scipy.spatial import Delaunay

from core.geometry.mesh import Faces, Mesh, Points
from core.pattern.bridging import bridged


def sheet(half_x: float, half_z: float, step: float = 4.0) -> tuple[Points, Faces]:
    """A flat sheet of even triangles, facing forward (-y)."""
    columns, rows = np.arange(-half_x, half_x + 0.1, step), np.arange(-half_z, half_z + 0.1, step * 0.866)
    x, z = (at.astype(np.float64) for at in np.meshgrid(columns, rows))
    x[1::2] += np.where(np.abs(x[1::2]) < half_x - 0.1, 0.5 * step, 0.0)
    flat = np.stack([x.ravel(), z.ravel()], axis=1)
    faces = Delaunay(flat).simplices.astype(np.int64)
    points = np.stack([flat[:, 0], np.zeros(len(flat)), flat[:, 1]], axis=1)
    return points, forward(points, faces)


def forward(points: Points, faces: Faces) -> Faces:
    """The faces wound so that they face forward."""
    back = Mesh(points, faces).face_normals[:, 1] > 0.0
    return np.where(back[:, None], faces[:, ::-1], faces)


def test_over_a_groove_it_is_straight_from_edge_to_edge() -> None:
    points, faces = sheet(60.0, 40.0)
    points[:, 1] = np.maximum(20.0 - np.abs(points[:, 0]), 0.0)  # a groove 20 mm deep and 40 wide
    cloth = bridged(points, faces, np.tile([0.0, -1.0, 0.0], (len(points), 1)))
    np.testing.assert_allclose(cloth[:, 1], 0.0, atol=0.3)
    np.testing.assert_array_equal(cloth[:, [0, 2]], points[:, [0, 2]])


def test_round_skin_stays_as_it_is() -> None:
    points, faces = sheet(48.0, 48.0)
    points[:, 1] = -np.sqrt(90.0**2 - points[:, 0] ** 2 - points[:, 2] ** 2)
    cloth = bridged(points, faces, Mesh(points, faces).vertex_normals)
    np.testing.assert_allclose(cloth, points, atol=0.2)


def test_between_two_breasts_it_leaves_the_skin_and_nowhere_enters_it() -> None:
    points, faces = sheet(120.0, 60.0, 5.0)
    humps = [np.exp(-((points[:, 0] - at) ** 2 + points[:, 2] ** 2) / 40.0**2) for at in (-70.0, 70.0)]
    points[:, 1] = -50.0 * (humps[0] + humps[1])
    normals = Mesh(points, faces).vertex_normals
    cloth = bridged(points, faces, normals)
    out = np.einsum("nx,nx->n", cloth - points, normals)
    assert out.min() > -1e-9
    middle = (np.abs(points[:, 0]) < 3.0) & (np.abs(points[:, 2]) < 3.0)
    assert out[middle].min() > 20.0, "the hollow is more than 45 mm deep"
    tops = points[:, 1] < -48.0
    assert out[tops].max() < 0.2
    kept = bridged(points, faces, normals, np.abs(points[:, 0]) > 1000.0)
    np.testing.assert_array_equal(kept, points)
