"""Every format gives the same house, and what no scan is ends in one sentence, soon, in little memory."""

import numpy as np
import pytest
from scan_files import CLOUDS, CORNERS, HOUSES, TRIANGLES, VOLUME

from core.mesh import Mesh
from core.scan_file import read_raw, read_triangles


@pytest.mark.parametrize("name", HOUSES)
def test_every_format_gives_the_house(name):
    vertices, faces = read_triangles(name, HOUSES[name])
    assert vertices.dtype == np.float64
    assert faces.shape == (len(TRIANGLES), 3)
    house = Mesh(vertices, faces)
    assert house.enclosed_volume((1.0, 1.0, 1.0)) == pytest.approx(VOLUME, abs=1e-5)
    found = {tuple(corner) for corner in np.round(vertices, 5).tolist()}
    assert found == {tuple(map(float, corner)) for corner in CORNERS}
    cut = {frozenset(tuple(p) for p in t) for t in np.round(vertices[faces], 5).tolist()}
    if "vtp" not in name:  # its strip runs along the other diagonal
        assert cut == {frozenset(tuple(map(float, CORNERS[k])) for k in t) for t in TRIANGLES}


@pytest.mark.parametrize("name", CLOUDS)
def test_points_without_faces_are_a_cloud(name):
    scan = read_raw(name, CLOUDS[name])
    assert np.array_equal(scan.vertices, np.array(CORNERS, dtype=float))
    assert len(scan.faces) == 0
    with_normals = b"0.8" in CLOUDS[name]
    assert (scan.normals is not None) == with_normals
    if with_normals:
        assert np.allclose(scan.normals, [0.0, 0.6, 0.8])
