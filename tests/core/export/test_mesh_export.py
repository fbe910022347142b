"""Geometry that leaves the program: other programs must read the same shape."""

import numpy as np
import pytest
import trimesh
from shapes import octahedron, torso

from core.errors import UserError
from core.export.mesh import FORMATS, write_mesh
from core.export.units_and_axes import FileSpace
from core.geometry.mesh import Mesh


@pytest.mark.parametrize("kind", FORMATS)
def test_another_library_reads_the_same_shape(tmp_path, kind):
    mesh = torso().mesh
    path = tmp_path / f"body.{kind}"
    write_mesh(path, mesh, space=FileSpace())
    read = trimesh.load_mesh(path, process=False)
    corners = np.asarray(read.vertices)[np.asarray(read.faces)]
    np.testing.assert_allclose(corners, mesh.vertices[mesh.faces], atol=1e-5)


@pytest.mark.parametrize("kind", ["ply", "obj"])
def test_points_and_triangles_keep_their_numbers(tmp_path, kind):
    mesh = octahedron(12.345678)
    path = tmp_path / f"body.{kind}"
    write_mesh(path, mesh)
    read = trimesh.load_mesh(path, process=False)
    np.testing.assert_array_equal(read.faces, mesh.faces)
    np.testing.assert_allclose(read.vertices, mesh.vertices, atol=1e-5)


def test_a_point_that_no_triangle_uses_is_kept(tmp_path):
    mesh = Mesh(np.vstack([octahedron().vertices, [[9.0, 9.0, 9.0]]]), octahedron().faces)
    write_mesh(tmp_path / "body.ply", mesh)
    assert len(trimesh.load_mesh(tmp_path / "body.ply", process=False).vertices) == 7


def test_the_winding_and_with_it_the_volume_survive(tmp_path):
    write_mesh(tmp_path / "body.stl", octahedron(50.0))
    assert trimesh.load_mesh(tmp_path / "body.stl").volume == pytest.approx(4 / 3 * 50.0**3, rel=1e-6)


def test_the_ending_may_be_in_capitals(tmp_path):
    write_mesh(tmp_path / "BODY.PLY", octahedron())
    assert (tmp_path / "BODY.PLY").read_bytes().startswith(b"ply")


@pytest.mark.parametrize("name", ["body.step", "body", "body.ply.gz"])
def test_other_endings_are_refused_with_a_choice(tmp_path, name):
    with pytest.raises(UserError, match="ply, obj, stl, glb"):
        write_mesh(tmp_path / name, octahedron())
    assert list(tmp_path.iterdir()) == []


def test_a_place_that_cannot_be_written_to_is_named(tmp_path):
    with pytest.raises(UserError, match="cannot be written"):
        write_mesh(tmp_path / "missing" / "body.ply", octahedron())


def test_a_failed_export_leaves_the_old_file_whole(tmp_path, monkeypatch):
    path = tmp_path / "body.ply"
    write_mesh(path, octahedron())
    before = path.read_bytes()

    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", fail)
    with pytest.raises(UserError, match="No space left"):
        write_mesh(path, octahedron(2.0))
    assert path.read_bytes() == before
    assert [found.name for found in tmp_path.iterdir()] == ["body.ply"]
