"""Rates of the exact answer: against differences of answers, for every law, contact and hold."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from models import LAWS, law_of, small
from slopes import slope

from core.mechanics.exact_solution import solve_exact
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium
from core.mechanics.options import ModelOptions
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Sensitivities

RATIOS = (1.0, 0.93, 0.96)
STEP = 5e-5


def choices() -> list[ModelOptions]:
    return [
        replace(law, line_contact=contact, line_hold=hold, volume_of=of)
        for law, contact, hold, of in product(
            LAWS, ("glued", "sliding"), ("spring", "held"), ("each", "both")
        )
    ]


def answered(
    model: ConstrainedModel,
    ratios: tuple[float, ...],
    excess: np.ndarray | None = None,
    near: Equilibrium | None = None,
) -> Sensitivities:
    balance = solve_exact(model, ratios, excess=excess, near=near)
    assert balance.is_converged
    return Sensitivities(Potential(model, ratios, excess), balance)


@pytest.mark.parametrize("mechanics", choices(), ids=law_of)
def test_rates_by_length_are_those_of_differences(mechanics: ModelOptions) -> None:
    model = small(mechanics)
    here = answered(model, RATIOS)
    rates = here.by_ratio(model.acting_lines)
    for column, line in enumerate(model.acting_lines):

        def answer(change: float, line: int = line) -> np.ndarray:
            ratios = tuple(ratio + change * (at == line) for at, ratio in enumerate(RATIOS))
            balance = answered(model, ratios, near=here.balance).balance
            return np.concatenate([balance.state.moved.ravel(), balance.multipliers])

        expected = slope(answer, STEP)
        moved, pressed = np.split(expected, [rates.moved.shape[0]])
        assert np.abs(rates.moved[:, column] - moved).max() < 1e-6 * np.abs(moved).max()
        assert np.abs(rates.multipliers[:, column] - pressed).max() < 1e-6 * np.abs(pressed).max()


@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_rates_by_what_a_side_is_given_are_those_of_differences(contact: str) -> None:
    model = small(ModelOptions(line_contact=contact))
    rates = answered(model, RATIOS).by_excess
    for side in range(2):
        unit = 1e6 * np.eye(2)[side]  # mm^3 in a step of 1
        expected = slope(
            lambda change, unit=unit: answered(model, RATIOS, change * unit).balance.state.moved.ravel(), STEP
        )
        assert np.abs(1e6 * rates.moved[:, side] - expected).max() < 1e-6 * np.abs(expected).max()
