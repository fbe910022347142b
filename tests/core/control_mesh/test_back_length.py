"""The back, which completes a line to the whole band."""

import numpy as np
import pytest
from fit_bodies import RADIUS, analytic_body, landmarks_at, sample_of

from core.control_mesh.back_length import back_of
from core.control_mesh.fit import ControlMesh, fit_control_mesh
from core.control_mesh.template import read_template
from core.errors import FitError
from core.geometry.mesh import Mesh
from core.scan.repair.denoise import denoise


def ends_only(points):
    """A control mesh that is nothing but a line from right to left."""
    none = np.empty(0, dtype=np.int64)
    mesh = Mesh(points, np.empty((0, 3), dtype=np.int64))
    return ControlMesh(mesh, none, none, none, {"band": (0, 1)}, (0, 1), (), ())


def tube_ends(degrees, z):
    a = np.radians(degrees)
    return ends_only(RADIUS * np.array([[-np.sin(a), -np.cos(a), 0], [np.sin(a), -np.cos(a), 0]]) + (0, 0, z))


@pytest.mark.parametrize("degrees", [60.0, 80.0, 97.0])
def test_back_of_a_round_trunk_is_the_rest_of_the_circle(degrees):
    length = back_of(analytic_body(), tube_ends(degrees, 200.0), "band").length
    assert length == pytest.approx(RADIUS * 2.0 * np.radians(180.0 - degrees), rel=1e-3)


def test_the_drawn_back_goes_from_the_left_end_round_to_the_right():
    ends = tube_ends(80.0, 200.0)
    ends = ends_only(ends.mesh.vertices + np.array([[0.0, 0.0, -4.0], [0.0, 0.0, 4.0]]))
    path = back_of(analytic_body(), ends, "band").path
    right, left = ends.mesh.vertices
    assert np.array_equal(path[0], left)
    assert np.array_equal(path[-1], right)
    assert np.hypot(*path[:, :2].T) == pytest.approx(RADIUS, rel=2e-3)
    assert path[:, 1].max() == pytest.approx(RADIUS, rel=2e-3)
    assert (np.diff(path[:, 2]) < 0.0).all()  # level, but for the few mm between its ends
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).max() < 6.0


def test_noise_of_the_scanner_does_not_lengthen_the_back():
    mesh = analytic_body()
    noise = np.random.default_rng(3).normal(scale=1.0, size=mesh.vertices.shape)
    length = back_of(denoise(mesh.moved(mesh.vertices + noise)), tube_ends(80.0, 200.0), "band").length
    assert length == pytest.approx(RADIUS * np.radians(200.0), rel=0.01)


def test_hole_in_the_back_is_bridged_straight():
    mesh = analytic_body()
    a = np.degrees(np.arctan2(mesh.vertices[:, 0], mesh.vertices[:, 1]))
    hole = (np.abs(a) < 20.5) & (mesh.vertices[:, 2] > 150.0) & (mesh.vertices[:, 2] < 250.0)
    holed = Mesh(mesh.vertices, mesh.faces[~hole[mesh.faces].any(axis=1)])
    length = back_of(holed, tube_ends(80.0, 200.0), "band").length
    chord = 2.0 * RADIUS * (np.sin(np.radians(22.0)))
    assert length == pytest.approx(RADIUS * np.radians(200.0 - 44.0) + chord, rel=1e-3)


@pytest.mark.parametrize(("name", "girth"), [("mannequin", 891.9), ("person", 931.4)])
def test_line_and_back_make_the_girth_of_the_bust(name, girth):
    # The true contour at the bust; a line bridges the cleavage, the person's bust points stand 12 mm apart.
    body, places = sample_of(name)
    control = fit_control_mesh(read_template("168"), body, landmarks_at(places))
    at = control.mesh.vertices[list(control.paths["full-bust"])]
    front = np.linalg.norm(np.diff(at, axis=0), axis=1).sum()
    assert front + back_of(body.mesh, control, "full-bust").length == pytest.approx(girth, rel=0.02)


def test_back_where_the_scan_has_ended_is_refused():
    with pytest.raises(FitError, match="no surface on the back"):
        back_of(analytic_body(), tube_ends(80.0, 900.0), "band")
