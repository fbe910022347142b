"""Free lines: vertices between control points, whose forces go to control points by their weights."""

from dataclasses import replace
from itertools import pairwise, product

import numpy as np
import pytest
from models import LAWS, cable_force, check_sliding_derivative, energy_of, law_of, settled, volume_slopes
from shapes import central_difference, mirrored, run, torso

from core.control_mesh.embedding import embed, locate_on_grid
from core.control_mesh.fit import ControlMesh
from core.document.line_notation import with_custom_lines
from core.document.lines import CustomLine
from core.mechanics.exact_solution import newton, solve_exact
from core.mechanics.gain_limit import OscillationLimit, gain_limit
from core.mechanics.iteration import LineTargets, initial_state, iterate, step
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.options import CONTACTS, LINE_HOLDS, ModelOptions
from core.mechanics.potential import Potential

RNG = np.random.default_rng(7)
DIAGONAL = CustomLine("diagonal", places=((1.4, -4.3), (2.3, -2.2), (3.6, -0.4), (4.9, 2.6)))
"""A line that passes no control point, and is bent within two triangles."""


def model_with(
    line: CustomLine = DIAGONAL, control: ControlMesh | None = None, **choices
) -> ConstrainedModel:
    control = with_custom_lines(control or torso(skew=0.3), (line,))
    return constrained_model(control, worn=[line.name], mechanics=ModelOptions(**choices))


def ratios_of(model: ConstrainedModel, ratio: float) -> tuple[float, ...]:
    return tuple(ratio if at in model.acting_lines else 1.0 for at in range(len(model.lines)))


def plain_line_force(model: ConstrainedModel, points: np.ndarray, ratio: float) -> np.ndarray:
    """What the worn line does at all control points: Hooke's law vertex by vertex, spread by weights."""
    line, force = model.lines[model.acting_lines[0]], np.zeros_like(points)
    weights = line.weights.toarray()
    unit = model.options.line_stiffness * model.tensegric.mean_stiffness
    for a, b in pairwise(weights):
        rest = np.linalg.norm(a @ model.tensegric.rest - b @ model.tensegric.rest)
        span = a @ points - b @ points
        length = np.linalg.norm(span)
        pull = unit * line.spacing / rest * (length - ratio * rest) * span / length
        force -= np.outer(a - b, pull)
    return force


def test_a_place_has_the_weights_of_its_triangle():
    grid = torso().grid
    at = {(r, c): i for i, (r, c) in enumerate(zip(grid.row.tolist(), grid.column.tolist(), strict=True))}
    corners, weights = locate_on_grid(grid, np.array([[4.25, 1.5], [4.0, 1.0], [3.0, -2.5]]))
    # This cell's diagonal rises: the place lies below it, a quarter up and half along.
    found = dict(zip(corners[0].tolist(), weights[0].tolist(), strict=True))
    assert found == pytest.approx({at[4, 1]: 0.5, at[4, 2]: 0.25, at[5, 2]: 0.25})
    assert weights[1].max() == 1.0
    assert corners[1][weights[1].argmax()] == at[4, 1]
    assert sorted(weights[2]) == pytest.approx([0.0, 0.5, 0.5])


def test_a_curve_gets_a_vertex_at_every_edge_it_crosses():
    curve = embed(torso().grid, [(4.25, 1.5), (4.5, 2.25)])
    # Along the way r = 4.25 + t / 4, c = 1.5 + 3 t / 4: over the column 2 and over no diagonal.
    np.testing.assert_allclose(curve.places, [[4.25, 1.5], [4.25 + 1 / 6, 2.0], [4.5, 2.25]])
    assert curve.steps == pytest.approx(0.75)
    falling = embed(torso().grid, [(4.5, -1.25), (4.5, -1.75)])
    np.testing.assert_allclose(falling.places, [[4.5, -1.25], [4.5, -1.5], [4.5, -1.75]])


def test_every_triangle_is_crossed_straight():
    grid = torso().grid
    for seed in range(20):
        rng = np.random.default_rng(seed)
        curve = embed(grid, [(rng.uniform(0, 7), rng.uniform(-6, 6)) for _ in range(3)])
        middles = 0.5 * (curve.places[:-1] + curve.places[1:])
        corners, _ = locate_on_grid(grid, middles)
        for triangle, ends in zip(corners, pairwise(curve.weights.toarray()), strict=True):
            assert set(triangle) >= set(np.flatnonzero(np.any(ends, axis=0)))
        np.testing.assert_allclose(curve.weights @ grid.row, curve.places[:, 0], atol=1e-12)
        np.testing.assert_allclose(curve.weights @ grid.column, curve.places[:, 1], atol=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=law_of)
