"""Pieces laid flat: known developments, the exact least of the same work, slopes, ease, folds."""

import numpy as np
import pytest
from curved_patches import EVEN, LACE, PlainCloth, ball, cap, circle, cone, cylinder, loop, on_ball, sheet
from scipy.linalg import null_space
from scipy.spatial import cKDTree
from scipy.spatial.distance import pdist
from slopes import slope

from core.geometry.mesh import half_edges
from core.pattern.cloth_energy import ClothState, stiffness_matrix
from core.pattern.flattening import (
    FlatProblem,
    HeldSolver,
    crosses_itself,
    flatten,
    flatten_all,
    strain_summary,
)
from core.pattern.panel import PanelSeed, cut_panels
from core.pattern.surface_cut import cut_surface

CORNERS = [(-60.0, -45.0), (65.0, -50.0), (50.0, 40.0), (-55.0, 50.0)]


def developable(place, up=(0.0, 0.0, 1.0), turn=0.0):
    """A panel of a sheet, and where its points are in the sheet."""
    mesh = sheet(place, 180.0, 150.0)
    flat = sheet(lambda u, v: (u, v, 0.0 * u), 180.0, 150.0).vertices
    cut = cut_surface(mesh, tuple(loop("side", place, CORNERS)))
    seed = PanelSeed("piece", np.stack(place(np.zeros(1), np.zeros(1)), axis=1)[0], turn=turn)
    (panel,) = cut_panels(cut, (seed,), 5.0, up)
    return mesh, panel, (panel.mix @ flat)[:, :2]


@pytest.mark.parametrize(("place", "off"), [(cylinder, 0.1), (cone, 0.1)])
def test_a_developable_surface_is_its_development(place, off):
    mesh, panel, expected = developable(place)
    piece = flatten(panel, panel.places(mesh.vertices), EVEN)
    assert np.abs(piece.largest).max() < 1e-4
    assert np.abs(pdist(piece.points) - pdist(expected)).max() < off


def test_the_grain_line_is_up_on_the_body_or_turned_from_it():
    for turn in (0.0, 30.0, -90.0):
        mesh, panel, expected = developable(cylinder, turn=turn)
        piece = flatten(panel, panel.places(mesh.vertices), LACE)
        angle = np.radians(turn)
        back = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        placed = (piece.worn - piece.worn.mean(axis=0)) @ back.T
        np.testing.assert_allclose(placed, expected - expected.mean(axis=0), atol=0.1)


def test_the_grain_line_of_a_panel_that_lies_level_is_its_length():
    place = lambda u, v: (u, v, -0.002 * v**2)  # noqa: E731 (as a gusset, it falls to both ends)
    mesh, panel, expected = developable(place)
    piece = flatten(panel, panel.places(mesh.vertices), EVEN)
    off = expected - expected.mean(axis=0)
    longest = np.linalg.eigh(off.T @ off)[1][:, 1]
    along = (piece.points - piece.points.mean(axis=0))[:, 1]
    assert abs(np.corrcoef(along, off @ longest)[0, 1]) > 0.99


def exact_cap(angle, poisson, radius=70.0, count=2000):
    """Radius of the edge [mm] and stretch at the pole of the flat cap of least work, by its 1D equation."""
    phi = np.linspace(0.0, np.radians(angle), count + 1)
    middle, step = 0.5 * (phi[1:] + phi[:-1]), np.diff(phi)
    rows = np.arange(count)
    along, across = np.zeros((count, count + 1)), np.zeros((count, count + 1))
    along[rows, rows], along[rows, rows + 1] = -1.0 / (radius * step), 1.0 / (radius * step)
    across[rows, rows] = across[rows, rows + 1] = 0.5 / (radius * np.sin(middle))
    weight = (np.sin(middle) * step)[:, None]
    matrix = along.T @ (weight * along) + across.T @ (weight * across)
    matrix += poisson * (along.T @ (weight * across) + across.T @ (weight * along))
    pull = ((1.0 + poisson) * weight * (along + across)).sum(axis=0)
    far = np.linalg.solve(matrix[1:, 1:], pull[1:])
    return far[-1], radius * phi[1] / far[0] - 1.0


