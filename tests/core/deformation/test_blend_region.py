"""The patch on a sheet, where the fade is known, on scans with holes and pieces, and on the sample bodies."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from importlib.resources import files

import numpy as np
import pytest
from scipy.spatial import cKDTree

from core.control_mesh.fit import ControlMesh, fit_control_mesh
from core.control_mesh.template import read_template
from core.deformation.blend_region import BlendRegion, blend_weights, smooth_step
from core.deformation.tffd import bind, deform
from core.errors import FitError
from core.geometry.mesh import Mesh
from core.landmarks.detect import find_landmarks
from core.pipeline.model_stages import bound
from core.scan.body import Body, read_scan


def grid(xs: np.ndarray, zs: np.ndarray, y: float = 0.0) -> Mesh:
    """A flat sheet of points at all ``xs`` and ``zs`` that faces -y."""
    x, z = np.meshgrid(xs, zs)
    ids = np.arange(x.size).reshape(x.shape)
    a, b, c, d = ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return Mesh(np.stack([x, np.full_like(x, y), z], axis=-1).reshape(-1, 3), faces)


def control_grid(columns: int = 9, rows: int = 6, step: float = 25.0) -> ControlMesh:
    mesh = grid((np.arange(columns) - columns // 2) * step, (np.arange(rows) - 2.0) * step)
    ids = np.arange(rows * columns).reshape(rows, columns)
    row, column = np.divmod(ids.ravel(), columns)
    border = np.concatenate([ids[0, :-1], ids[:-1, -1], ids[-1, :0:-1], ids[:0:-1, 0]])
    fixed = np.isin(ids.ravel(), border)
    bust = int(ids[2, columns // 2 + 2]), int(ids[2, columns // 2 - 2])
    return ControlMesh(mesh, fixed, row, column - columns // 2, {}, bust, (border,), ())


SHEET = grid(np.arange(-200.0, 201.0, 5.0), np.arange(-200.0, 251.0, 5.0))
CONTROL = control_grid()


def inside(points: np.ndarray) -> np.ndarray:
    """Signed distance to the border of CONTROL, positive inside, straight to the nearest side."""
    x, z = points[:, 0], points[:, 2]
    return np.minimum.reduce([x + 100.0, 100.0 - x, z + 50.0, 75.0 - z])


def without(mesh: Mesh, faces: np.ndarray) -> Mesh:
    """The mesh without some faces and without the vertices that then belong to none."""
    kept = mesh.faces[~faces]
    used, renumbered = np.unique(kept, return_inverse=True)
    return Mesh(mesh.vertices[used], renumbered.reshape(-1, 3))


def centres(mesh: Mesh) -> np.ndarray:
    return mesh.vertices[mesh.faces].mean(axis=1)


def test_smooth_step_by_hand():
    t = np.array([-1.0, 0.0, 0.25, 0.5, 1.0, np.inf])
    assert smooth_step(t).tolist() == [0.0, 0.0, 0.15625, 0.5, 1.0, 1.0]


@pytest.mark.parametrize("width", [10.0, 25.0, 40.0])
def test_the_fade_on_a_sheet_is_the_smooth_step_of_the_way_to_the_border(width):
    patch = blend_weights(SHEET, CONTROL, width)
    assert patch.rule == "flood"
    assert str(patch.reason) == ""
    assert patch.fade == pytest.approx(smooth_step(inside(SHEET.vertices) / width), abs=1e-12)


def test_a_hole_within_the_patch_is_no_border():
    hole = np.linalg.norm(centres(SHEET) - [0.0, 0.0, 10.0], axis=1) < 18.0
    scan = without(SHEET, hole)
    patch = blend_weights(scan, CONTROL)
    assert patch.rule == "flood"
    assert len(scan.vertices) < len(SHEET.vertices)
    assert patch.fade == pytest.approx(smooth_step(inside(scan.vertices) / 25.0), abs=1e-12)


def test_a_small_hole_on_the_border_is_walked_round():
    hole = np.linalg.norm(centres(SHEET) - [100.0, 0.0, 10.0], axis=1) < 12.0
    scan = without(SHEET, hole)
    patch = blend_weights(scan, CONTROL)
    assert patch.rule == "flood"
    far = np.linalg.norm(scan.vertices - [100.0, 0.0, 10.0], axis=1) > 45.0
    assert patch.fade[far] == pytest.approx(smooth_step(inside(scan.vertices[far]) / 25.0), abs=1e-12)


CUTS = {
    "a slit through the border": lambda c: (np.abs(c[:, 2] - 12.0) < 6.0) & (c[:, 0] > -150.0),
    "a piece that lies loose": lambda c: np.abs(np.linalg.norm(c - [0.0, 0.0, 12.0], axis=1) - 40.0) < 8.0,
}


@pytest.mark.parametrize("cut", CUTS)
def test_a_broken_scan_fades_by_distance_and_says_so(cut):
    scan = without(SHEET, CUTS[cut](centres(SHEET)))
    patch = blend_weights(scan, CONTROL)
    assert patch.rule == "distance"
    assert str(patch.reason).endswith(".")
    assert patch.fade == pytest.approx(smooth_step(inside(scan.vertices) / 25.0), abs=1e-9)
    assert (patch.fade[inside(scan.vertices) <= 0.0] == 0.0).all()


def test_the_distance_rule_leaves_an_arm_before_the_patch_alone():
    """The arm's near side faces the patch, its far side is beyond reach."""
    near, far = (grid(np.arange(-50.0, 51.0, 5.0), np.arange(-30.0, 61.0, 5.0), y) for y in (-30.0, -90.0))
    broken = without(SHEET, CUTS["a slit through the border"](centres(SHEET)))
    first, second = len(broken.vertices), len(broken.vertices) + len(near.vertices)
    scan = Mesh(
        np.concatenate([broken.vertices, near.vertices, far.vertices]),
        np.concatenate([broken.faces, near.faces[:, ::-1] + first, far.faces + second]),
    )
    patch = blend_weights(scan, CONTROL)
    assert patch.rule == "distance"
    assert patch.fade[first:].max() == 0.0
    assert patch.fade[:first] == pytest.approx(blend_weights(broken, CONTROL).fade, abs=1e-9)


