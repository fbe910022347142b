"""The tensegric model: force densities, self-balance at rest, local balance under a load."""

import numpy as np
import pytest
from scipy import sparse
from shapes import string, tent, torso

from core.mechanics.springs import incidence_of, laplacian
from core.mechanics.tensegrity import tensegrity_model


def test_force_densities_are_inverse_lengths_with_mean_one():
    control = torso()
    model = tensegrity_model(control.mesh, np.zeros(len(control.fixed), dtype=bool))
    length = np.linalg.norm(model.rest[model.cables[:, 0]] - model.rest[model.cables[:, 1]], axis=1)
    assert model.density.mean() == pytest.approx(1.0, abs=1e-14)
    np.testing.assert_allclose(model.density * length, (model.density * length)[0], rtol=1e-13)


def test_the_tent_by_hand():
    mesh, fixed = tent(height=2.0)
    model = tensegrity_model(mesh, fixed)
    side, ridge = 1 / 8, 1 / 6  # sides of 8 mm, four cables of sqrt(16 + 16 + 4) = 6 mm to the tip
    mean = (4 * side + 4 * ridge) / 8
    assert model.free.tolist() == [4]
    assert len(model.cables) == 4
    np.testing.assert_allclose(model.density, ridge / mean)
    np.testing.assert_allclose(model.stiffness, [[4 * ridge / mean]])
    assert model.mean_stiffness == pytest.approx(4 * ridge / mean)


def test_stiffness_of_a_string_by_hand():
    np.testing.assert_allclose(string().stiffness, [[1.5, -0.5], [-0.5, 0.75]])


def test_a_load_on_a_string_is_balanced_by_its_three_cables():
    model = string()
    load = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    moved = np.linalg.solve(model.stiffness, load)
    # By hand: K^-1 of [[3/2, -1/2], [-1/2, 3/4]] is [[6/7, 4/7], [4/7, 12/7]].
    np.testing.assert_allclose(moved[:, 2], [6 / 7, 4 / 7], rtol=1e-14)
    reaction_left, reaction_right = 1.0 * moved[0, 2], 0.25 * moved[1, 2]
    assert reaction_left + reaction_right == pytest.approx(1.0)


def test_prestress_balances_every_free_point_at_rest():
    """Cables of tension q |e| plus the pseudo-force sum of q E leave no force at rest, by construction.

    The displaced model must feel exactly q (e - E) summed: the stiffness times the displacement.
    """
    control = torso()
    model = tensegrity_model(control.mesh, control.fixed)
    moved = np.random.default_rng(1).normal(size=(len(model.free), 3))
    points = model.expand(moved)
    force = np.zeros_like(points)
    for (i, j), q in zip(model.cables, model.density, strict=True):
        change = q * ((points[i] - points[j]) - (model.rest[i] - model.rest[j]))
        force[i] += change
        force[j] -= change
    np.testing.assert_allclose(model.stiffness @ moved, force[model.free], atol=1e-12)


def test_the_stiffness_is_symmetric_and_positive():
    control = torso()
    stiffness = tensegrity_model(control.mesh, control.fixed).stiffness
    np.testing.assert_array_equal(stiffness, stiffness.T)
    assert np.linalg.eigvalsh(stiffness)[0] > 0.01


def test_the_stiffness_agrees_with_a_graph_library():
    control = torso()
    model = tensegrity_model(control.mesh, control.fixed)
    n = len(model.rest)
    graph = sparse.coo_array((model.density, tuple(model.cables.T)), shape=(n, n))
    whole = sparse.csgraph.laplacian((graph + graph.T).tocsr()).toarray()
    np.testing.assert_allclose(model.stiffness, whole[np.ix_(model.free, model.free)], atol=1e-13)


def test_only_cables_that_can_move_are_kept():
    control = torso()
    model = tensegrity_model(control.mesh, control.fixed)
    assert (~control.fixed[model.cables]).any(axis=1).all()
    assert model.free.tolist() == np.flatnonzero(~control.fixed).tolist()
    assert len(model.free) == 36


def test_expanding_moves_the_free_points_alone():
    model = string()
    points = model.expand(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 2.0]]))
    np.testing.assert_array_equal(points, [[0, 0, 0], [1, 1, 0], [3, 0, 2], [7, 0, 0]])
    np.testing.assert_array_equal(model.rest[1], [1, 0, 0])
    assert model.place.tolist() == [-1, 0, 1, -1]


def test_incidence_drops_fixed_ends():
    place = np.array([-1, 0, 1, -1])
    signs = incidence_of(place, np.array([[0, 1], [1, 2], [2, 3], [0, 3]]))
    np.testing.assert_array_equal(signs.toarray(), [[-1, 0], [1, -1], [0, 1], [0, 0]])
    np.testing.assert_array_equal(
        laplacian(place, np.array([[1, 2]]), np.array([2.0])).toarray(), [[2.0, -2.0], [-2.0, 2.0]]
    )
