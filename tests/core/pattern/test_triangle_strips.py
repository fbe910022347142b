"""The shortest strip of triangles: as long as the arc between two places of a ball, none over a gap."""

import numpy as np
import pytest
from curved_patches import ball, on_ball

from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Mesh
from core.pattern.triangle_strips import shortest_strip


def ends(mesh: Mesh, angle: float) -> tuple[tuple[int, int], np.ndarray]:
    """Two places of a ball an ``angle`` apart, and their triangles."""
    face, place = nearest_faces(mesh, np.stack([on_ball(20.0, 0.0), on_ball(20.0, angle)]))
    return (int(face[0]), int(face[1])), place


@pytest.mark.parametrize("angle", [2.0, 10.0, 40.0])
def test_a_path_is_hardly_longer_than_the_arc_and_leads_from_triangle_to_triangle(angle: float) -> None:
    mesh = ball()
    faces, places = ends(mesh, angle)
    strip = shortest_strip(mesh, faces, places)
    assert strip is not None
    assert strip.length == pytest.approx(np.radians(angle) * 70.0, rel=0.15)
    assert strip.face[-1] == faces[1]
    entered = np.concatenate([[faces[0]], strip.face])
    for number, edge in enumerate(zip(strip.low.tolist(), strip.high.tolist(), strict=True)):
        for face in entered[number : number + 2]:
            assert set(edge) <= set(mesh.faces[face].tolist())
    assert (strip.low < strip.high).all()


def test_there_is_none_between_parts_that_do_not_hang_together() -> None:
    whole = ball()
    beside = np.abs(whole.vertices[whole.faces].mean(axis=1)[:, 0]) > 6.0
    mesh = Mesh(whole.vertices, whole.faces[beside])
    face, place = nearest_faces(mesh, np.stack([on_ball(90.0, 10.0), on_ball(270.0, 10.0)]))
    assert shortest_strip(mesh, (int(face[0]), int(face[1])), place) is None
