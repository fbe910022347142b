"""Lines at any position: level, upright, oblique, closed, crossing, several at once, shorter and longer."""

from itertools import product

import numpy as np
import pytest
from models import cable_force, line_force, small, volume_slopes
from shapes import fitted, run, torso

from core.document.line_notation import with_custom_lines
from core.document.lines import CustomLine
from core.mechanics.exact_solution import solve_exact
from core.mechanics.iteration import LineTargets
from core.mechanics.model import constrained_model
from core.mechanics.options import CONTACTS, LAWS, LINE_HOLDS, VOLUMES, ModelOptions


def point(row, column):
    """The number of a control point of the torso, and of the template with 168 triangles."""
    return 13 * row + column + 6


OWN = (
    CustomLine("high", tuple(point(4, c) for c in range(-4, 5))),
    CustomLine("strap", tuple(point(r, 3) for r in range(2, 7))),
    CustomLine("oblique", (point(2, -4), point(3, -3), point(4, -2), point(5, -1))),
    CustomLine(
        "sling", (point(6, 4), point(5, 4), point(4, 4), point(3, 3), point(3, 2), point(4, 1), point(5, 1))
    ),
    CustomLine(
        "cup", (point(2, 2), point(2, 3), point(3, 4), point(4, 3), point(4, 2), point(3, 1)), closed=True
    ),
    CustomLine("leap", (point(2, -3), point(4, 0), point(2, 3))),
)
"""Lines of the designer: level, upright, oblique, bent, closed, and over points that are no neighbours."""

CONTROL = with_custom_lines(torso(skew=0.3), OWN)
NAMES = tuple(CONTROL.paths)


def model_with(*worn, **choices):
    return constrained_model(CONTROL, worn=worn, mechanics=ModelOptions(**choices))


def ratios_for(**asked):
    return tuple(asked.get(name, 1.0) for name in NAMES)


def assert_balanced(model, ratios, balance):
    """Forces point by point, triangle by triangle, segment by segment; and both volumes."""
    points = model.tensegric.expand(balance.state.moved)
    force = cable_force(model, points) + line_force(model, points, ratios)
    force += np.tensordot(balance.pressures, volume_slopes(model, points), axes=1)
    assert balance.is_converged
    np.testing.assert_allclose(force[model.tensegric.free], 0.0, atol=1e-8)
    change = model.volume.zone_volumes(points) - model.volume.zone_volumes(model.tensegric.rest)
    assert np.abs(change).max() < 1e-9 * model.volume.rest_volume


@pytest.mark.parametrize(
    ("line", "ratio"), list(product(OWN, (0.8, 0.97, 1.06))), ids=lambda v: str(getattr(v, "name", v))
)
def test_one_line_wherever_it_runs(line, ratio):
    model = model_with(line.name)
    ratios = ratios_for(**{line.name: ratio})
    balance = solve_exact(model, ratios)
    assert_balanced(model, ratios, balance)
    index = NAMES.index(line.name)
    points = model.tensegric.expand(balance.state.moved)
    reached = model.lines[index].length(points) / model.lines[index].rest_length
    assert min(ratio, 1.0) < reached < max(ratio, 1.0)
    others = [i for i, other in enumerate(NAMES) if other != line.name]
    assert all(model.lines[i].length(points) > 0.0 for i in others)


@pytest.mark.parametrize("ratios", [(0.9, 0.95, 0.9, 1.05), (1.05, 0.85, 0.93, 0.9), (0.8, 0.8, 0.8, 0.8)])
def test_several_lines_that_cross(ratios):
    names = ("mid-bust", "strap", "oblique", "leap")
    model = model_with(*names)
    asked = ratios_for(**dict(zip(names, ratios, strict=True)))
    assert_balanced(model, asked, solve_exact(model, asked))


@pytest.mark.parametrize("contact", ["glued", "sliding"])
@pytest.mark.parametrize("line", OWN, ids=lambda line: line.name)
def test_turns_keep_the_volume_under_every_line(line, contact):
    model = model_with(line.name, line_contact=contact)
    _, records = run(model, LineTargets(ratios_for(**{line.name: 0.93})), 120)
    errors = np.array([measured.error for measured in records])
    assert np.abs(errors[60:]).max() < 1e-3
    assert np.ptp(errors[-40:]) < 1e-5


def test_a_closed_line_may_begin_anywhere_and_run_either_way():
    cup = next(line for line in OWN if line.closed)
    answers = []
    for points in (cup.points, cup.points[2:] + cup.points[:2], cup.points[::-1]):
        control = with_custom_lines(torso(skew=0.3), (CustomLine("cup", points, closed=True),))
        model = constrained_model(control, worn=["cup"])
        assert len(model.owner) == len(points)
        answers.append(solve_exact(model, (1.0, 1.0, 1.0, 0.9)).state.moved)
    np.testing.assert_allclose(answers[1], answers[0], atol=1e-9)
    np.testing.assert_allclose(answers[2], answers[0], atol=1e-9)


