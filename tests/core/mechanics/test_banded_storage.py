"""Band storage beside full matrices: every way in and out, on random patterns."""

import numpy as np
import pytest
from models import small
from scipy import sparse
from shapes import mid_bust, torso

from core.mechanics.banded_matrix import Band, Entries, band_of, compact, joined, member_entries
from core.mechanics.exact_solution import solve_exact
from core.mechanics.hessian_layout import sliding_entries
from core.mechanics.model import constrained_model
from core.mechanics.options import ModelOptions

SEEDS = pytest.mark.parametrize("seed", range(6))


def scattered(seed, count=14, pairs=24):
    """Random pairs of free points, some with a fixed end (-1), and a band in which they lie near."""
    rng = np.random.default_rng(seed)
    first, second = rng.integers(-1, count, (2, pairs))
    kept = first != second
    first, second = first[kept], second[kept]
    return rng, first, second, band_of(count, first, second)


def signs_of(first, second, count=14):
    """What makes the members' vectors of the free points: +1 at the first end, -1 at the second."""
    signs = np.zeros((len(first), count))
    for end, sign in ((first, 1.0), (second, -1.0)):
        signs[np.flatnonzero(end >= 0), end[end >= 0]] = sign
    return signs


def symmetric(rng, first, second, band):
    """A random symmetric matrix with blocks at the pairs, full and as lower band."""
    blocks = rng.normal(size=(len(first), 3, 3))
    blocks = blocks + np.swapaxes(blocks, 1, 2)
    full = np.zeros((band.size, band.size))
    for i, j, block in zip(first, second, blocks, strict=True):
        for a, b, sign in ((i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)):
            if a >= 0 and b >= 0:
                full[3 * a : 3 * a + 3, 3 * b : 3 * b + 3] += sign * block
    lower = band.lower(member_entries(signs_of(first, second))) @ blocks.ravel()
    return full, lower


def shifted(band, by):
    """``by`` times the unit matrix, as lower band."""
    at = np.arange(band.size)
    return band.lower(Entries(at, at, np.zeros_like(at), np.full(band.size, by), 1)) @ np.ones(1)


@SEEDS
def test_blocks_of_pairs_land_where_they_should(seed):
    rng, first, second, band = scattered(seed)
    full, lower = symmetric(rng, first, second, band)
    np.testing.assert_allclose(band.full(lower), full, atol=1e-14)


@SEEDS
def test_cholesky_solves_and_tells_what_is_not_positive(seed):
    rng, first, second, band = scattered(seed)
    full, lower = symmetric(rng, first, second, band)
    least = np.linalg.eigvalsh(full)[0]
    right = rng.normal(size=(band.size, 3))
    solve = band.cholesky(lower + shifted(band, 1.0 - least))
    expected = np.linalg.solve(full + (1.0 - least) * np.eye(band.size), right)
    np.testing.assert_allclose(solve(right), expected, atol=1e-11)
    np.testing.assert_allclose(solve(right[:, 0]), expected[:, 0], atol=1e-11)
    assert band.cholesky(lower + shifted(band, -least - 1e-3)) is None


@SEEDS
def test_a_general_matrix_is_solved_with_pivots(seed):
    rng, first, second, band = scattered(seed)
    segment, point, _ = sparse.find(sparse.csr_array(signs_of(first, second)))
    blocks = rng.normal(size=(len(point), 3, 3))
    full = np.zeros((band.size, band.size))
    for s, i, block in zip(segment, point, blocks, strict=True):
        for j, sign in ((first[s], 1.0), (second[s], -1.0)):
            if j >= 0:
                own = 1.0 if i == first[s] else -1.0
                full[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] += own * sign * block
    general = band.general(sliding_entries(signs_of(first, second))) @ blocks.ravel()
    general = general + band.spread(shifted(band, 1e-3))  # small on the diagonal: pivots are needed
    full = full + 1e-3 * np.eye(band.size)
    right = rng.normal(size=(band.size, 2))
    found = band.lu(general)(right)
    np.testing.assert_allclose(full @ found, right, atol=1e-8 * np.abs(found).max())


