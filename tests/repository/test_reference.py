"""The finite-element model of the reference cases: assembly, inverse problem, garments on a small block."""

from __future__ import annotations

import sys
from dataclasses import replace
from itertools import permutations, product
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

sys.path[:0] = [str(Path(__file__).parents[2] / "benchmarks")]

from reference.bands import Bands, cut  # noqa: E402
from reference.contact import Cup  # noqa: E402
from reference.cup_arrays import cup_arrays, read_cup  # noqa: E402
from reference.elements import quadratic_mesh  # noqa: E402
from reference.sewn import Cloth, strips_of  # noqa: E402
from reference.states import STANDING, LoadedBody  # noqa: E402
from reference.tissue import BULK, GRAVITY, Tissue  # noqa: E402
from reference.underwire import Underwire, Wire  # noqa: E402

from core.geometry.mesh import Mesh  # noqa: E402

SHEAR = 0.5e-3


def block(cells: int = 2, size: float = 40.0) -> Tissue:
    """Return a cube of tissue, six tetrahedra to a cell, whose side x = 0 is fixed."""
    at = np.linspace(0.0, size, cells + 1)
    corners = np.array(list(product(at, at, at)))
    strides = np.array([(cells + 1) ** 2, cells + 1, 1])
    first = np.array(list(product(range(cells), repeat=3))) @ strides
    walks = [np.cumsum([0, *strides[list(order)]]) for order in permutations(range(3))]
    mesh = quadratic_mesh(corners, (first[:, None, None] + np.array(walks)).reshape(-1, 4))
    return Tissue(mesh, mesh.nodes[:, 0] < 1e-9, SHEAR)


