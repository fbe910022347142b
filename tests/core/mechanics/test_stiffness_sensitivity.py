"""Rates by what lines are made of: against differences of answers, with and without elastics."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from models import LAWS, law_of, small
from slopes import slope

from core.document.elastic import Elastic
from core.mechanics.elastic_lines import ElasticLines, fit_elastics
from core.mechanics.exact_solution import solve_exact
from core.mechanics.model import ConstrainedModel, assemble
from core.mechanics.options import ModelOptions
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Sensitivities
from core.mechanics.stiffness_sensitivity import Changes, by_stiffness, stiffness_rates

RATIOS = (1.0, 0.93, 0.96)
STEP = 5e-5
ELASTIC = Elastic("curved", 12.0, ((0.0, 0.0), (0.02, 0.4), (0.3, 1.5), (0.9, 3.0)))


def choices() -> list[ModelOptions]:
    return [
        replace(law, line_contact=contact, volume_of=of)
        for law, (contact, of) in product(LAWS, (("glued", "each"), ("sliding", "both")))
    ]


def answered(model: ConstrainedModel, ratios: tuple[float, ...] = RATIOS) -> Sensitivities:
    balance = solve_exact(model, ratios)
    assert balance.is_converged
    return Sensitivities(Potential(model, ratios), balance)


def stiffened(model: ConstrainedModel, line: int, change: float) -> ConstrainedModel:
    """Return the model with one line's stiffness greater by so much of its logarithm."""
    usual = model.options.line_stiffness
    own = {each.name: usual * np.exp(change * (at == line)) for at, each in enumerate(model.lines)}
    return assemble(model.tensegric, model.lines, model.volume, [line.name for line in model.lines], own)


def pulls(answer: Sensitivities) -> np.ndarray:
    return answer.potential.tape * (answer.place.lengths - answer.potential.natural)


@pytest.mark.parametrize("mechanics", choices(), ids=law_of)
def test_rates_by_stiffness_are_those_of_differences(mechanics: ModelOptions) -> None:
    model = small(mechanics)
    here = answered(model)
    rates, every = by_stiffness(here, model.acting_lines), np.eye(len(model.lines))
    followed = stiffness_rates(here, Changes(every, 0.0 * every), {}, np.array(RATIOS))
    for column, line in enumerate(model.acting_lines):
        at = [answered(stiffened(model, int(line), change)) for change in (-STEP, STEP)]
        moved, pull = (
            (read(at[1]) - read(at[0])) / (2.0 * STEP)
            for read in (lambda answer: answer.place.moved.ravel(), pulls)
        )
        assert np.abs(rates.moved[:, column] - moved).max() < 1e-6 * np.abs(moved).max()
        assert np.abs(followed.pulls[:, line] - pull).max() < 1e-6 * np.abs(pull).max()


@pytest.mark.parametrize(("contact", "what"), [("glued", "force"), ("sliding", "length")])
def test_an_elastic_follows_its_curve(contact: str, what: str) -> None:
    model = small(ModelOptions(line_contact=contact))
    names = [line.name for line in model.lines]
    chosen = int(model.acting_lines[0])

    def solved(change: float) -> Sensitivities:
        ratios = [ratio + change * (what == "length") * (at == chosen) for at, ratio in enumerate(RATIOS)]
        grown = np.exp(change * (what == "force"))
        elastic = replace(ELASTIC, curve=tuple((e, f * grown) for e, f in ELASTIC.curve))
        wish = ElasticLines(model, dict(zip(names, ratios, strict=True)), {names[chosen]: elastic}, 2e-3, {})
        fitted = fit_elastics(wish, lambda each: solve_exact(each, tuple(ratios)))
        assert fitted.agreed
        return answered(fitted.model, tuple(ratios))

    here = solved(0.0)
    setting = np.eye(len(names))[:, [chosen]]
    forced, longer = (setting, 0.0 * setting) if what == "force" else (0.0 * setting, setting)
    found = stiffness_rates(here, Changes(forced, longer), {chosen: ELASTIC}, np.array(RATIOS))
    both = slope(lambda step: np.concatenate([(a := solved(step)).place.moved.ravel(), pulls(a)]), 1e-3)
    moved, pull = np.split(both, [found.moved.shape[0]])
    assert np.abs(found.moved[:, 0] - moved).max() < 1e-6 * np.abs(moved).max()
    assert np.abs(found.pulls[:, 0] - pull).max() < 1e-6 * np.abs(pull).max()