@pytest.mark.parametrize("angle", [20.0, 30.0, 45.0, 60.0])
def test_a_cap_of_a_ball_is_the_exact_least_of_the_same_work(angle):
    panel = cap(angle)
    piece = flatten(panel, panel.places(ball().vertices), EVEN)
    edge, pole = exact_cap(angle, 0.3)
    rim = piece.points[piece.outline]
    far = np.linalg.norm(rim - rim.mean(axis=0), axis=1)
    assert far.mean() == pytest.approx(edge, abs=0.05)
    places = panel.places(ball().vertices)
    cosine = -places[piece.outline, 1] / np.linalg.norm(places[piece.outline], axis=1)
    assert np.ptp(far - 70.0 * np.arccos(cosine)) < 0.1  # the rim takes vertices of the skin that are near
    places = places[panel.faces].mean(axis=1)
    near = np.argsort(np.linalg.norm(places - on_ball(0.0, 0.0), axis=1))[:6]
    assert piece.strains[near, :2].mean() == pytest.approx(pole, abs=5e-4)
    assert not piece.is_folded
    assert not piece.overlaps


def random_states(count=6):
    rng = np.random.default_rng(3)
    return np.eye(2) + 0.25 * rng.normal(size=(count, 2, 2)), rng.normal(size=(count, 2, 2))


def test_slope_and_curvature_of_the_work_are_its_derivatives():
    jacobian, way = random_states()
    stiffness = np.repeat(stiffness_matrix(LACE)[None], len(way), axis=0)
    state = ClothState.of(jacobian, stiffness)
    rotation = np.moveaxis(np.array([[state.cosine, -state.sine], [state.sine, state.cosine]]), 2, 0)
    turned = way @ rotation.transpose(0, 2, 1)
    first = slope(lambda at: ClothState.of(jacobian + at * way, stiffness).density, 1e-3)
    np.testing.assert_allclose((state.slope() * turned).sum(axis=(1, 2)), first, rtol=1e-6)

    def slope_at(at):
        moved = ClothState.of(jacobian + at * way, stiffness)
        back = np.moveaxis(np.array([[moved.cosine, -moved.sine], [moved.sine, moved.cosine]]), 2, 0)
        return (moved.slope() * (way @ back.transpose(0, 2, 1))).sum(axis=(1, 2))

    flat = turned.reshape(-1, 4)
    second = np.einsum("mi,mij,mj->m", flat, state.curvature(stiffness), flat)
    np.testing.assert_allclose(second, slope(slope_at, 1e-3), rtol=1e-6)


def test_slope_and_matrix_of_a_piece_are_derivatives_of_its_work():
    panel = cap(45.0)
    problem = FlatProblem.of([panel], [panel.places(ball().vertices)], [LACE])
    rng = np.random.default_rng(5)
    flat = problem.joined(None)
    way = rng.normal(size=flat.shape)
    state = problem.state(flat)
    turned = problem.turned_slopes(state)
    pull = problem.slope(state, turned)
    assert (pull * way).sum() == pytest.approx(
        float(slope(lambda at: problem.work(problem.state(flat + at * way))[0], 1e-3)), rel=1e-6
    )

    def pull_at(at):
        moved = problem.state(flat + at * way)
        return (problem.slope(moved, problem.turned_slopes(moved)) * way).sum()

    local = way[problem.faces].reshape(-1, 6)
    second = np.einsum("mi,mij,mj->", local, problem.blocks(state, turned), local)
    assert second == pytest.approx(float(slope(pull_at, 1e-3)), rel=1e-6)


def test_no_neighbouring_piece_has_less_work():
    panel = cap(45.0)
    problem = FlatProblem.of([panel], [panel.places(ball().vertices)], [LACE])
    flat = problem.minimum(problem.joined(None))
    least = problem.work(problem.state(flat))[0]
    rng = np.random.default_rng(6)
    grain = panel.grain / np.linalg.norm(panel.grain)
    for _ in range(10):
        step = 0.05 * rng.normal(size=flat.shape)
        step[:, 0] -= (grain @ step[:, 0]) * grain  # the grain line stays up
        assert problem.work(problem.state(flat + step))[0] > least


