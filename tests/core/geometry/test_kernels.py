"""The loops: compiled and defined forms agree, run as they are too, and change over only as a whole."""

from __future__ import annotations

import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest

from core.geometry import kernels
from core.geometry.mesh import Mesh

RANDOM = np.random.default_rng(6)
POINTS = RANDOM.normal((0.0, -200.0, 1100.0), 80.0, size=(70, 3))
CORNERS = np.stack([RANDOM.permutation(70)[:3] for _ in range(120)], axis=1)
LEFT = RANDOM.random(120) < 0.4
STILL = RANDOM.normal(scale=500.0, size=(70, 3))


def tables(dtype: type) -> tuple[np.ndarray, ...]:
    """Five groups over 60 of 70 rows, with 4 to 9 of 20 columns; one group has no column, one no row."""
    sizes = [(0, 0, 0), (11, 4, 44), (1, 9, 9), (30, 0, 0), (0, 3, 0), (18, 7, 126)]
    starts = np.cumsum(sizes, axis=0)
    columns = np.concatenate([RANDOM.permutation(20)[:count] for _, count, _ in sizes[1:]])
    weights = RANDOM.normal(size=starts[-1, 2]).astype(dtype)
    return weights, starts, columns, RANDOM.normal(scale=9.0, size=(20, 3)), POINTS


def matrix(weights, starts, columns, *_) -> np.ndarray:
    whole = np.zeros((70, 20))
    for (r, c, w), (s, d, _) in pairwise(starts):
        for j in range(r, s):
            for i in range(c, d):
                whole[j, columns[i]] += weights[w + (i - c) * (s - r) + j - r]
    return whole


@pytest.fixture(params=["defined", "compiled"])
def form(request, monkeypatch):
    """Run a test in both forms; the compiled one only where numba is installed."""
    if request.param == "compiled":
        pytest.importorskip("numba")
        monkeypatch.setattr(kernels, "_forms", kernels._Forms())
        assert kernels.warm(), kernels.state()
        assert kernels.state() == "compiled"
    else:
        monkeypatch.setattr(kernels, "_forms", kernels._Forms())
        assert kernels.state().startswith("numpy")
    return request.param


@pytest.mark.parametrize(("dtype", "error"), [(np.float64, 1e-12), (np.float32, 1e-5)])
def test_blend_adds_a_matrix_product(form, dtype, error):
    given = tables(dtype)
    wanted = POINTS + matrix(*given) @ given[3]
    assert np.abs(kernels.blend(*given) - wanted).max() < error
    assert np.array_equal(kernels.blend(*given)[60:], POINTS[60:])


def test_blend_of_no_change_is_rest_bit_for_bit(form):
    for dtype in (np.float32, np.float64):
        *given, change, rest = tables(dtype)
        assert np.array_equal(kernels.blend(*given, 0.0 * change, rest), rest)


def test_blend_of_nothing(form):
    none = np.empty(0, dtype=np.int64)
    given = np.empty(0), np.zeros((1, 3), dtype=np.int64), none, np.empty((0, 3)), POINTS
    assert np.array_equal(kernels.blend(*given), POINTS)


def test_normals_are_the_mesh_s(form):
    mesh = Mesh(POINTS, CORNERS.T)
    whole = kernels.normals(POINTS, CORNERS, np.zeros_like(POINTS))
    assert np.abs(whole - mesh.vertex_normals).max() < 1e-12
    assert np.abs(np.linalg.norm(kernels.normals(POINTS, CORNERS, STILL), axis=1) - 1.0).max() < 1e-14
    some = np.ascontiguousarray(CORNERS[:, :60])
    part = kernels.normals(POINTS, some, 2.0 * _summed_areas(mesh, slice(60, None)))
    assert np.abs(part - whole).max() < 1e-9


def _summed_areas(mesh: Mesh, faces: slice) -> np.ndarray:
    sums = np.zeros_like(mesh.vertices)
    np.add.at(sums, mesh.faces[faces], mesh.area_vectors[faces][:, None])
    return sums


def test_a_normal_that_cancels_is_zero_and_a_lost_point_stays_lost(form):
    points = POINTS.copy()
    points[CORNERS[0, 0]] = np.nan
    found = kernels.normals(points, CORNERS[:, :1].copy(), np.zeros_like(points))
    assert np.isnan(found[CORNERS[:, 0]]).all()
    assert (np.delete(found, CORNERS[:, 0], axis=0) == 0.0).all()


def test_cones_add_up_to_the_volume(form):
    both = kernels.cones(POINTS, CORNERS, LEFT)
    assert both.sum() == pytest.approx(Mesh(POINTS, CORNERS.T).enclosed_volume(), rel=1e-9)
    assert both[0] == pytest.approx(Mesh(POINTS, CORNERS[:, LEFT].T).enclosed_volume(), rel=1e-9)
    tetrahedron = np.array([[0.0, 0, 1], [1, 0, 1], [0, 2, 1]])
    assert kernels.cones(tetrahedron, np.array([[0], [1], [2]]), np.array([False])).tolist() == [0.0, 1 / 3]


def test_the_loops_as_written_agree_with_the_definitions():
    """They are run as plain Python, so that this holds where there is no numba as well."""
    for dtype, error in ((np.float64, 1e-9), (np.float32, 1e-6)):
        *given, change, rest = tables(dtype)
        change = change.astype(dtype)
        result = rest.copy()
        kernels.blend_loop(*given, change, result)
        assert result == pytest.approx(kernels.blend_plain(*given, change, rest), rel=error)
    result = np.empty_like(POINTS)
    kernels.normals_loop(POINTS, CORNERS, STILL, result)
    assert result == pytest.approx(kernels.normals_plain(POINTS, CORNERS, STILL), rel=1e-9, abs=1e-12)
    result = np.zeros(2)
    kernels.cones_loop(POINTS, CORNERS, LEFT, result)
    assert result == pytest.approx(kernels.cones_plain(POINTS, CORNERS, LEFT), rel=1e-9)


def test_what_goes_wrong_leaves_the_definitions_and_is_told(monkeypatch):
    monkeypatch.setattr(kernels, "_forms", kernels._Forms())
    monkeypatch.setattr(kernels, "_compiled", lambda: 1 / 0)
    assert not kernels.warm()
    assert kernels.state() == "numpy: ZeroDivisionError, division by zero"
    assert np.isfinite(kernels.blend(*tables(np.float32))).all()


def test_numba_is_not_read_before_it_is_asked_for():
    """It takes about a second, which no first picture has."""
    program = "import sys, core.pipeline.build, core.geometry.kernels; sys.exit('numba' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
