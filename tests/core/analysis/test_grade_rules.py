"""Means, increments and grade rules: values by hand, the rule that made the values, and honest gaps."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.analysis.grading.grade_rule import RuleFit, base_size, grade_rules
from core.analysis.grading.increments import BAND, CUP, increments
from core.analysis.grading.size_groups import Measure, SizeCode, SizedBodies, size_spreads, spread_of

WIRE = Measure("seam_wire_mm", "mm")
STUDENT_3, STUDENT_2 = 3.182446, 4.302653  # two-sided 95 % of Student's t, from a printed table


def bodies_of(sizes: list[tuple[int, int]], *columns: list[float]) -> SizedBodies:
    measures = (WIRE, *(Measure(f"seam_{at}_mm", "mm") for at in range(1, len(columns))))
    names = tuple(f"{at}.ply" for at in range(len(sizes)))
    return SizedBodies(names, np.array(sizes, dtype=np.int64), measures, np.array(columns).T)


def made_bodies(rng: np.random.Generator, count: int, noise: float) -> SizedBodies:
    """Draw bodies whose measure is 200 + 11 per band step + 7 per cup step, with noise."""
    sizes = np.column_stack([rng.integers(2, 7, count), rng.integers(1, 8, count)])
    values = 200.0 + sizes @ [11.0, 7.0] + rng.normal(0.0, noise, count)
    return SizedBodies(tuple(map(str, range(count))), sizes.astype(np.int64), (WIRE,), values[:, None])


def test_mean_deviation_and_standard_error_by_hand() -> None:
    found = spread_of([2.0, 4.0, 9.0, math.nan])
    assert (found.count, found.mean, found.least, found.most) == (3, 5.0, 2.0, 9.0)
    assert found.deviation == pytest.approx(math.sqrt((9.0 + 1.0 + 16.0) / 2.0))
    assert found.error == pytest.approx(math.sqrt(13.0 / 3.0))


def test_one_body_has_a_mean_and_no_uncertainty() -> None:
    found = spread_of([7.0])
    assert (found.mean, found.deviation, found.error) == (7.0, None, None)
    assert spread_of([math.nan]).mean is None


def test_each_body_is_in_one_size() -> None:
    bodies = bodies_of([(1, 2), (0, 5), (1, 2), (1, 3)], [1.0, 2.0, 3.0, 4.0])
    assert bodies.codes == (SizeCode(0, 5), SizeCode(1, 2), SizeCode(1, 3))
    assert bodies.group_of.tolist() == [1, 0, 1, 2]
    assert sum(each.spread.count for each in size_spreads(bodies)) == bodies.count
    assert sorted(at for code in bodies.codes for at in bodies.members(code)) == [0, 1, 2, 3]


def test_increments_are_differences_of_means_with_the_uncertainty_of_welch() -> None:
    bodies = bodies_of([(0, 0)] * 3 + [(0, 1)] * 3 + [(1, 0)], [10.0, 12.0, 14.0, 20.0, 20.5, 21.0, 40.0])
    cup, band = increments(bodies)
    assert (cup.part, cup.smaller, cup.larger, cup.counts) == (CUP, (0, 0), (0, 1), (3, 3))
    first, second = 4.0 / 3.0, 0.25 / 3.0  # variances of the means
    assert cup.value == pytest.approx(8.5)
    assert cup.error == pytest.approx(math.sqrt(first + second))
    freedom = (first + second) ** 2 / (first**2 / 2.0 + second**2 / 2.0)
    assert 2.0 < freedom < 3.0
    assert cup.interval is not None
    half = 0.5 * (cup.interval.high - cup.interval.low)
    assert STUDENT_3 * cup.error < half < STUDENT_2 * cup.error
    assert (band.part, band.value, band.error, band.interval) == (BAND, 28.0, None, None)


def test_sizes_that_are_not_neighbours_are_not_compared() -> None:
    assert not list(increments(bodies_of([(0, 0), (0, 2), (2, 0), (1, 1)], [1.0, 2.0, 3.0, 4.0])))


def test_a_rule_without_noise_is_found_exactly() -> None:
    (rule,) = grade_rules(made_bodies(np.random.default_rng(1), 40, 0.0))
    assert rule.per_band is not None
    assert rule.per_cup is not None
    assert rule.per_band.value == pytest.approx(11.0, abs=1e-9)
    assert rule.per_cup.value == pytest.approx(7.0, abs=1e-9)
    assert rule.at_base == pytest.approx(200.0 + 11.0 * rule.base.band + 7.0 * rule.base.cup, abs=1e-9)
    assert rule.explained == pytest.approx(1.0)


def test_intervals_contain_the_true_increments_as_often_as_they_promise() -> None:
    inside, trials = np.zeros(2), 400
    for seed in range(trials):
        (rule,) = grade_rules(made_bodies(np.random.default_rng(seed), 25, 6.0))
        for part, (step, true) in enumerate(((rule.per_band, 11.0), (rule.per_cup, 7.0))):
            assert step is not None
            assert step.interval is not None
            inside[part] += step.interval.contains(true)
    # 95 % of 400 trials, within three standard deviations of their number
    assert (np.abs(inside / trials - 0.95) < 3.0 * math.sqrt(0.95 * 0.05 / trials)).all()


def test_leaving_a_body_out_is_fitting_without_it() -> None:
    bodies = made_bodies(np.random.default_rng(3), 15, 5.0)
    values = bodies.values[:, 0].copy()
    values[4] = math.nan
    base, sizes = SizeCode(4, 4), np.array([(2, 1), (4, 4), (6, 7)])
    predicted = RuleFit(values, bodies.sizes, base).without_each(sizes, np.arange(15))
    for at in range(15):
        rest = values.copy()
        rest[at] = math.nan
        refitted = RuleFit(rest, bodies.sizes, base)
        expected = refitted.coefficients[0] + (sizes - base) @ refitted.coefficients[1:]
        assert predicted[at] == pytest.approx(expected)


def test_a_body_that_alone_decides_an_increment_is_not_predicted() -> None:
    bodies = bodies_of([(0, 0), (0, 0), (1, 0)], [1.0, 3.0, 9.0])
    predicted = RuleFit(bodies.values[:, 0], bodies.sizes, SizeCode(0, 0)).without_each(
        np.array([(0, 0), (1, 0)]), np.arange(3)
    )
    assert np.isnan(predicted[2]).all()
    assert predicted[0].tolist() == pytest.approx([3.0, 9.0])


def test_increments_that_the_bodies_do_not_determine_are_unknown() -> None:
    (one_band,) = grade_rules(bodies_of([(2, 0), (2, 1), (2, 2), (2, 2)], [1.0, 2.0, 3.0, 3.5]))
    assert one_band.per_band is None
    assert one_band.per_cup is not None
    (together,) = grade_rules(bodies_of([(0, 0), (1, 1), (2, 2), (3, 3)], [1.0, 2.0, 3.0, 4.5]))
    assert together.per_band is together.per_cup is None
    (exact,) = grade_rules(bodies_of([(0, 0), (1, 0), (0, 1)], [1.0, 2.0, 4.0]))
    assert exact.per_band is not None
    assert (exact.per_band.value, exact.per_band.interval) == (pytest.approx(1.0), None)
    (empty,) = grade_rules(bodies_of([(0, 0), (1, 0)], [math.nan, math.nan]))
    assert (empty.at_base, empty.count, empty.per_band, empty.explained) == (None, 0, None, None)


def test_increments_that_grow_with_the_size_are_noticed() -> None:
    rng = np.random.default_rng(5)
    sizes = np.column_stack([np.zeros(90, dtype=np.int64), np.repeat(np.arange(9), 10)])
    straight = 5.0 * sizes[:, 1] + rng.normal(0.0, 2.0, 90)
    values = np.column_stack([straight, straight + 0.6 * sizes[:, 1] ** 2])
    names = tuple(map(str, range(90)))
    even, curved = grade_rules(SizedBodies(names, sizes, (WIRE, Measure("seam_b_mm", "mm")), values))
    assert even.nonlinearity is not None
    assert curved.nonlinearity is not None
    assert even.nonlinearity > 0.05
    assert curved.nonlinearity < 0.001


def test_the_base_is_the_size_with_most_bodies_nearest_to_the_middle() -> None:
    sizes = [(0, 0), (0, 0), (2, 2), (2, 2), (3, 3), (4, 4)]
    assert base_size(bodies_of(sizes, [1.0] * 6)) == (2, 2)
