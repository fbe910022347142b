"""A stiffness of a line's own acts wherever that of all lines does: in turns and in the exact answer."""

from dataclasses import replace

import numpy as np
import pytest
from models import LAWS, energy_of, law_of, settled
from shapes import central_difference, torso

from core.document.lines import ActiveLine, LineSettings
from core.mechanics.exact_solution import solve_exact
from core.mechanics.gain_limit import gain_limit
from core.mechanics.iteration import LineTargets, iterate
from core.mechanics.model import constrained_model
from core.mechanics.options import ModelOptions
from core.mechanics.potential import Potential
from core.pipeline.build import build

CONTACTS = [
    ModelOptions(),
    ModelOptions(line_contact="sliding"),
    ModelOptions(line_hold="held"),
    ModelOptions("prestressed", line_hold="held"),
    ModelOptions("co-rotated", line_contact="sliding"),
]
RATIOS = (1.0, 0.93, 0.95)
OWN = {"mid-bust": 24.0, "full-bust": 6.0}


def model_of(mechanics, own=None):
    """The skew torso of ``models.small``, its lines of different stiffness."""
    control = torso(skew=0.3)
    few = (control.row >= 2) & (control.row <= 3) & (np.abs(control.column) <= 3)
    return constrained_model(replace(control, fixed=~few), mechanics=mechanics, own_stiffness=own)


@pytest.mark.parametrize("mechanics", CONTACTS, ids=law_of)
def test_lines_that_all_have_the_same_stiffness_of_their_own_are_the_design_s_to_the_bit(mechanics):
    usual = model_of(replace(mechanics, line_stiffness=7.3))
    own = model_of(mechanics, dict.fromkeys(("under-bust", "mid-bust", "full-bust"), 7.3))
    assert gain_limit(own) == gain_limit(usual)
    targets = LineTargets(RATIOS)
    for (one, _), (other, _) in zip(
        *(iterate(model, lambda: targets, turns=20) for model in (usual, own)), strict=True
    ):
        assert np.array_equal(one.moved, other.moved)
    one, other = (solve_exact(model, RATIOS).state.moved for model in (usual, own))
    assert np.array_equal(one, other)
    assert not np.array_equal(one, solve_exact(model_of(mechanics), RATIOS).state.moved) or (
        mechanics.line_hold == "held"
    )


@pytest.mark.parametrize("mechanics", CONTACTS, ids=law_of)
def test_turns_end_at_the_exact_answer_whatever_each_line_s_stiffness(mechanics):
    model = model_of(replace(mechanics, volume_of="both"), OWN)
    balance = solve_exact(model, RATIOS)
    assert balance.is_converged
    state = settled(model, LineTargets(RATIOS))
    np.testing.assert_allclose(state.moved, balance.state.moved, atol=1e-8)


@pytest.mark.parametrize("law", LAWS, ids=law_of)
def test_derivatives_know_each_line_s_stiffness(law):
    model = model_of(law, OWN)
    potential = Potential(model, RATIOS)
    moved = np.random.default_rng(5).normal(size=(len(model.tensegric.free), 3))
    place, no_push = potential.at(moved), np.zeros(2)
    hessian = model.layout.band.full(potential.hessian(place, no_push, clip=False, curved=True))
    slope = central_difference(lambda d: energy_of(potential, d), moved, 1e-4)
    bend = central_difference(lambda d: potential.at(d).gradient, moved, 1e-4)
    np.testing.assert_allclose(slope, place.gradient, atol=1e-6 * np.abs(place.gradient).max())
    np.testing.assert_allclose(bend, hessian, atol=1e-6 * np.abs(hessian).max())


def test_a_softer_line_stays_further_from_its_length_and_the_other_lines_are_as_before(built):
    stages = built("mannequin")
    worn = replace(stages.design, lines=(ActiveLine("full-bust", 0.96), ActiveLine("mid-bust", 0.96)))
    gaps = []
    for own in (64.0, None, 4.0):
        design = worn.with_line_settings(LineSettings("mid-bust", stiffness=own))
        model = build(design, stages).model
        ratios = tuple(design.ratio(line.name) for line in model.lines)
        points = model.tensegric.expand(solve_exact(model, ratios).state.moved)
        gaps.append(
            next(line.length(points) / line.rest_length for line in model.lines if line.name == "mid-bust")
        )
        of = {line.name: model.segments.stiffness[model.owner == at] for at, line in enumerate(model.lines)}
        assert np.array_equal(of["full-bust"], built_stiffness(worn, stages)["full-bust"])
    assert 0.96 < gaps[0] < gaps[1] - 0.002 < gaps[2] - 0.006


def built_stiffness(design, stages):
    """The stiffness of each line's segments."""
    model = build(design, stages).model
    return {line.name: model.segments.stiffness[model.owner == at] for at, line in enumerate(model.lines)}


def test_only_worn_lines_with_a_stiffness_of_their_own_say_so(built):
    off = replace(built("mannequin").design, lines=())
    soft = off.with_line_settings(LineSettings("mid-bust", stiffness=2.0))
    assert soft.line_stiffnesses() == {}
    both = soft.with_line("mid-bust", 0.95).with_line("full-bust", 0.95)
    assert both.line_stiffnesses() == {"mid-bust": 2.0}
