"""What moves a solid: derivatives against differences, where some pieces of a band are slack."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from solid_bodies import BOTH, SLING, worn

from core.analysis.calibration.fit import solve_from
from core.analysis.calibration.parameters import SAG, Parameter, candidate_parameters, point_sensitivities
from core.analysis.diagnosis.opposing_constraints import analyse
from core.analysis.length_limits.limits import limits_of
from core.analysis.uncertainty.input_uncertainty import default_uncertainty
from core.analysis.uncertainty.linear_propagation import Propagation
from core.analysis.uncertainty.parameters import perturb, uncertain_parameters
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.document.design import Design
from core.garment.cut_list import cut_list
from core.garment.elastic_library import find_elastic
from core.garment.tension import line_tensions
from core.geometry.mesh import Floats
from core.measurements.uncertain_value import CUT, LIFT, TENSION, TISSUE
from core.mechanics.sensitivity import Sensitivities
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import exact_solution
from core.pipeline.surface_fields import line_forces

PLUSH = find_elastic("plush 12")
STEP = 3e-4


@pytest.fixture(scope="module")
def garment(person: Stages) -> Stages:
    """A sling of elastic, one of none, and a mid-bust band of elastic of which some pieces are slack."""
    stages = worn(person, 0.9, *BOTH)
    design = stages.design.with_linked(SLING[0], 0.93).with_line("mid-bust", 0.99)
    design = design.with_elastic("mid-bust", PLUSH).with_elastic(SLING[0], PLUSH)
    return build(design, stages)


@pytest.fixture(scope="module")
def answer(garment: Stages) -> Sensitivities:
    return exact_solution(garment)


def slopes(stages: Stages, at: object) -> Floats:
    """Return the slope at 0 of what ``at`` makes of a design, by differences of the fourth order."""
    far, near = (at(2.0 * STEP) - at(-2.0 * STEP)), (at(STEP) - at(-STEP))  # type: ignore[operator]
    return np.asarray((8.0 * near - far) / (12.0 * STEP))


def test_some_pieces_are_slack_and_none_pushes(garment: Stages, answer: Sensitivities) -> None:
    potential, place = answer.potential, answer.place
    taut = potential.taut(place.lengths)
    assert 0.0 < taut.mean() < 1.0
    tensions = line_tensions(garment, place.points)
    shares = line_forces(garment.model, place.points, line_targets(garment.design, garment).ratios)
    for each in (*(tension.segments for tension in tensions.values()), *shares.values()):
        assert each.min() >= 0.0
    assert min(each.min() for each in shares.values()) == 0.0


def test_an_elastic_has_one_tension_and_elongation_everywhere(garment: Stages, answer: Sensitivities) -> None:
    tensions = line_tensions(garment, answer.place.points)
    rows = {row.line: row for row in cut_list(garment, answer.place.points).rows}
    for name in ("mid-bust", SLING[0]):
        row = rows[name]
        assert row.tension_n == pytest.approx(tensions[name].mean, rel=1e-6)
        assert row.elongation is not None
        assert PLUSH.force(row.elongation) == pytest.approx(row.tension_n, rel=1e-6)


@pytest.mark.parametrize("posture", ["standing", "lying"])
def test_slopes_by_what_a_second_scan_finds_are_those_of_differences(garment: Stages, posture: str) -> None:
    stages = build(replace(garment.design, posture=posture), garment)
    here = solve_from(stages)
    numbers = candidate_parameters(stages, lengths=True)
    assert SAG in {number.kind for number in numbers}
    rates = point_sensitivities(stages, here, numbers)
    for column, number in enumerate(numbers):

        def moved(change: float, number: Parameter = number) -> Floats:
            design = number.from_unknown(stages.design, number.to_unknown(stages.design) + change)
            return solve_from(build(design, stages), here.balance).balance.state.moved.ravel()

        expected = slopes(stages, moved)
        assert np.abs(rates[:, column] - expected).max() < 1e-6 * np.abs(expected).max(), number.name


def test_sag_is_no_parameter_where_nothing_tells_it(person: Stages) -> None:
    plain = worn(person, 0.95, *SLING)
    assert SAG not in {number.kind for number in candidate_parameters(plain, lengths=False)}
    lying = worn(person, 0.95, *SLING, posture="lying")
    assert SAG in {number.kind for number in candidate_parameters(lying, lengths=False)}


@pytest.mark.parametrize("hold", ["spring", "held"])
def test_uncertainty_by_derivatives_is_that_of_designs_solved_anew(garment: Stages, hold: str) -> None:
    trials = PerturbedSolutions(build(replace(garment.design, line_hold=hold, volume="exact"), garment))
    small = default_uncertainty().scaled(0.002)
    (knob,) = (each for each in uncertain_parameters(trials.base, small) if each.source == TISSUE)
    values = Propagation(trials).effect(knob).values
    low, high = (trials(perturb(trials.base, {knob: turn})).values for turn in (-1.0, 1.0))
    told = [key for key in values if key.startswith((TENSION, LIFT, CUT))]
    assert len(told) >= 5
    for key in told:
        assert values[key] == pytest.approx((high[key] - low[key]) / 2.0, rel=1e-3, abs=1e-7), key


def test_forces_of_the_constraints_balance_the_tissue(garment: Stages, answer: Sensitivities) -> None:
    found = analyse(build(replace(garment.design, volume="exact"), garment))
    together = sum(each.force for each in found.forces)
    assert np.abs(together - answer.place.inner).max() < 1e-6 * np.abs(answer.place.inner).max()


def test_a_band_ends_where_its_last_piece_is_slack(garment: Stages) -> None:
    limits = limits_of(garment, "mid-bust", through=False)
    (slack,) = limits.shows["slack"]

    def pulls(ratio: float) -> float:
        design: Design = garment.design.with_line("mid-bust", ratio)
        stages = build(design, garment)
        return line_tensions(stages, exact_solution(stages).place.points)["mid-bust"].mean

    assert pulls(slack.short.ratio - 0.005) > 0.0
    assert pulls(slack.short.ratio + 0.005) == 0.0