def test_a_fence_that_does_not_close_is_noticed():
    outside = int(np.argmax(CONTROL.column == 0))
    strayed = CONTROL.mesh.vertices.copy()
    strayed[list(CONTROL.bust_points)] = [[180.0, 0.0, 0.0], [-180.0, 0.0, 0.0]]
    control = ControlMesh(
        CONTROL.mesh.moved(strayed),
        CONTROL.fixed,
        CONTROL.row,
        CONTROL.column,
        {},
        (outside, outside),
        CONTROL.borders,
        (),
    )
    assert blend_weights(SHEET, control).rule == "distance"


def test_a_control_mesh_whose_border_triangles_move_is_refused():
    """The points of CONTROL are fixed on the border only."""
    with pytest.raises(FitError, match=r"at the border of the control mesh: [1-9]"):
        bound(SHEET, CONTROL, np.ones(len(SHEET.vertices)), "smooth", False, None)
    two_rings = (np.abs(CONTROL.column) > 2) | (np.abs(CONTROL.row - 2.5) > 1.0)
    collared = replace(CONTROL, fixed=two_rings)
    binding = bound(SHEET, collared, np.ones(len(SHEET.vertices)), "smooth", False, None)
    assert np.array_equal(binding.changes.points, np.flatnonzero(~two_rings))


SAMPLES = pytest.mark.parametrize("name", ["mannequin", "person"])


@cache
def sample(name: str) -> tuple[Body, ControlMesh, BlendRegion]:
    body = read_scan(str(files("resources") / "samples" / f"{name}.ply"))
    control = fit_control_mesh(read_template("168"), body, find_landmarks(body))
    return body, control, blend_weights(body.mesh, control)


def loosened(control: ControlMesh) -> np.ndarray:
    free = ~control.fixed
    moved = control.mesh.vertices.copy()
    moved[free] += np.random.default_rng(2).normal(scale=8.0, size=(free.sum(), 3))
    return moved


def under_free_points(mesh: Mesh, control: ControlMesh) -> np.ndarray:
    return cKDTree(mesh.vertices).query(control.mesh.vertices[~control.fixed])[1]


@SAMPLES
def test_a_sample_floods_and_its_free_points_are_well_inside(name):
    body, control, patch = sample(name)
    assert patch.rule == "flood"
    assert patch.fade[under_free_points(body.mesh, control)].min() == 1.0
    assert 0.1 < (patch.fade > 0.0).mean() < 0.5


@SAMPLES
@pytest.mark.parametrize("weights", ["paper", "smooth"])
def test_nothing_outside_the_patch_of_a_sample_moves(name, weights):
    body, control, patch = sample(name)
    moved = deform(bind(body.mesh, control.mesh, patch.fade, weights), loosened(control))
    still = (moved == body.mesh.vertices).all(axis=1)
    assert still[patch.fade == 0.0].all()
    assert still[body.mesh.vertices[:, 1] > control.mesh.vertices[:, 1].max() + 30.0].all()
    low, high = control.mesh.vertices[:, 2].min() - 15.0, control.mesh.vertices[:, 2].max() + 15.0
    assert still[(body.mesh.vertices[:, 2] < low) | (body.mesh.vertices[:, 2] > high)].all()
    assert np.abs(moved - body.mesh.vertices).max() > 4.0


@SAMPLES
def test_a_wider_fade_is_never_higher_and_neighbours_differ_little(name):
    body, control, patch = sample(name)
    wide = blend_weights(body.mesh, control, 40.0)
    assert (wide.fade <= patch.fade).all()
    assert (wide.fade < patch.fade).any()
    a, b = body.mesh.edges.T
    length = np.linalg.norm(body.mesh.vertices[a] - body.mesh.vertices[b], axis=1)
    # The smooth step is at most 1.5 times as steep as the straight one.
    assert (np.abs(patch.fade[a] - patch.fade[b]) <= 1.5 * length / 25.0 + 1e-12).all()


@SAMPLES
def test_a_mirrored_sample_has_the_same_patch(name):
    body, control, patch = sample(name)
    mirror = np.array([-1.0, 1.0, 1.0])
    mesh, other = (Mesh(m.vertices * mirror, m.faces[:, ::-1]) for m in (body.mesh, control.mesh))
    mirrored = ControlMesh(
        other,
        control.fixed,
        control.row,
        -control.column,
        {},
        control.bust_points[::-1],
        tuple(loop[::-1] for loop in control.borders),
        (),
    )
    assert np.abs(blend_weights(mesh, mirrored).fade - patch.fade).max() < 1e-9


@SAMPLES
def test_a_punched_sample_still_has_a_patch(name):
    body, control, patch = sample(name)
    spot = control.mesh.vertices[control.border_points[5]]
    scan = without(body.mesh, np.linalg.norm(centres(body.mesh) - spot, axis=1) < 60.0)
    punched = blend_weights(scan, control)
    assert punched.rule == "distance"
    assert punched.fade[under_free_points(scan, control)].min() == pytest.approx(1.0)
    assert (punched.fade > 0.0).sum() < (patch.fade > 0.0).sum()
