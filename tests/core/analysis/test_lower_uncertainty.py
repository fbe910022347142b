"""Uncertainty of the lower trunk: derivatives are those of designs that are solved anew."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import pytest
from whole_trunk import wearing

from core.analysis.uncertainty.estimate import LOWER_TRUNK, UncertaintyEstimator
from core.analysis.uncertainty.input_uncertainty import default_uncertainty
from core.analysis.uncertainty.lower_trunk import NAMES, LowerPropagation, measures
from core.analysis.uncertainty.parameters import UncertainParameter
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.garment.elastic_library import find_elastic
from core.measurements.uncertain_value import ELASTIC, LANDMARKS, LINE, SCAN, TAPE
from core.pipeline.build import Stages, build
from core.pipeline.solve import exact_solution

LINES = {"waist": 0.93, "sling-left": 0.95, "sling-right": 0.95}


@cache
def worn() -> Stages:
    return wearing(LINES)


@cache
def propagation() -> LowerPropagation:
    return LowerPropagation(worn(), default_uncertainty())


def knob(source: str, name: str = "") -> UncertainParameter:
    return next(each for each in propagation().knobs if (each.source, each.name) == (source, name))


def waist_of(stages: Stages) -> float:
    assert stages.lower is not None
    return measures(stages.lower, exact_solution(stages.lower).place.points)["after:waist_girth"]


def test_a_band_cut_too_long_is_that_of_a_longer_line() -> None:
    stages, tape = worn(), knob(TAPE, "waist")
    line = next(line for line in stages.lines if line.name == "waist")
    longer, shorter = (
        build(stages.design.with_line("waist", 0.93 + turn * tape.sd / line.whole_length), stages)
        for turn in (1.0, -1.0)
    )
    effect = propagation().effect(tape)
    assert effect is not None
    expected = (waist_of(longer) - waist_of(shorter)) / 2.0
    assert effect.values["after:waist_girth"] == pytest.approx(expected, rel=0.01)
    assert effect.values["change:waist_girth"] == pytest.approx(expected, rel=0.01)
    assert effect.values["before:waist_girth"] == 0.0


def test_stiffer_lines_are_those_of_a_stiffer_model() -> None:
    stages = worn()
    small = UncertainParameter(LINE, 0.01)
    effect = propagation().effect(small)
    assert effect is not None
    usual = stages.design.line_stiffness
    sides = (
        build(replace(stages.design, line_stiffness=usual * math.exp(turn * small.sd)), stages)
        for turn in (1.0, -1.0)
    )
    more, less = map(waist_of, sides)
    assert effect.values["after:waist_girth"] == pytest.approx((more - less) / 2.0, rel=0.01)


def test_all_skin_further_out_is_a_longer_tape_and_no_change() -> None:
    effect = propagation().effect(knob(SCAN))
    assert effect is not None
    for key in ("waist_girth", "hip_girth"):
        assert effect.values[f"before:{key}"] == pytest.approx(2.0 * math.pi * 0.2, rel=0.05)
        assert effect.values[f"change:{key}"] == pytest.approx(0.0, abs=0.02)


def test_an_elastic_tells_its_force_and_every_landmark_has_a_knob() -> None:
    stages = build(worn().design.with_elastic("waist", find_elastic("plush 12")), worn())
    told = LowerPropagation(stages, default_uncertainty())
    strap = next(each for each in told.knobs if each.source == ELASTIC)
    effect = told.effect(strap)
    assert effect is not None
    assert effect.values["after:waist_girth"] < 0.0 < effect.values["tension:waist"]
    assert {each.name for each in told.knobs if each.source == LANDMARKS} == set(NAMES)


def test_a_belly_landmark_that_is_higher_changes_its_girth_and_not_the_hip() -> None:
    effect = propagation().effect(knob(LANDMARKS, "belly"))
    assert effect is not None
    assert abs(effect.values["before:belly_girth"]) > 0.5
    assert effect.values["before:hip_girth"] == pytest.approx(0.0, abs=1e-9)


def test_both_regions_are_told_together_with_what_is_left_out() -> None:
    found = UncertaintyEstimator(PerturbedSolutions(worn())).estimate_partial()
    assert not found.bare
    assert LOWER_TRUNK in found.cautions
    assert found.plus_minus("after:waist_girth") is not None
    low, high = found.between("max_kpa:waist", found.values["max_kpa:waist"]) or (0.0, 0.0)
    assert 0.0 < low < found.values["max_kpa:waist"] < high
    waist = found.by_output["before:waist_girth"].by_source
    assert waist[SCAN] == pytest.approx(1.26, abs=0.06), "once, not for both tables"
