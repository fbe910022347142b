"""Cases with far too short lines, several at once, under every choice: each ends with a figure and a verdict.

benchmarks/bench_hard_cases.py tries a thousand of them; here are the first few.
"""

from __future__ import annotations

from math import isfinite, isnan

import pytest
from hard_cases import hard_case

from core.mechanics.convergence import MOTIONS
from core.mechanics.options import CHOICES

SEEDS = range(60)
TURNS = 100


@pytest.fixture(scope="module")
def cases():
    return [hard_case(seed) for seed in SEEDS]


def test_the_cases_are_hard_and_many_kinds(cases):
    of_nets = CHOICES.keys() - {"tissue", "posture"}  # a solid needs a body: see tests/core/tissue
    for name, words in ((name, CHOICES[name]) for name in of_nets):
        assert {getattr(case.mechanics, name) for case in cases} == set(words), f"draw {name} in hard_case"
    assert sum(len(case.ratios) > 1 for case in cases) > 30
    assert sum(len(case.own) > 0 for case in cases) > 30
    lengths = [ratio for case in cases for ratio in case.ratios.values()]
    assert min(lengths) < 0.55
    assert max(lengths) > 1.05


@pytest.mark.parametrize("seed", SEEDS)
def test_every_case_ends_with_a_figure_and_a_verdict(cases, seed):
    """A warning of an overflow would fail it too."""
    case = cases[seed]
    residual, exact = case.exact()
    step, adaptive = case.turns("adaptive", TURNS)
    assert not isnan(residual)
    assert not isnan(step)
    for verdict in (exact, adaptive):
        assert verdict.motion in MOTIONS
        assert isfinite(verdict.error)
        assert verdict.condition is not None
    if exact.motion == "settled":
        assert residual < 1e-8
        assert abs(exact.error) < 1e-9
        # A force that is kept during the turn is the paper to the letter, and no promise.
        assert adaptive.motion in ("settled", "settling") or case.mechanics.line_force == "explicit"
    else:
        assert adaptive.motion != "settled"
        # A spring always gives way in the end; only what is held, or slides, can be left without a balance.
        assert case.mechanics.line_hold == "held" or case.mechanics.line_contact == "sliding"
