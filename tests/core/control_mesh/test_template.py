"""The templates: counts, diagonals, the fixed collar, and data that is refused."""

import json
from importlib import resources

import numpy as np
import pytest

from core.control_mesh.template import TEMPLATES, parse_template, read_template
from core.errors import FitError
from core.geometry.mesh import Mesh


@pytest.fixture(params=TEMPLATES)
def template(request):
    return read_template(request.param)


def data_of(name):
    return json.loads((resources.files("resources") / "templates" / f"{name}.json").read_text("utf-8"))


@pytest.mark.parametrize(
    ("name", "triangles", "points", "free"), [("168", 168, 104, 36), ("120", 120, 77, 21)]
)
def test_counts(name, triangles, points, free):
    template = read_template(name)
    assert template.name == name
    assert len(template.faces) == triangles
    assert len(template.row) == len(template.column) == points
    assert np.array_equal(np.unique(template.faces), np.arange(points))
    assert template.free.sum() == free
    assert np.array_equal(template.fixed, ~template.free)


def test_mirrored_triangles_are_triangles_of_the_template(template):
    mirror = np.array([template.point(r, -c) for r, c in zip(template.row, template.column, strict=True)])
    own = {tuple(np.roll(face, -face.argmin())) for face in template.faces}
    mirrored = {tuple(np.roll(face, -face.argmin())) for face in mirror[template.faces][:, ::-1]}
    assert mirrored == own


def test_diagonals_point_at_the_bust_points(template):
    row = template.row_of("bust point")
    for bust in (template.point(row, template.bust_column), template.point(row, -template.bust_column)):
        assert (template.faces == bust).any(axis=1).sum() == 8
    edges = {tuple(edge) for edge in Mesh(np.zeros((len(template.row), 3)), template.faces).edges.tolist()}
    for step in range(1, min(row, template.bust_column)):
        inner = template.point(row - step, template.bust_column - step)
        assert (inner, template.point(row - step + 1, template.bust_column - step + 1)) in edges


def test_triangles_face_the_viewer_in_front_of_the_body(template):
    flat = Mesh(np.column_stack([template.column, 0 * template.row, template.row]), template.faces)
    np.testing.assert_allclose(flat.face_normals, np.broadcast_to((0.0, -1.0, 0.0), flat.faces.shape))
    assert len(flat.boundary_loops) == 1


def test_outermost_triangles_are_fixed(template):
    border = Mesh(np.zeros((len(template.row), 3)), template.faces).boundary_loops[0]
    outermost = np.isin(template.faces, border).any(axis=1)
    assert template.fixed[template.faces[outermost]].all()
    assert template.free.any()


def test_lines_run_from_right_to_left_between_fixed_points(template):
    assert list(template.paths) == ["under-bust", "mid-bust", "full-bust"]
    for number, path in enumerate(template.paths.values(), start=1):
        assert set(template.row[list(path)]) == {number}
        assert template.column[list(path)].tolist() == list(range(1 - template.half, template.half))
        assert template.fixed[[path[0], path[-1]]].all()
    assert template.fixed[list(template.paths["under-bust"])].all()
    assert template.free[list(template.paths["mid-bust"])[1:-1]].all()


def test_arrays_are_read_only(template):
    for array in (template.faces, template.free, template.fixed, template.row, template.column):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_unknown_name_is_refused():
    with pytest.raises(FitError, match=r"There is no template '\.\./168'.*168, 120"):
        read_template("../168")


def set_column(number, key, value):
    return lambda data: data["columns"][number].update({key: value})


def set_row(number, key, value):
    return lambda data: data["rows"][number].update({key: value})


@pytest.mark.parametrize(
    ("spoil", "why"),
    [
        (lambda data: data.pop("rows"), "KeyError"),
        (lambda data: data.update(columns=7), "TypeError"),
        (lambda data: data["lines"].update({"strap": "shoulder"}), "shoulder"),
        (lambda data: data.update(bust_point_column=7), "in no column"),
        (lambda data: data.update(bust_point_column=2), "does not run through them"),
        (lambda data: data.update(columns=data["columns"][1:], bust_point_column=2), "not the centre"),
        (set_column(2, "fold", "deep"), "fold is none of"),
        (set_column(2, "upper_edge", 0.9), "columns cross"),
        (set_column(4, "azimuth", {"bust_point": 0.9}), "columns cross"),
        (set_column(5, "free", True), "two outermost columns"),
        (set_column(6, "free", True), "two outermost columns"),
        (set_row(1, "free", True), "two lowest"),
        (set_row(6, "free", True), "two highest"),
        (set_row(4, "value", 0.8), "do not rise"),
        (set_row(4, "value", 1.2), "do not rise"),
        (lambda data: data["rows"].reverse(), "rows must be"),
        (lambda data: data["rows"].pop(3), "bust point"),
    ],
)
def test_bad_data_is_refused(spoil, why):
    data = data_of("168")
    spoil(data)
    with pytest.raises(FitError, match=why):
        parse_template(json.dumps(data))


def test_text_that_is_no_json_is_refused():
    with pytest.raises(FitError, match="cannot be used"):
        parse_template("{")
