"""Calibration of the lower trunk: slopes are those of differences, and made numbers are found again."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from whole_trunk import wearing

from benchmarks.worn_pairs import scanned, written
from core.analysis.calibration.api import calibrate, compare, predicted_points, read_fitting_scan
from core.analysis.calibration.fit import solve_from
from core.analysis.calibration.parameters import (
    LINE_STIFFNESS,
    LOWER_FIRMNESS,
    Parameter,
    candidate_parameters,
    point_sensitivities,
)
from core.document.design import ScanSource
from core.garment.elastic_library import find_elastic
from core.pipeline.build import Stages, build

GIRDLE = {"waist": 0.93, "hip": 0.97, "sling-left": 0.95, "sling-right": 0.95}
STEP = 3e-4


@cache
def worn() -> Stages:
    return wearing(GIRDLE)


def test_slopes_by_numbers_are_those_of_differences() -> None:
    whole = wearing(GIRDLE, waist_kept=1.0)  # else what the waist takes up inside changes with firmness
    design = whole.design.with_elastic("waist", find_elastic("plush 12"))
    stages = build(design, whole)
    assert stages.lower is not None
    numbers = candidate_parameters(stages, lengths=False, each=False)
    assert {number.kind for number in numbers} == {LINE_STIFFNESS, "lower_stiffness", LOWER_FIRMNESS}
    here = solve_from(stages.lower)
    rates = point_sensitivities(stages.lower, here, numbers)
    for column, number in enumerate(numbers):

        def moved(change: float, number: Parameter = number) -> np.ndarray:
            there = build(number.from_unknown(design, number.to_unknown(design) + change), stages).lower
            assert there is not None
            return solve_from(there, here.balance).balance.state.moved.ravel()

        far, near = (moved(2.0 * STEP) - moved(-2.0 * STEP)), (moved(STEP) - moved(-STEP))
        expected = (8.0 * near - far) / (12.0 * STEP)
        assert np.abs(rates[:, column] - expected).max() < 1e-5 * np.abs(expected).max(), number.name


def test_made_numbers_of_a_girdle_are_found_again(tmp_path: Path) -> None:
    stages = worn()
    assert stages.design.lower is not None
    lower = replace(stages.design.lower, firmness=0.2)
    truth = replace(stages.design, line_stiffness=8.0, lower=lower)
    there = build(truth, stages)
    points = predicted_points(there)
    mesh = there.skin.body([points[rows] for rows in there.region_rows])
    made, _ = scanned(mesh, stages, np.random.default_rng(8), noise=0.3, resampled=False, hole=0.0)
    scan = read_fitting_scan(stages, ScanSource(written(made, tmp_path / "worn.ply")))
    right = compare(there, points, scan)
    assert right.total.rms < 0.5
    found = calibrate(stages, scan, one_roll=True)
    assert found.is_improved
    assert found.after.total.rms < 1.05 * right.total.rms < found.before.total.rms
    numbers = {number.name: number for number in found.calibration.numbers}
    for name, expected in ((LINE_STIFFNESS, 8.0), (LOWER_FIRMNESS, 0.2)):
        assert abs(numbers[name].after - expected) < max(numbers[name].plus_minus, 0.1 * expected), name
    assert found.design.lower is not None
    assert found.design.lower.firmness == numbers[LOWER_FIRMNESS].after
