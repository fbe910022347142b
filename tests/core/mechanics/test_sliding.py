"""Sliding lines: only the part of their force across the skin acts, in turns and in the exact answer."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hard_cases import hard_case
from models import (
    LAWS,
    cable_force,
    check_sliding_derivative,
    law_of,
    line_force,
    pairs_of,
    settled,
    small,
    volume_slopes,
)
from shapes import fitted, mid_bust, mirrored, torso

from app.research.sphere import sphere_model
from core.document.line_notation import with_custom_lines
from core.document.lines import CustomLine
from core.mechanics.exact_solution import NEWTON_LIMIT, newton, solve_exact
from core.mechanics.iteration import LineTargets, SolverState, initial_state, step
from core.mechanics.model import constrained_model
from core.mechanics.options import LINE_HOLDS, ModelOptions
from core.mechanics.volume import ITERATIVE_CONTROLS, Pressure

SLIDING = ModelOptions(line_contact="sliding")
RATIOS = (1.0, 0.9, 1.0)
WORN = ("mid-bust",)
RNG = np.random.default_rng(17)


def across(model, points):
    """The unit vectors across the skin at all control points, triangle by triangle; 0 where none is."""
    outward = volume_slopes(model, points).sum(axis=0)
    return np.array([v / np.linalg.norm(v) if v.any() else v for v in outward])


@pytest.mark.parametrize("law", LAWS[:2], ids=law_of)
@pytest.mark.parametrize("volume_of", ["each", "both"])
def test_what_the_garment_carries_is_exactly_the_part_along_the_skin(law, volume_of):
    choice = ModelOptions(law.member_law, line_contact="sliding", volume_of=volume_of)
    model = small(choice, worn=WORN)
    balance = solve_exact(model, RATIOS)
    points = model.tensegric.expand(balance.state.moved)
    n = across(model, points)
    body = cable_force(model, points)
    body += np.tensordot(balance.pressures, volume_slopes(model, points), axes=1)
    line = line_force(model, points, RATIOS)
    along = np.array([f - (f @ v) * v for f, v in zip(line, n, strict=True)])
    scale = np.abs(line).max()
    for i in model.tensegric.free:
        # All that is left unbalanced is what the line pulls along the skin: the garment holds against it.
        np.testing.assert_allclose(body[i] + line[i], along[i], atol=1e-9 * scale)
    on_line = np.unique(pairs_of(model.segments.across))
    assert np.linalg.norm(along[on_line], axis=1).max() > 0.1 * scale
    np.testing.assert_allclose(np.delete(line, on_line, axis=0), 0.0)


def plain_sliding_sweep(model, targets, state):
    """One turn, point after point: each solves (D + K n n^T) x = b for its place by hand."""
    tensegric = model.tensegric
    old, now = tensegric.expand(state.moved), tensegric.expand(state.moved)
    n = across(model, old)
    pressure = state.pressure.value * model.pressure_unit if targets.control != "none" else 0.0
    push = pressure * volume_slopes(model, old).sum(axis=0)
    for i in tensegric.free:
        stiffness, b = 0.0, push[i].copy()
        for (a, c), q in zip(tensegric.cables, tensegric.density, strict=True):
            if i in (a, c):
                j = c if i == a else a
                b += q * (now[j] + tensegric.rest[i] - tensegric.rest[j])
                stiffness += q
        tape, q_line = 0.0, np.zeros(3)
        pairs = pairs_of(model.segments.across)
        for (a, c), k, line in zip(pairs, model.segments.stiffness, model.owner, strict=True):
            if i in (a, c):
                j = c if i == a else a
                way = old[i] - old[j]
                natural = targets.ratios[line] * np.linalg.norm(tensegric.rest[i] - tensegric.rest[j])
                q_line += k * (now[j] + natural * way / np.linalg.norm(way))
                tape += k
        b += (q_line @ n[i]) * n[i]
        now[i] = b / stiffness - tape / (stiffness * (stiffness + tape)) * (b @ n[i]) * n[i]
    return now


@pytest.mark.parametrize("control", ITERATIVE_CONTROLS)
def test_a_sliding_turn_is_a_plain_sweep_point_by_point(control):
    targets = LineTargets((1.0, 0.85, 1.05), control, 1.2)
    model = small(SLIDING)
    state = initial_state(model)
    for _ in range(4):
        expected = plain_sliding_sweep(model, targets, state)
        state, _ = step(model, targets, state)
        np.testing.assert_allclose(model.tensegric.expand(state.moved), expected, atol=1e-10)


@pytest.mark.parametrize("law", LAWS, ids=law_of)
@pytest.mark.parametrize(("hold", "volume_of"), [("spring", "both"), ("held", "each"), ("held", "both")])
def test_the_derivative_of_the_balance_converges_with_second_order(law, hold, volume_of):
    model = small(ModelOptions(law.member_law, line_contact="sliding", line_hold=hold, volume_of=volume_of))
    moved = RNG.normal(size=(len(model.tensegric.free), 3))
    exact = check_sliding_derivative(model, RATIOS, moved)
    assert np.abs(exact - exact.T).max() > 0.1  # no energy has such a derivative


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_the_last_steps_converge_quadratically(sample):
    model = constrained_model(fitted(sample), worn=["mid-bust"], mechanics=SLIDING)
    near = solve_exact(model, mid_bust(model, 0.95))
    *places, end = (balance.state.moved for balance in newton(model, mid_bust(model, 0.94), near=near))
    away = [float(np.abs(place - end).max()) for place in places]
    late = [(before, after) for before, after in pairwise(away) if 1e-6 < before < 2.0]
    assert len(late) >= 3
    assert all(after < 0.2 * before**2 + 1e-11 for before, after in late)


@pytest.mark.parametrize("hold", ["spring", "held"])
def test_the_body_in_the_mirror_moves_as_the_mirror_of_the_body(hold):
    control = torso(skew=0.3)
    twin, was = mirrored(control)
    choice = ModelOptions(line_contact="sliding", line_hold=hold)
    model, mirror = (constrained_model(c, worn=WORN, mechanics=choice) for c in (control, twin))
    ratios = (1.0, 0.94, 1.0)
    balance, image = solve_exact(model, ratios), solve_exact(mirror, ratios)
    assert balance.is_converged
    shift = model.tensegric.expand(balance.state.moved) - model.tensegric.rest
    image_shift = mirror.tensegric.expand(image.state.moved) - mirror.tensegric.rest
    np.testing.assert_allclose(image_shift, shift[was] * [-1.0, 1.0, 1.0], atol=1e-8)
    np.testing.assert_allclose(image.pressures, balance.pressures[::-1], rtol=1e-8)


@pytest.mark.parametrize("law", LAWS, ids=law_of)
def test_turns_come_to_the_exact_answer(law):
    model = small(ModelOptions(law.member_law, line_contact="sliding", volume_of="both"), worn=WORN)
    exact = solve_exact(model, RATIOS).state.moved
    np.testing.assert_allclose(settled(model, LineTargets(RATIOS)).moved, exact, atol=1e-8)


def test_a_turn_leaves_the_exact_answer_where_it_is():
    model = small(ModelOptions(line_contact="sliding", volume_of="both"), worn=WORN)
    balance = solve_exact(model, RATIOS)
    start = SolverState(balance.state.moved, Pressure(balance.pressures[0] / model.pressure_unit))
    _, measured = step(model, LineTargets(RATIOS, "accumulating"), start)
    assert measured.step < 1e-9


def bust_lift(sample, contact, ratio):
    """How far both bust points rise [mm], and how long the line is in parts of its rest length."""
    choice = ModelOptions(line_contact=contact)
    model = constrained_model(fitted(sample), worn=["mid-bust"], mechanics=choice)
    balance = solve_exact(model, mid_bust(model, ratio))
    assert balance.is_converged
    points = model.tensegric.expand(balance.state.moved)
    rise = (points - model.tensegric.rest)[list(fitted(sample).bust_points), 2]
    return rise, model.lines[1].length(points) / model.lines[1].rest_length


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_a_sliding_line_lifts_the_bust_points_where_a_glued_one_hardly_does(sample):
    glued, sliding = (bust_lift(sample, contact, 0.95)[0] for contact in ("glued", "sliding"))
    assert glued.max() < 0.4
    assert sliding.min() > 1.2
    further = bust_lift(sample, "sliding", 0.8)[0]
    assert further.min() > 3.0 * sliding.min()


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_a_sliding_line_cannot_shrink_on_and_on(sample):
    """It comes to lie where the skin lets it: from 0.7 to 0.6 it asks for a tenth and gets a hundredth."""
    lengths = [bust_lift(sample, "sliding", ratio)[1] for ratio in (0.8, 0.7, 0.6)]
    assert lengths[0] - lengths[1] > lengths[1] - lengths[2] > 0.0
    assert lengths[1] - lengths[2] < 0.02
    assert lengths[2] > 0.84
    assert bust_lift(sample, "glued", 0.6)[1] < 0.79


@pytest.mark.parametrize("hold", LINE_HOLDS)
def test_a_length_next_to_rest_is_found_in_a_few_steps(hold):
    """Turns cannot help here: a force that is kept during the turn is not calm for so stiff a line."""
    choice = replace(SLIDING, line_hold=hold, line_force="explicit", line_stiffness=500.0)
    model = small(choice, worn=WORN)
    for ratio in (0.9997, 0.99999, 1.0002):
        balance = solve_exact(model, (1.0, ratio, 1.0))
        assert balance.is_converged
        assert balance.steps <= 5


def test_turns_find_what_the_walk_does_not():
    """Two lines cross on the sphere: the walk from rest breaks off, and leaves enough for the last resort."""
    choice = ModelOptions("prestressed", line_contact="sliding")
    model = sphere_model(["horizontal", "vertical"], choice).model
    balance = solve_exact(model, (0.9, 0.95))
    assert balance.is_converged
    assert balance.steps <= NEWTON_LIMIT
    assert not solve_exact(model, (0.9, 0.95), turns=False).is_converged


def test_at_rest_a_walk_stands_in_its_answer():
    model = small(SLIDING, worn=WORN)
    balance = solve_exact(model, (1.0, 1.0, 1.0), turns=False)
    assert (balance.is_converged, balance.steps) == (True, 0)


def test_where_turns_run_away_too_the_end_of_the_walk_stays():
    """A sliding line to a single free point and back can hardly be held: nothing is torn apart over it."""
    there, mid = 13 * 2 + 4, 13 * 2 + 5
    control = with_custom_lines(torso(skew=0.3), (CustomLine("back", (there, mid, there)),))
    model = constrained_model(control, worn=["back"], mechanics=replace(SLIDING, line_hold="held"))
    balance = solve_exact(model, (1.0, 1.0, 1.0, 0.9))
    assert not balance.is_converged
    assert np.abs(balance.state.moved).max() < 20.0


@pytest.mark.parametrize("ratios", [(1.0, 0.85, 0.95), (1.0, 0.9, 0.95)])
def test_where_newton_steps_fail_turns_are_the_last_resort(ratios):
    """Two sliding lines side by side over few free points: a case that only turns arrived at once."""
    model = small(ModelOptions("prestressed", line_contact="sliding", volume_of="both"))
    balance = solve_exact(model, ratios)
    assert balance.is_converged
    np.testing.assert_allclose(balance.state.moved, settled(model, LineTargets(ratios)).moved, atol=1e-7)


def test_turns_that_balance_the_sum_are_shared_out_to_each_breast():
    """A case in which no walk from rest arrives, but turns do; they hold the sum of both breasts alone."""
    case = hard_case(672)
    assert case.mechanics.volume_of == "each"
    balance = solve_exact(case.model, case.targets)
    points = case.model.tensegric.expand(balance.state.moved)
    away = case.model.volume.zone_volumes(points) - case.model.rest_zones
    assert balance.is_converged
    assert np.abs(away).max() < 1e-9 * case.model.volume.rest_volume