def test_a_closed_line_pulls_together_what_it_goes_round():
    cup = next(line for line in OWN if line.closed)
    model = model_with("cup", line_hold="held")
    balance = solve_exact(model, ratios_for(cup=0.95))
    points = model.tensegric.expand(balance.state.moved)[list(cup.points)]
    assert np.ptp(points[:, 0]) < np.ptp(model.tensegric.rest[list(cup.points), 0])
    around = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1).sum()
    assert around == pytest.approx(0.95 * model.lines[NAMES.index("cup")].rest_length, rel=1e-12)


def test_two_lines_in_the_same_place_pull_as_one_twice_as_stiff():
    mid = CONTROL.paths["mid-bust"]
    control = with_custom_lines(torso(skew=0.3), (CustomLine("again", mid),))
    two = constrained_model(control, worn=["mid-bust", "again"])
    one = constrained_model(torso(skew=0.3), worn=["mid-bust"], mechanics=ModelOptions(line_stiffness=32.0))
    both, stiff = solve_exact(two, (1.0, 0.9, 1.0, 0.9)), solve_exact(one, (1.0, 0.9, 1.0))
    np.testing.assert_allclose(both.state.moved, stiff.state.moved, atol=1e-9)


def test_half_as_many_segments_over_every_other_point():
    """A line need not run along cables: between its points it is a chord."""
    model = model_with("leap", line_hold="held")
    ratios = ratios_for(leap=0.97)
    balance = solve_exact(model, ratios)
    assert balance.is_converged
    index = NAMES.index("leap")
    chord = np.linalg.norm(
        np.diff(model.tensegric.rest[[point(2, -3), point(4, 0), point(2, 3)]], axis=0), axis=1
    )
    assert model.lines[index].rest_length == pytest.approx(chord.sum())
    reached = model.lines[index].length(model.tensegric.expand(balance.state.moved))
    assert reached == pytest.approx(0.97 * chord.sum(), rel=1e-12)


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_own_lines_on_real_bodies(sample):
    control = with_custom_lines(fitted(sample), OWN)
    for names in (*((line.name,) for line in OWN), ("mid-bust", "strap", "oblique", "cup")):
        model = constrained_model(control, worn=names)
        for ratio in (0.9, 1.05):
            ratios = tuple(ratio if name in names else 1.0 for name in control.paths)
            assert_balanced(model, ratios, solve_exact(model, ratios))


@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_a_strap_lifts_the_bust_point_under_it_alone(sample):
    control = with_custom_lines(fitted(sample), (OWN[1],))
    model = constrained_model(control, worn=["strap"])
    ratios = tuple(0.9 if name == "strap" else 1.0 for name in control.paths)
    points = model.tensegric.expand(solve_exact(model, ratios).state.moved)
    left, right = (points - model.tensegric.rest)[list(control.bust_points), 2]
    assert left > 3.0
    assert abs(right) < 0.2


EVERY_CHOICE = list(product(LAWS, CONTACTS, LINE_HOLDS, VOLUMES))


@pytest.mark.parametrize(("law", "contact", "hold", "volume_of"), EVERY_CHOICE)
def test_every_choice_of_the_model_obeys_the_volume_asked_for_and_rests_without_a_line(
    law, contact, hold, volume_of
):
    choice = ModelOptions(law, line_contact=contact, line_hold=hold, volume_of=volume_of)
    bare = solve_exact(small(choice, worn=()), (0.9, 0.9, 0.9))
    assert bare.is_converged
    np.testing.assert_allclose(bare.state.moved, 0.0, atol=1e-10)
    model, excess = small(choice, worn=("mid-bust",)), np.array([3000.0, -1000.0])
    balance = solve_exact(model, (1.0, 0.95, 1.0), excess=excess)
    assert balance.is_converged
    points = model.tensegric.expand(balance.state.moved)
    gained = model.volume.zone_volumes(points) - model.volume.zone_volumes(model.tensegric.rest)
    if volume_of == "each":
        np.testing.assert_allclose(gained, excess, atol=1e-4)
    else:
        assert gained.sum() == pytest.approx(2000.0, abs=1e-4)


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("hold", LINE_HOLDS)
def test_the_way_of_a_slider_is_repeatable_and_leads_to_the_answer_from_rest(contact, hold):
    """Each answer starts from the last one; twice the same way is the same to the bit."""
    choice = ModelOptions(line_contact=contact, line_hold=hold)
    model = small(choice, worn=("mid-bust",))
    ways = []
    for _ in range(2):
        way = [solve_exact(model, (1.0, 1.0, 1.0))]
        for ratio in (0.99, 0.98, 0.97, 0.96, 0.95, 0.96, 0.97):
            way.append(solve_exact(model, (1.0, ratio, 1.0), near=way[-1]))
            assert way[-1].is_converged
            assert way[-1].steps <= 6
        ways.append(way)
    for one, two in zip(*ways, strict=True):
        np.testing.assert_array_equal(one.state.moved, two.state.moved)
    # There and back, and from rest: the same place.
    np.testing.assert_allclose(way[7].state.moved, way[3].state.moved, atol=1e-9)
    cold = solve_exact(model, (1.0, 0.97, 1.0))
    np.testing.assert_allclose(way[7].state.moved, cold.state.moved, atol=1e-9)