@pytest.mark.parametrize("hold", LINE_HOLDS)
def test_gradient_and_second_derivative_are_exact(law, hold):
    model = model_with(member_law=law.member_law, line_hold=hold)
    potential = Potential(model, ratios_of(model, 0.9))
    multipliers = np.linspace(2e4, -30.0, len(potential.wanted))
    moved = 2.0 * RNG.normal(size=(len(model.tensegric.free), 3))

    def slope(at):
        place = potential.at(at)
        return place.gradient - multipliers @ place.slopes

    full = model.layout.band.full(
        potential.hessian(potential.at(moved), multipliers, clip=False, curved=True)
    )

    def error(step):
        return np.abs(central_difference(slope, moved, step).reshape(full.shape) - full).max()

    assert error(0.4) / error(0.2) == pytest.approx(4.0, rel=0.15)
    assert error(1e-4) < 2e-5
    energy = central_difference(lambda at: np.array([energy_of(potential, at)]), moved, 1e-4)
    np.testing.assert_allclose(energy.ravel(), potential.at(moved).gradient, atol=1e-4)


@pytest.mark.parametrize("hold", LINE_HOLDS)
def test_the_derivative_of_a_sliding_free_line_is_exact(hold):
    model = model_with(line_contact="sliding", line_hold=hold)
    moved = RNG.normal(size=(len(model.tensegric.free), 3))
    check_sliding_derivative(model, ratios_of(model, 0.9), moved)


@pytest.mark.parametrize("ratio", [0.85, 0.96, 1.05])
def test_the_exact_answer_balances_forces_added_up_by_hand(ratio):
    model = model_with()
    answer = solve_exact(model, ratios_of(model, ratio))
    points = model.tensegric.expand(answer.state.moved)
    line = plain_line_force(model, points, ratio)
    force = cable_force(model, points) + line
    force += np.tensordot(answer.pressures, volume_slopes(model, points), axes=1)
    assert answer.is_converged
    np.testing.assert_allclose(force[model.tensegric.free], 0.0, atol=1e-8)
    np.testing.assert_allclose(line.sum(axis=0), 0.0, atol=1e-10)  # a line pulls at itself alone
    assert np.abs(line[model.tensegric.free]).max() > 1.0


@pytest.mark.parametrize(("contact", "hold"), list(product(CONTACTS, LINE_HOLDS)))
@pytest.mark.parametrize("name", ["mid-bust", "full-bust"])
def test_one_through_control_points_is_the_line_through_them(name, contact, hold):
    control = torso(skew=0.3)
    path = control.paths[name]
    places = tuple((float(control.row[at]), float(control.column[at])) for at in path)
    free = model_with(CustomLine("free", places=places), line_contact=contact, line_hold=hold)
    snapped = model_with(CustomLine("snapped", path), line_contact=contact, line_hold=hold)
    ratios = (*ratios_of(free, 0.93),)
    found, expected = (solve_exact(model, ratios) for model in (free, snapped))
    np.testing.assert_allclose(found.state.moved, expected.state.moved, atol=1e-11)
    for control_of in ("adaptive", "conventional", "accumulating", "none"):
        one, other = (step(m, LineTargets(ratios, control_of), initial_state(m))[0] for m in (free, snapped))
        np.testing.assert_allclose(one.moved, other.moved, atol=1e-12)


def test_vertices_added_on_it_change_nothing():
    grid = torso().grid
    whole = embed(grid, DIAGONAL.places).places
    middles = 0.5 * (whole[:-1] + whole[1:])
    finer = np.insert(whole, np.arange(1, len(whole)), middles, axis=0)
    models = [model_with(replace(DIAGONAL, places=tuple(map(tuple, at.tolist())))) for at in (whole, finer)]
    assert len(models[1].owner) == 2 * len(models[0].owner)
    one, other = (solve_exact(model, ratios_of(model, 0.9)).state.moved for model in models)
    assert np.abs(one).max() > 3.0
    np.testing.assert_allclose(other, one, atol=1e-9)