def test_ease_divides_lengths_by_direction():
    mesh, panel, _ = developable(cylinder)
    places = panel.places(mesh.vertices)
    slack = flatten(panel, places, PlainCloth())
    tight = flatten(panel, places, PlainCloth(ease=(0.2, 0.05)))
    np.testing.assert_allclose(tight.points * [1.2, 1.05], slack.points, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(tight.totals, [[0.2, 0.05]] * len(panel.faces), atol=2e-4)


def test_strains_are_worn_by_flat_lengths_less_one():
    panel = cap(60.0)
    places = panel.places(ball().vertices)
    piece = flatten(panel, places, LACE)
    sides = half_edges(panel.faces)
    worn, flat = (np.linalg.norm(at[sides[:, 0]] - at[sides[:, 1]], axis=1) for at in (places, piece.worn))
    way = (piece.worn[sides[:, 1]] - piece.worn[sides[:, 0]]) / flat[:, None]
    x, y, xy = np.tile(piece.strains.T, 3)
    # To first order the strain along a side; the second order is that of the strains, some 10 %.
    along = x * way[:, 0] ** 2 + y * way[:, 1] ** 2 + 2.0 * xy * way[:, 0] * way[:, 1]
    assert np.abs(worn / flat - 1.0 - along).max() < 0.02
    summary = strain_summary(piece, 0.05)
    amount = np.abs(piece.largest)
    assert summary.within == pytest.approx(np.quantile(amount, 0.95), abs=0.01)
    assert summary.over == pytest.approx(piece.areas[amount > 0.05].sum() / piece.areas.sum())
    assert summary.compressed <= 0.0 <= summary.stretched


def test_a_stiffer_direction_is_strained_less():
    panel = cap(60.0)
    places = panel.places(ball().vertices)
    even, stiff = (flatten(panel, places, cloth) for cloth in (EVEN, PlainCloth((1.0, 10.0, 0.35))))
    work = [(piece.strains[:, 1] ** 2 * piece.areas).sum() for piece in (even, stiff)]
    assert work[1] < 0.6 * work[0]


def test_a_warm_start_finds_the_same_piece():
    panel = cap(60.0)
    skin = ball().vertices
    moved = skin + 3.0 * np.sin(skin[:, [2, 0, 1]] / 25.0)
    places = panel.places(moved)
    before = flatten(panel, panel.places(skin), LACE)
    warm, cold = flatten(panel, places, LACE, before.worn), flatten(panel, places, LACE)
    np.testing.assert_allclose(warm.points, cold.points, atol=1e-3)


def test_pieces_flattened_at_once_are_those_flattened_alone():
    panels = [cap(30.0), cap(60.0)]
    places = [panel.places(ball().vertices) for panel in panels]
    for piece, panel, at in zip(flatten_all(panels, places, [LACE, EVEN]), panels, places, strict=True):
        alone = flatten(panel, at, LACE if panel is panels[0] else EVEN)
        np.testing.assert_allclose(piece.points, alone.points, atol=1e-3)


def test_a_mirrored_ball_gives_the_mirrored_piece():
    skin = ball()
    panel = cap(60.0)
    mirrored = type(skin)(skin.vertices * [-1.0, 1.0, 1.0], skin.faces[:, ::-1])
    curve = circle(60.0)
    other = type(curve)(curve.name, curve.points * [-1.0, 1.0, 1.0])
    seed = PanelSeed("cap", on_ball(-10.0, 3.0))
    (twin,) = cut_panels(cut_surface(mirrored, (other,)), (seed,), 5.0)
    one, two = (
        flatten(each, each.places(body.vertices), LACE).points
        for each, body in ((panel, skin), (twin, mirrored))
    )
    assert cKDTree(one).query(two * [-1.0, 1.0])[0].max() < 1e-6


def test_an_outline_that_crosses_itself_is_found():
    square = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
    assert not crosses_itself(square)
    assert crosses_itself(square[[0, 2, 1, 3]])


@pytest.mark.parametrize("less", [0.0, 0.02, 0.2])
def test_a_held_matrix_is_solved_exactly_whether_or_not_it_is_positive(less):
    panel = cap(30.0)
    problem = FlatProblem.of([panel], [panel.places(ball().vertices)], [LACE])
    state = problem.state(panel.start)
    (lower,) = problem.lowers(problem.blocks(state, problem.turned_slopes(state)))
    lower[panel.band.diagonal] -= less * np.abs(lower[panel.band.diagonal]).mean()
    matrix, count = panel.band.band.full(lower), len(panel.start)
    conditions = np.zeros((3, 2 * count))
    conditions[0, ::2] = conditions[1, 1::2] = 1.0
    conditions[2, ::2] = panel.grain
    free = null_space(conditions)
    held = free.T @ matrix @ free
    solver = HeldSolver.of(panel.band, lower, panel.grain)
    assert solver.negative == (np.linalg.eigvalsh(held) < 0.0).sum()
    assert (solver.negative > 0) == (less > 0.0)
    right = np.random.default_rng(3).normal(size=(2 * count, 2))
    expected = free @ np.linalg.solve(held, free.T @ right)
    np.testing.assert_allclose(solver(right), expected, atol=1e-7 * np.abs(expected).max())