def shaken(tissue: Tissue, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return random unloaded nodes, loaded nodes and pressures near the block."""
    rng = np.random.default_rng(seed)
    nodes, count = tissue.mesh.nodes, tissue.mesh.corner_count
    return (
        nodes + rng.normal(0.0, 0.4, nodes.shape),
        nodes + rng.normal(0.0, 0.4, nodes.shape),
        rng.normal(size=count),
    )


def test_weight_is_that_of_the_volume() -> None:
    assert block().weight.sum() == pytest.approx(0.95e-6 * GRAVITY * 40.0**3, rel=1e-12)


def test_uniform_strain_is_exact() -> None:
    tissue = block()
    nodes = tissue.mesh.nodes
    strain = np.array([[1.10, 0.04, 0.02], [0.05, 0.95, 0.03], [0.01, 0.06, 0.97]])
    growth = np.linalg.det(strain)
    shape, pressure = nodes @ strain.T, np.full(tissue.mesh.corner_count, BULK * (growth - 1.0))
    total = tissue.residual(nodes, shape, pressure, np.zeros(3))
    forces = total[: nodes.size].reshape(-1, 3)
    inner = ((nodes > 1e-9) & (nodes < 40.0 - 1e-9)).all(axis=1)
    np.testing.assert_allclose(forces[inner], 0.0, atol=1e-12)
    np.testing.assert_allclose(total[nodes.size :], 0.0, atol=1e-12)
    # virtual work: the moment of the forces is the stress times the volume
    stress = SHEAR / growth * (strain @ strain.T - np.eye(3)) + SHEAR * BULK * (growth - 1.0) * np.eye(3)
    np.testing.assert_allclose(forces.T @ shape, growth * 40.0**3 * stress, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("inverse", [False, True])
def test_tangent_is_the_derivative_of_the_residual(inverse: bool) -> None:
    tissue = block(1)
    original, shape, pressure = shaken(tissue, 1)
    rng = np.random.default_rng(2)
    way, push = rng.normal(size=original.shape), rng.normal(size=pressure.shape)

    def residual(step: float) -> np.ndarray:
        places = (original + step * way, shape) if inverse else (original, shape + step * way)
        return tissue.residual(*places, pressure + step * push, STANDING)

    tangent = tissue.inverse_tangent if inverse else tissue.tangent
    expected = (residual(1e-5) - residual(-1e-5)) / 2e-5
    slope = tangent(original, shape, pressure) @ np.concatenate([way.ravel(), push])
    np.testing.assert_allclose(slope, expected, atol=1e-6 * np.abs(expected).max())


def test_tangent_of_the_loaded_shape_is_symmetric() -> None:
    tissue = block(1)
    matrix = tissue.tangent(*shaken(tissue, 3))
    assert abs(matrix - matrix.T).max() < 1e-12


def test_loading_the_unloaded_shape_returns_to_the_scan() -> None:
    body = LoadedBody(block())
    nodes = body.tissue.mesh.nodes
    assert np.abs(body.unloaded - nodes).max() > 1.0
    assert (body.unloaded[nodes[:, 0] > 39.0, 2] > nodes[nodes[:, 0] > 39.0, 2]).all()
    returned = body.loaded(STANDING, start=body.unloaded)
    np.testing.assert_allclose(returned, nodes, rtol=0.0, atol=1e-6)


def band(nodes: np.ndarray, ratio: float) -> Bands:
    """Return a band from a place in space to the middle of the block's far side."""
    end = int(np.linalg.norm(nodes - [40.0, 20.0, 20.0], axis=1).argmin())
    follow = sparse.csr_array(([1.0], ([1], [end])), shape=(2, len(nodes)))
    rest = np.array([[40.0, 20.0, 60.0], nodes[end]])
    return Bands(rest, nodes, follow, np.array([[0, 1]]), np.array([ratio]), np.array([10.0]))


def wire(nodes: np.ndarray, wider: float = 0.0) -> Underwire:
    """Return a wire on the block's far side, which is ``wider`` across by so much."""
    far = np.flatnonzero(nodes[:, 0] > 39.0)
    follow = sparse.csr_array((np.ones(len(far)), (np.arange(len(far)), far)), shape=(len(far), len(nodes)))
    shape = wider * (nodes[far] - nodes[far].mean(axis=0)) * [0.0, 1.0, 0.0]
    return Underwire(nodes[far], nodes, follow, shape, 10.0)


@pytest.mark.parametrize("kind", ["band", "wire"])
def test_forces_and_stiffness_are_derivatives_of_the_energy(kind: str) -> None:
    nodes = block(1).mesh.nodes
    worn: Bands | Underwire = band(nodes, 0.9) if kind == "band" else wire(nodes, 0.2)
    rng = np.random.default_rng(4)
    moved, way = nodes + rng.normal(0.0, 0.5, nodes.shape), rng.normal(size=nodes.shape)
    ahead, behind = moved + 1e-5 * way, moved - 1e-5 * way
    slope = (worn.energy(ahead) - worn.energy(behind)) / 2e-5
    assert worn.forces(moved, 1.0) @ way.ravel() == pytest.approx(slope, rel=1e-6)
    change = (worn.forces(ahead, 1.0) - worn.forces(behind, 1.0)) / 2e-5
    np.testing.assert_allclose(
        worn.stiffness(moved, 1.0) @ way.ravel(), change, atol=1e-6 * np.abs(change).max()
    )


def test_a_shorter_band_lifts_and_a_longer_one_does_nothing() -> None:
    body = LoadedBody(block(1))
    nodes = body.tissue.mesh.nodes
    shorter, longer = band(nodes, 0.95), band(nodes, 1.05)
    lifted = body.loaded(STANDING, [shorter])
    assert shorter.tension(lifted)[0] > 0.0
    assert shorter.points(lifted)[1, 2] > shorter.points(nodes)[1, 2] + 1.0
    np.testing.assert_allclose(body.loaded(STANDING, [longer]), nodes, rtol=0.0, atol=1e-9)


def turned_by(angle: float) -> np.ndarray:
    """Return the turn about an axis that is not one of the block's."""
    x, y, z = np.array([1.0, 2.0, 3.0]) / 14.0**0.5
    spin = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * spin + (1.0 - np.cos(angle)) * spin @ spin


def test_a_wire_moves_and_turns_freely_by_any_angle_but_keeps_its_form() -> None:
    nodes = block(1).mesh.nodes
    worn = wire(nodes)
    moved = nodes @ turned_by(1.2).T + [5.0, -3.0, 8.0]
    assert worn.energy(moved) < 1e-20
    np.testing.assert_allclose(worn.forces(moved, 1.0), 0.0, atol=1e-12)
    mirrored = nodes * [1.0, -1.0, 1.0] + 0.1 * (nodes - 20.0) * [1.0, 0.0, 1.0]
    assert worn.energy(mirrored) > 100.0  # a mirror image is no rigid motion


def test_a_wider_wire_spreads_the_skin_where_it_is() -> None:
    body = LoadedBody(block(1))
    nodes = body.tissue.mesh.nodes
    worn = wire(nodes, 0.2)
    moved = body.loaded(STANDING, [worn])
    assert worn.energy(nodes) > 100.0 * worn.energy(moved) > 0.0
    form = worn.rest + worn.shape
    apart = [np.linalg.norm(each[:, None] - each, axis=2) for each in (worn.points(moved), form)]
    np.testing.assert_allclose(*apart, atol=0.1)


def test_strips_run_along_rows_and_columns_of_each_side() -> None:
    edges = np.array([[0, 1], [1, 2], [0, 3], [0, 4], [2, 5]])
    row, column = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]), np.array([0.0, 1.0, 2.0, 0.0, 1.0, 2.0])
    strips, level = strips_of(edges, row, column, np.array([1, 1, -1, 1, 1, 0]))
    assert strips.tolist() == [[0, 1], [0, 3]]  # not between cups, nor to bare skin, nor slanting
    assert level.tolist() == [True, False]


