"""How sure a bra on a solid is: cups that are sewn a little off, and landmarks that lie elsewhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.analysis.uncertainty.input_uncertainty import default_uncertainty
from core.analysis.uncertainty.linear_propagation import Propagation
from core.analysis.uncertainty.parameters import UncertainParameter, perturb, uncertain_parameters
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.document.cup import Cup
from core.garment.elastic_library import find_elastic
from core.measurements.uncertain_value import ELASTIC, LANDMARKS, TAPE, TISSUE
from core.pipeline.build import Stages, build
from core.tissue.condensed import with_moved_points

MOULDED = Cup(lift=15.0, forward=4.0, wire=True)
SEWN = Cup("sewn", across=0.95, upright=0.92, wire=True, wire_width=0.97)
KEYS = ("lift", "out", "change:bust_girth", "tension:under-bust", "max_kpa:under-bust")


def dressed(person: Stages, cup: Cup) -> PerturbedSolutions:
    design = replace(person.design, cup=cup).with_line("under-bust", 0.9)
    return PerturbedSolutions(build(design.with_elastic("under-bust", find_elastic("plush 12")), person))


def of_cups(trials: PerturbedSolutions, scale: float = 1.0) -> list[UncertainParameter]:
    return [
        knob for knob in uncertain_parameters(trials.base, default_uncertainty().scaled(scale)) if knob.cup
    ]


@pytest.mark.parametrize("cup", [MOULDED, SEWN], ids=["moulded", "sewn"])
def test_what_a_cup_sewn_off_does_is_what_another_cup_does(person: Stages, cup: Cup) -> None:
    trials = dressed(person, cup)
    propagation = Propagation(trials)
    for knob in of_cups(trials, 0.01):
        told = propagation.effect(knob).values
        low, high = (trials(perturb(trials.base, {knob: turn})).values for turn in (-1.0, 1.0))
        for key in KEYS:
            assert told[key] == pytest.approx((high[key] - low[key]) / 2.0, rel=0.02, abs=2e-4), (
                knob.cup,
                key,
            )


def test_each_length_of_a_cup_is_as_unsure_as_a_band(person: Stages) -> None:
    sizes = default_uncertainty()
    moulded = {knob.cup: knob for knob in of_cups(dressed(person, MOULDED))}
    sewn = {knob.cup: knob for knob in of_cups(dressed(person, SEWN))}
    assert list(moulded) == ["lift", "forward", "gather", "wire_width"]
    assert set(sewn) == {"cloth", "across", "upright", "wire_width"}
    assert moulded["lift"].sd == sizes.tape_mm
    assert sewn["cloth"].source == ELASTIC
    assert sewn["cloth"].sd == sizes.elastic_ln
    assert {knob.source for name, knob in sewn.items() if name != "cloth"} == {TAPE}
    # A breast is one to two hands wide along the skin, so 1.5 mm are about 1 %.
    for name in ("across", "upright", "wire_width"):
        assert 0.006 < sewn[name].sd < 0.025


def test_cups_alone_depend_on_how_soft_the_tissue_is(person: Stages) -> None:
    trials = PerturbedSolutions(build(replace(person.design, lines=(), cup=SEWN), person))
    sources = {knob.source for knob in uncertain_parameters(trials.base, default_uncertainty())}
    assert {TISSUE, TAPE, ELASTIC, LANDMARKS} <= sources


def test_the_same_tissue_is_told_at_other_points(person: Stages) -> None:
    """Its displacement under weight is the same field, by whichever points it is told."""
    knob = next(
        knob
        for knob in uncertain_parameters(person, default_uncertainty())
        if knob.source == LANDMARKS and knob.name == "bust_point_left"
    )
    moved = build(perturb(person, {knob: 1.0}).design, person, near=person)
    here, there = person.tissue, moved.tissue
    assert here is not None
    assert there is not None
    points, places = (each.control.mesh.vertices for each in (person, moved))
    assert np.abs(points - places).max() > 1.0
    fields = [each.carried @ np.linalg.solve(each.stiffness, each.weight) for each in (here, there)]
    assert np.abs(fields[1] - fields[0]).max() < 1e-6 * np.abs(fields[0]).max()
    energies = [
        np.einsum("ij,ij->j", each.weight, np.linalg.solve(each.stiffness, each.weight))
        for each in (here, there)
    ]
    assert energies[1] == pytest.approx(energies[0], rel=1e-9)
    assert there.rise == pytest.approx(here.rise, rel=0.05)
    assert there.softest == here.softest
    assert np.linalg.eigvalsh(there.stiffness).min() > 0.0


def test_points_that_stay_keep_their_tissue_to_the_bit(person: Stages) -> None:
    assert person.tissue is not None
    assert with_moved_points(person.tissue, person.control, person.control) is person.tissue