def test_a_singular_matrix_has_no_solver():
    band = band_of(3, np.array([0, 1]), np.array([1, 2]))
    assert band.lu(band.spread(shifted(band, 0.0))) is None
    assert band.cholesky(shifted(band, 0.0)) is None


@SEEDS
def test_a_lower_band_spreads_to_the_same_matrix(seed):
    rng, first, second, band = scattered(seed)
    full, lower = symmetric(rng, first, second, band)
    shift = 1.0 + np.abs(full).sum(axis=1).max()
    inverse = band.lu(band.spread(lower + shifted(band, shift)))(np.eye(band.size))
    np.testing.assert_allclose(inverse, np.linalg.inv(full + shift * np.eye(band.size)), atol=1e-13)


@SEEDS
def test_no_pair_lies_outside_the_band_and_the_order_helps(seed):
    _, first, second, band = scattered(seed, count=60, pairs=40)
    assert sorted(band.place.tolist()) == list(range(band.size))
    both = (first >= 0) & (second >= 0)
    far = np.abs(band.place[3 * first[both]] - band.place[3 * second[both]])
    assert far.max() + 2 <= band.reach
    assert band.reach < 3 * np.abs(first - second).max()


def test_a_chain_in_any_order_is_narrow():
    order = np.random.default_rng(4).permutation(50)
    band = band_of(50, order[:-1], order[1:])
    assert band.reach == 5  # neighbours, three coordinates each


def test_entries_at_the_same_place_add_up():
    band = Band(np.arange(6), 5)
    entry = Entries(np.array([4]), np.array([1]), np.array([0]), np.array([2.0]), 1)
    lower = band.lower(joined([entry, entry], 1)) @ np.array([3.0])
    expected = np.zeros((6, 6))
    expected[4, 1] = expected[1, 4] = 12.0
    np.testing.assert_array_equal(band.full(lower), expected)


def test_a_small_matrix_is_kept_full_and_a_large_one_sparse():
    assert isinstance(compact(sparse.csr_array(np.eye(36))), np.ndarray)
    assert sparse.issparse(compact(sparse.eye_array(300, format="csr")))


@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_the_order_of_the_coordinates_is_irrelevant_to_the_answer(contact, monkeypatch):
    choice = ModelOptions(line_contact=contact)
    one = solve_exact(small(choice, worn=("mid-bust",)), (1.0, 0.95, 1.0))

    def plain(count, first, second):
        return Band(np.arange(3 * count), 3 * count - 1)  # as they come, in a band as wide as the matrix

    monkeypatch.setattr("core.mechanics.hessian_layout.band_of", plain)
    model = constrained_model(torso(skew=0.3), worn=["mid-bust"], mechanics=choice)
    assert model.layout.band.reach == model.layout.band.size - 1
    other = solve_exact(model, mid_bust(model, 0.95))
    monkeypatch.undo()
    same = constrained_model(torso(skew=0.3), worn=["mid-bust"], mechanics=choice)
    assert same.layout.band.reach < 30
    np.testing.assert_allclose(
        other.state.moved, solve_exact(same, mid_bust(same, 0.95)).state.moved, atol=1e-10
    )
    assert one.is_converged


@SEEDS
def test_indefinite_matrices_are_solved_and_their_negative_directions_counted(seed):
    rng, first, second, band = scattered(seed)
    full, lower = symmetric(rng, first, second, band)
    full, lower = full + 0.1 * np.eye(band.size), lower + shifted(band, 0.1)
    solve, negative = band.indefinite(lower)
    right = rng.normal(size=(band.size, 3))
    np.testing.assert_allclose(full @ solve(right), right, atol=1e-8)
    assert negative == (np.linalg.eigvalsh(full) < 0.0).sum() > 0
    assert band.indefinite(np.zeros(len(lower))) is None
