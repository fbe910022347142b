"""Tapes on the moved body, against sections of the whole moved body."""

from __future__ import annotations

from importlib.resources import files

import numpy as np
import pytest

from core.deformation.incremental_normals import MovingFaces, moving_faces
from core.geometry.mesh import Mesh
from core.landmarks.torso.cross_sections import trunk_levels
from core.pipeline.observables import Tapes
from core.scan.body import read_scan


@pytest.fixture(scope="module", params=["mannequin", "person"])
def moving(request: pytest.FixtureRequest) -> MovingFaces:
    """The faces of a sample's breasts."""
    mesh = read_scan(str(files("resources") / "samples" / f"{request.param}.ply")).mesh
    x, y, z = mesh.vertices.T
    level = mesh.vertices[np.argmin(np.where(np.abs(x) < 150.0, y, 0.0)), 2]
    foremost = (np.abs(x) < 120.0) & (y < np.median(y)) & (np.abs(z - level) < 70.0)
    return moving_faces(mesh, np.flatnonzero(foremost))


def pushed(moving: MovingFaces) -> np.ndarray:
    places = moving.rest.copy()
    random = np.random.default_rng(7)
    places[: moving.count] += random.normal((0.0, 8.0, 9.0), 0.5, size=(moving.count, 3))
    return places


def test_tapes_are_those_of_the_whole_body(moving: MovingFaces) -> None:
    middle = moving.rest[:, 2].mean()
    through_a_vertex = moving.rest[np.argmin(np.abs(moving.rest[:, 2] - middle)), 2]
    heights = [middle - 40.0, middle + 0.123, middle + 35.0, through_a_vertex]
    tapes = Tapes(moving, heights)
    for places in (moving.rest, pushed(moving)):
        vertices = moving.body.vertices.copy()
        vertices[moving.vertices] = places
        whole = Mesh(vertices, moving.body.faces)
        wanted = [trunk_levels(whole, z)[0].tape for z in heights]
        assert tapes(places) == pytest.approx(wanted, abs=1e-6)
    assert np.abs(tapes(pushed(moving)) - tapes(moving.rest)).max() > 3.0


def test_where_there_is_no_body_the_tape_has_no_length(moving: MovingFaces) -> None:
    assert Tapes(moving, [1e5])(moving.rest).tolist() == [0.0]
