"""Under sliding lines more than one balance is about: the exact answer keeps to that which rest leads to."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import core.mechanics.exact_solution
from core.analysis.length_limits.limits import limits_of
from core.control_mesh.template import read_template
from core.document.line_notation import ready_made_lines
from core.document.lines import ActiveLine
from core.mechanics.exact_solution import solve_exact
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets

WORN = (("mid-bust", 0.909), ("full-bust", 0.96), ("strap left", 0.973), ("strap right", 0.973))


@pytest.fixture(scope="module")
def strapped(built) -> Stages:
    stages = built("mannequin")
    design = replace(
        stages.design,
        own_lines=ready_made_lines(read_template("168"))["straps"],
        lines=tuple(ActiveLine(*line) for line in WORN),
        line_contact="sliding",
        volume="exact",
    )
    return build(design, stages)


def answers(stages: Stages, lengths) -> list[np.ndarray]:
    """Where the points go with the mid-bust line at ``lengths``, each found from rest by itself."""
    names = [line.name for line in stages.model.lines]
    found = []
    for length in lengths:
        set_ = list(line_targets(stages.design, stages).ratios)
        set_[names.index("mid-bust")] = float(length)
        balance = solve_exact(stages.model, tuple(set_))
        assert balance.is_converged
        found.append(balance.state.moved)
    return found


def test_lengths_close_by_have_answers_close_by(strapped: Stages) -> None:
    """Steps that went wherever they came to a balance leapt 26 mm between 64 and 66 %, and back."""
    found = answers(strapped, np.arange(0.63, 0.68, 0.005))
    moves = [np.abs(one - other).max() for one, other in pairwise(found)]
    assert max(moves) < 2.0


def test_zones_are_of_the_answer_that_rest_leads_to(strapped: Stages) -> None:
    begins = limits_of(strapped, "mid-bust", through=False).onsets["strained"]
    assert begins is not None
    names = [line.name for line in strapped.model.lines]
    line = strapped.model.lines[names.index("mid-bust")]
    (there,) = answers(strapped, [begins.ratio])
    assert line.length(strapped.model.tensegric.expand(there)) == pytest.approx(begins.reached, abs=1e-3)


def test_a_branch_that_has_an_end_is_left(strapped: Stages, monkeypatch) -> None:
    """However little steps may leave the way that the first one leads, an answer is found."""
    monkeypatch.setattr(core.mechanics.exact_solution, "_OFF_WAY", 0.0)
    monkeypatch.setattr(core.mechanics.exact_solution, "_OFF_ANYWAY", 0.01)
    assert len(answers(strapped, [0.65])) == 1