def test_a_curve_drawn_more_finely_comes_to_the_same():
    def answer(count):
        c = np.linspace(-4.2, 4.2, count)
        bow = tuple(zip((3.3 + 1.1 * np.sin(0.7 * c)).tolist(), c.tolist(), strict=True))
        model = model_with(CustomLine("bow", places=bow))
        return solve_exact(model, ratios_of(model, 0.92)).state.moved

    *coarser, finest = (answer(count) for count in (9, 17, 33, 65, 129, 1025))
    away = [float(np.abs(each - finest).max()) for each in coarser]
    assert all(0.0 < after < 0.7 * before for before, after in pairwise(away))
    assert away[-1] < 0.01


@pytest.mark.parametrize(("contact", "hold"), list(product(CONTACTS, LINE_HOLDS)))
def test_a_body_in_the_mirror_moves_as_the_mirror_image(contact, hold):
    control = torso(skew=0.3)
    twin, was = mirrored(control)
    other = replace(DIAGONAL, places=tuple((row, -column) for row, column in DIAGONAL.places))
    model = model_with(DIAGONAL, control, line_contact=contact, line_hold=hold)
    mirror = model_with(other, twin, line_contact=contact, line_hold=hold)
    ratios = ratios_of(model, 0.93)
    here = model.tensegric.expand(solve_exact(model, ratios).state.moved)
    there = mirror.tensegric.expand(solve_exact(mirror, ratios).state.moved)
    np.testing.assert_allclose(there * [-1.0, 1.0, 1.0], here[was], atol=1e-8)


@pytest.mark.parametrize(
    ("contact", "hold", "force"),
    [(*both, "implicit") for both in product(CONTACTS, LINE_HOLDS)]
    + [("glued", "spring", "explicit"), ("glued", "held", "explicit"), ("sliding", "spring", "explicit")],
)
def test_turns_rest_where_the_exact_answer_is(contact, hold, force):
    stiffness = 4.0 if force == "implicit" else 0.25
    choices = {"line_contact": contact, "line_hold": hold, "line_force": force, "volume_of": "both"}
    model = model_with(line_stiffness=stiffness, **choices)
    ratios = ratios_of(model, 0.95)
    exact = solve_exact(model, ratios)
    assert exact.is_converged
    for control in ("adaptive", "accumulating"):
        state = settled(model, LineTargets(ratios, control))
        np.testing.assert_allclose(state.moved, exact.state.moved, atol=1e-6)


@pytest.mark.parametrize(("ratio", "calm"), [(0.98, True), (0.95, False)])
def test_when_an_explicit_line_runs_away_is_known_before(ratio, calm):
    choices = {"line_contact": "sliding", "line_hold": "held", "line_force": "explicit", "volume_of": "both"}
    model = model_with(line_stiffness=0.25, **choices)
    ratios = ratios_of(model, ratio)
    exact = solve_exact(model, ratios)
    assert (OscillationLimit(model).overshoot(Potential(model, ratios), exact) < 2.0) == calm
    start = replace(initial_state(model), moved=exact.state.moved, tensions=exact.tensions)
    push = replace(start, moved=start.moved + 1e-3 * RNG.normal(size=start.moved.shape))
    *_, (_, measured) = iterate(model, lambda: LineTargets(ratios, "none"), push, turns=400)
    assert measured.step < 0.01 if calm else measured.step > 1.0


def test_the_gain_at_which_turns_vibrate_is_known_before():
    model = model_with(volume_of="both")
    limit, ratios = gain_limit(model), ratios_of(model, 0.999)
    for share, calm in ((0.98, True), (1.02, False)):
        _, records = run(model, LineTargets(ratios, "conventional", share * limit), 300)
        swing = np.ptp([measured.error for measured in records[-40:]])
        assert swing < 1e-7 if calm else swing > 1e-3


@pytest.mark.parametrize(("law", "contact"), list(product(LAWS, CONTACTS)), ids=str)
def test_nothing_drifts_at_rest(law, contact):
    model = model_with(member_law=law.member_law, line_contact=contact)
    state = initial_state(model)
    for _ in range(50):
        state, _ = step(model, LineTargets(ratios_of(model, 1.0)), state)
    # The rotations of co-rotated cells have some round-off, whatever lines there are.
    assert np.abs(state.moved).max() <= (1e-12 if law.member_law == "co-rotated" else 0.0)


def test_the_last_steps_converge_quadratically():
    model = model_with(line_contact="sliding")
    *places, end = (balance.state.moved for balance in newton(model, ratios_of(model, 0.94)))
    away = [float(np.abs(place - end).max()) for place in places]
    late = [(before, after) for before, after in pairwise(away) if 1e-6 < before < 0.5]
    assert len(late) >= 2
    assert all(after < 0.2 * before**2 + 1e-11 for before, after in late)