def test_cloth_is_as_stiff_as_its_strips_are_wide() -> None:
    at = np.array([[0.0, 0.0], [10.0, 0.0], [20.0, 0.0], [0.0, 30.0], [10.0, 30.0], [20.0, 30.0]])
    faces = np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]])
    mesh = Mesh(np.column_stack([at, np.zeros(6)]), faces)
    strips, level = np.array([[0, 1], [4, 1]]), np.array([True, False])
    cloth = Cloth(0.9, 0.8, 300.0, strips, level)
    assert cloth.ratio.tolist() == [0.9, 0.8]
    # one square lies above the first strip, one on each side of the second
    np.testing.assert_allclose(cloth.stiffness_n(mesh), [0.3 * 15.0, 0.3 * 10.0])


@pytest.mark.parametrize("sewn", [True, False])
def test_a_cup_is_read_as_it_is_written(sewn: bool) -> None:
    rest = Mesh(np.arange(12.0).reshape(4, 3) ** 2, np.array([[0, 1, 2], [0, 2, 3]]))
    cloth = Cloth(0.9, 0.8, 300.0, np.array([[0, 1], [1, 2]]), np.array([True, False]))
    shape = Wire(0.95, np.array([2, 3]), np.array([1, -1]), np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]))
    cup = Cup(1.0, 2.0, 3.0, "half", rest, rest.vertices + 1.0, np.array([1, 1, -1, 0]))
    whole = cup_arrays(replace(cup, cloth=cloth) if sewn else replace(cup, wire=shape))
    read = read_cup(whole)
    assert (read.cloth is None, read.wire is None) == (not sewn, sewn)
    again = cup_arrays(read)
    assert again.keys() == whole.keys()
    for name, array in whole.items():
        np.testing.assert_array_equal(again[name], array)


def test_a_line_is_cut_and_ends_at_the_first_held_point() -> None:
    line = np.array([[0.0, 0.0, z] for z in (0.0, 3.0, 6.0, 9.0, 12.0)])
    places, held = cut(line, np.array([True, True, False, False, True]), 3)
    np.testing.assert_allclose(places[:, 2], np.arange(3.0, 12.5))
    assert np.flatnonzero(held).tolist() == [0, 9]
