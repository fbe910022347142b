"""Differences of two designs on the same bodies: by hand, antisymmetric, every body in one outcome."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.analysis.comparison.paired import paired_difference, tradeoff

FIRST, SECOND = np.array([1.0, 2.0, 3.0, math.nan]), np.array([2.0, 2.05, 7.0, 5.0])


def test_differences_by_hand() -> None:
    found = paired_difference(FIRST, SECOND, 0.1)
    assert found is not None
    assert (found.count, found.more, found.equal, found.less) == (3, 2, 1, 0)
    assert found.mean == pytest.approx(5.05 / 3.0)
    deviation = math.sqrt(sum((each - 5.05 / 3.0) ** 2 for each in (1.0, 0.05, 4.0)) / 2.0)
    assert found.deviation == pytest.approx(deviation)
    assert found.interval is not None
    half = 4.302653 * deviation / math.sqrt(3.0)
    assert found.interval.high == pytest.approx(found.mean + half, rel=1e-6)
    assert found.quantiles == pytest.approx((0.05, 0.525, 1.0, 2.5, 4.0))


def test_exchanged_designs_have_the_opposite_difference() -> None:
    one, other = paired_difference(FIRST, SECOND, 0.1), paired_difference(SECOND, FIRST, 0.1)
    assert one is not None
    assert other is not None
    assert one.mean == -other.mean
    assert (one.more, one.less) == (other.less, other.more)


def test_one_body_has_no_interval_and_none_no_difference() -> None:
    found = paired_difference(np.array([1.0]), np.array([3.0]))
    assert found is not None
    assert (found.mean, found.deviation, found.interval) == (2.0, None, None)
    assert paired_difference(np.array([math.nan]), np.array([1.0])) is None


def test_more_lift_at_no_more_pressure_is_better() -> None:
    lift = np.array([3.0, 3.0, 0.0, -3.0, 3.0, 0.05, -3.0, math.nan])
    pressure = np.array([-0.5, 0.0, -0.5, 0.2, 0.2, 0.001, -0.5, 0.2])
    found = tradeoff(lift, pressure, (0.1, 0.01))
    assert np.flatnonzero(found.better).tolist() == [0, 1, 2]
    assert np.flatnonzero(found.worse).tolist() == [3]
    assert np.flatnonzero(found.mixed).tolist() == [4, 6]
    assert np.flatnonzero(found.same).tolist() == [5]
    assert found.count == 7
    assert found.gains_at_no_cost == 2
    assert found.counts.tolist() == [[1, 0, 1], [1, 1, 0], [1, 1, 1]]


def test_every_known_body_has_one_outcome() -> None:
    rng = np.random.default_rng(8)
    lift, pressure = rng.integers(-2, 3, (2, 300)).astype(float)
    found = tradeoff(lift, pressure, (0.5, 0.5))
    outcomes = np.array([found.better, found.worse, found.same, found.mixed])
    assert (outcomes.sum(axis=0) == 1).all()
    swapped = tradeoff(-lift, -pressure, (0.5, 0.5))
    assert (swapped.better == found.worse).all()
