"""Bodies in the unit and the axes of other programs, read back by other libraries."""

import json
import struct

import numpy as np
import pytest
import pyvista as pv
import trimesh
from shapes import octahedron

from core.errors import UserError
from core.export.mesh import FORMATS, write_mesh
from core.export.units_and_axes import AXES, UNITS, FileSpace, space_of
from core.geometry.mesh import Mesh
from core.progress import Cancelled

NOSE, CROWN, LEFT = np.array([0.0, -100.0, 0.0]), np.array([0.0, 0.0, 300.0]), np.array([200.0, 0.0, 0.0])


def told(lines: np.ndarray) -> list[list[float]]:
    return np.round(lines, 9).tolist()


@pytest.mark.parametrize(
    ("axes", "front", "up", "left"),
    [
        ("z-up", [0, -1, 0], [0, 0, 1], [1, 0, 0]),
        ("y-up", [0, 0, 1], [0, 1, 0], [1, 0, 0]),
        ("z-up-front-y", [0, 1, 0], [0, 0, 1], [-1, 0, 0]),
    ],
)
def test_front_up_and_left_point_where_the_axes_say(axes, front, up, left):
    space = FileSpace("cm", axes)
    places = space.places(np.stack([NOSE, CROWN, LEFT]))
    assert told(places) == told(np.array([front, up, left]) * [[10.0], [30.0], [20.0]])
    assert told(space.normals(np.array([[0.0, -1.0, 0.0]]))) == [[float(x) for x in front]]


def test_no_axes_turn_the_body_inside_out():
    for axes in AXES:
        corners = FileSpace("mm", axes).places(np.eye(3))
        assert np.linalg.det(corners) == pytest.approx(1.0)


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("unit", UNITS)
def test_another_library_reads_the_size_in_the_unit(tmp_path, kind, unit):
    write_mesh(tmp_path / f"body.{kind}", octahedron(254.0), space=FileSpace(unit, "z-up"))
    read = trimesh.load_mesh(tmp_path / f"body.{kind}", process=False)
    assert read.extents == pytest.approx(2 * 254.0 / UNITS[unit] * np.ones(3), rel=1e-6)
    assert read.volume == pytest.approx(4 / 3 * (254.0 / UNITS[unit]) ** 3, rel=1e-5)


@pytest.mark.parametrize("kind", ["ply", "obj", "stl"])
def test_a_second_library_reads_the_same(tmp_path, kind):
    write_mesh(tmp_path / f"body.{kind}", octahedron(70.0), space=FileSpace("cm", "y-up"))
    read = pv.read(tmp_path / f"body.{kind}")
    assert (read.n_cells, read.volume) == (8, pytest.approx(4 / 3 * 7.0**3, rel=1e-5))


def test_a_glb_is_in_metres_with_y_up_unless_said_otherwise(tmp_path):
    tall = Mesh(octahedron(1.0).vertices * [200.0, 100.0, 850.0], octahedron().faces)
    write_mesh(tmp_path / "body.glb", tall)
    low, high = trimesh.load_mesh(tmp_path / "body.glb").bounds
    assert high - low == pytest.approx([0.4, 1.7, 0.2], rel=1e-6)
    assert (space_of("glb"), space_of("ply")) == (FileSpace("m", "y-up"), FileSpace("mm", "z-up"))
    assert space_of("glb", "mm") == FileSpace("mm", "y-up")


def test_a_glb_is_what_gltf_2_asks_for(tmp_path):
    mesh = octahedron(100.0)
    write_mesh(tmp_path / "body.glb", mesh)
    data = (tmp_path / "body.glb").read_bytes()
    magic, version, length, size, kind = struct.unpack("<4sII I4s", data[:20])
    assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
    told_ = json.loads(data[20 : 20 + size])
    (shape,) = told_["meshes"][0]["primitives"]
    attributes = shape["attributes"]
    matt = told_["materials"][shape["material"]]
    assert matt["pbrMetallicRoughness"]["metallicFactor"] == 0.0, "where nothing is said a body is of metal"
    assert matt["doubleSided"], "what is open is seen from inside too"
    accessor = told_["accessors"][attributes["POSITION"]]
    assert told_["asset"]["version"] == "2.0"
    assert "NORMAL" in attributes
    assert accessor["count"] == len(mesh.vertices)
    assert accessor["max"] == pytest.approx([0.1, 0.1, 0.1])


@pytest.mark.parametrize(("unit", "axes"), [("ell", "z-up"), ("mm", "x-up")])
def test_unknown_units_and_axes_are_refused_with_a_choice(unit, axes):
    with pytest.raises(UserError, match="Choose one of"):
        FileSpace(unit, axes)


@pytest.mark.parametrize("kind", FORMATS)
def test_what_is_stopped_leaves_no_file(tmp_path, kind):
    def stop(_, share):
        if share >= 0.8:
            raise Cancelled

    with pytest.raises(Cancelled):
        write_mesh(tmp_path / f"body.{kind}", octahedron(), stop)
    assert list(tmp_path.iterdir()) == []
