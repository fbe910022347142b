"""Exact answers at other lengths with their slopes: against differences; which lines may change."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from slopes import doubled, slope

from app.presenters.samples import sample_design
from core.analysis.inverse_design.quantities import QuantityReaders
from core.analysis.inverse_design.sensitivities import LinearizedSolutions
from core.garment.presets import find_preset, with_preset
from core.pipeline.active_lines import free_lines
from core.pipeline.build import Stages, build

GROUPS = [("mid-bust",), ("full-bust",)]
HERE = np.array([91.0, 96.0])
HEIGHTS = ("profile left 340", "profile left 372.5")
CHOICES = (
    {},
    {"line_contact": "sliding"},
    {"line_hold": "held"},
    {"member_law": "co-rotated"},
    {"dense_volume": True},
    {"dense_volume": True, "volume_of": "both"},
)


@pytest.fixture(scope="module")
def plain() -> Stages:
    design = sample_design().with_line("mid-bust", 0.9).with_line("full-bust", 0.95)
    return build(replace(design, volume="exact"))


@pytest.mark.parametrize("choice", CHOICES, ids=str)
def test_slopes_are_those_of_differences(plain: Stages, choice: dict[str, str | bool]) -> None:
    stages = doubled(build(replace(plain.design, **choice), plain))
    answers = LinearizedSolutions(
        stages, GROUPS, QuantityReaders(stages).reader(("lift", "out left", "girth", *HEIGHTS))
    )
    look = answers(HERE)
    for column, way in enumerate(np.eye(2)):

        def figures(t: float, way: np.ndarray = way) -> np.ndarray:
            there = answers(HERE + t * way)
            return np.concatenate([there.values, there.tensions, there.margins, [there.least_margin()[0]]])

        expected = slope(figures, 0.01)
        slopes = look.by_values, look.by_tensions, look.by_margins, look.least_margin()[1][None]
        told = np.concatenate(slopes)[:, column]
        assert told == pytest.approx(expected, rel=1e-6, abs=1e-6 * np.abs(expected).max())


def test_answers_are_those_from_rest_and_worked_out_once(plain: Stages) -> None:
    answers = LinearizedSolutions(plain, GROUPS, QuantityReaders(plain).reader(["out"]))
    assert answers(HERE) is answers(HERE.copy())
    assert len(answers) == 1
    assert answers.is_reachable_from_original(HERE)


def test_locked_kept_and_still_lines_stay_and_linked_ones_go_together(plain: Stages) -> None:
    design = with_preset(plain.design, find_preset("Bra"))
    for name in sorted(design.active_lines()):
        design = design.with_line(name, 0.95)
    stages = build(design, plain)
    groups = free_lines(stages)
    assert ("strap left", "strap right") in groups
    assert all(line.constrains for group in groups for line in stages.model.lines if line.name in group)
    assert ("strap left", "strap right") not in free_lines(stages, ["strap right"])
    locked = design.with_line_settings(replace(design.line_settings("mid-bust"), locked=True))
    assert ("mid-bust",) in groups
    assert ("mid-bust",) not in free_lines(build(locked, stages))
    alone = design.with_line("strap right", 0.9)
    assert ("strap left",) in free_lines(build(alone, stages))
