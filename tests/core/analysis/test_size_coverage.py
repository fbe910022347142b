"""Whom sizes serve, and how few serve a share: against all choices, each body counted once."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest

from core.analysis.grading import coverage as module
from core.analysis.grading.coverage import coverage, greedy, lower_bound
from core.analysis.grading.service import MEAN, RULE, service_of
from core.analysis.grading.size_groups import Measure, SizedBodies
from core.analysis.grading.tolerance import LEAST_MM, ComparedBodies

MEASURES = (Measure("cut_length_band_mm", "mm"), Measure("seam_wire_mm", "mm"))


def bodies_of(values: np.ndarray, sizes: np.ndarray | None = None) -> SizedBodies:
    count = len(values)
    sizes = np.zeros((count, 2), dtype=np.int64) if sizes is None else sizes
    measures = MEASURES[: values.shape[1]]
    return SizedBodies(tuple(map(str, range(count))), sizes, measures, values.astype(np.float64))


def compared(values: np.ndarray, tolerance: float = 0.03) -> ComparedBodies:
    return ComparedBodies(bodies_of(values), np.full(values.shape[1], tolerance))


def drawn(seed: int, count: int) -> ComparedBodies:
    rng = np.random.default_rng(seed)
    return compared(rng.uniform((600.0, 200.0), (750.0, 260.0), (count, 2)), 0.06)


def fewest(serves: np.ndarray, needed: int) -> int:
    """Try all choices of candidates, the small ones first."""
    for count in range(1, len(serves) + 1):
        for chosen in combinations(range(len(serves)), count):
            if serves[list(chosen)].any(axis=0).sum() >= needed:
                return count
    raise AssertionError


@pytest.mark.parametrize("seed", range(12))
def test_no_choice_needs_fewer_sizes(seed: int) -> None:
    bodies = drawn(seed, 13)
    serves = bodies.excess(np.arange(len(bodies.lengths))) <= 1.0
    for share in (0.6, 0.9, 1.0):
        found = coverage(bodies, share)
        assert found is not None
        assert found.is_smallest
        assert len(found.sizes) == fewest(serves, math.ceil(share * 13))
        assert found.served >= found.needed == math.ceil(share * 13)
        order, _ = greedy(serves)
        assert lower_bound(serves, order, found.needed) <= len(found.sizes)


def test_a_choice_one_by_one_is_improved_where_it_is_not_the_smallest() -> None:
    bodies = drawn(25, 9)
    serves = bodies.excess(np.arange(len(bodies.lengths))) <= 1.0
    assert len(greedy(serves)[0]) == 4
    found = coverage(bodies, 1.0)
    assert found is not None
    assert (len(found.sizes), found.is_smallest) == (3, True)


@pytest.mark.parametrize("exact", [400, 0])
def test_each_body_is_counted_once(exact: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_EXACT", exact)
    bodies = drawn(4, 60)
    found = coverage(bodies, 0.9)
    assert found is not None
    served = [at for size in found.sizes for at in size.serves]
    assert len(served) == len(set(served)) == found.served >= 54
    excess = bodies.excess(np.arange(len(bodies.lengths)))
    for size in found.sizes:
        assert size.body in size.serves
        assert (excess[size.body, list(size.serves)] <= 1.0).all()
    assert found.least <= len(found.sizes)
    assert np.all(np.diff(found.curve) > 0.0)
    assert found.curve[-1] == 1.0


def test_equal_bodies_need_one_size_and_strangers_one_each() -> None:
    found = coverage(compared(np.full((20, 2), 500.0)), 0.9)
    assert found is not None
    assert (len(found.sizes), found.served, found.held_out) == (1, 20, 1.0)
    found = coverage(compared(np.geomspace(100.0, 9000.0, 20)[:, None]), 0.9)
    assert found is not None
    assert (len(found.sizes), found.held_out) == (18, 0.0)


def test_many_bodies_are_a_sample_and_the_answer_repeats(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MOST_BODIES", 50)
    first, second = (coverage(drawn(2, 120), 0.9) for _ in range(2))
    assert first == second
    assert first is not None
    assert first.sampled
    assert first.count == 50
    assert max(at for size in first.sizes for at in size.serves) >= 50, "places are those among all bodies"


def test_bodies_without_a_measure_are_not_compared() -> None:
    values = np.array([[500.0, 200.0], [505.0, math.nan], [502.0, 201.0]])
    bodies = compared(values)
    assert bodies.complete.tolist() == [True, False, True]
    found = coverage(bodies, 1.0)
    assert found is not None
    assert found.count == 2
    service = service_of(bodies, MEAN)
    assert [each.by_own for each in service.bodies] == [True, None, True]
    assert service.bodies[1].lacking == MEASURES[1]
    assert coverage(compared(np.full((3, 2), math.nan)), 0.9) is None


def test_a_short_seam_need_not_agree_better_than_it_is_sewn() -> None:
    bodies = compared(np.array([[20.0], [20.0 + 0.9 * LEAST_MM], [20.0 + 1.1 * LEAST_MM]]))
    assert (bodies.excess(np.arange(len(bodies.lengths)))[0] <= 1.0).tolist() == [True, True, False]


def test_an_area_counts_as_a_length() -> None:
    area = (Measure("area_cup_cm2", "cm2"),)
    sizes = np.zeros((2, 2), dtype=np.int64)
    bodies = SizedBodies(("a", "b"), sizes, area, np.array([[400.0], [400.0 * 1.04**2]]))
    excess = ComparedBodies(bodies, np.array([0.05])).excess(np.arange(2))
    assert excess[0].tolist() == pytest.approx([0.0, 0.04 / 1.04 / 0.05])


def test_measures_that_do_not_decide_are_left_out() -> None:
    values = np.array([[500.0, 100.0], [500.0, 900.0]])
    bodies = ComparedBodies(bodies_of(values), np.array([0.03, math.nan]))
    assert bodies.measures == MEASURES[:1]
    found = coverage(bodies, 1.0)
    assert found is not None
    assert len(found.sizes) == 1


def test_a_garment_of_a_size_never_contains_the_body_itself() -> None:
    values = np.array([[500.0], [520.0], [900.0]])
    sizes = np.array([(0, 0), (0, 0), (1, 1)])
    service = service_of(ComparedBodies(bodies_of(values, sizes), np.array([0.05])), MEAN)
    first, second, single = service.bodies
    assert first.own is not None
    assert (first.own.garment, first.own.body, first.by_own) == (520.0, 500.0, True)
    assert second.own is not None
    assert second.own.excess == pytest.approx(20.0 / 26.0)
    assert (single.own, single.by_own) == (None, None), "its size has no other body"
    assert single.best is not None
    assert (single.best_code, single.by_best) == ((0, 0), False)
    assert service.within(MEASURES[0]) == 1.0
    assert service.within(MEASURES[1]) is None


def test_the_measure_that_deviates_most_is_named() -> None:
    values = np.array([[500.0, 200.0], [510.0, 240.0]])
    service = service_of(compared(values), MEAN)
    own = service.bodies[0].own
    assert own is not None
    assert (own.measure, own.garment, own.body) == (MEASURES[1], 240.0, 200.0)
    assert own.excess == pytest.approx(40.0 / 6.0)
    assert service.within(MEASURES[0]) == 1.0
    assert service.within(MEASURES[1]) == 0.0


def test_garments_by_the_rule_reach_sizes_with_one_body() -> None:
    sizes = np.array([(band, cup) for band in range(3) for cup in range(3)])
    values = (500.0 + sizes @ [30.0, 8.0])[:, None]
    bodies = ComparedBodies(bodies_of(values, sizes), np.array([0.03]))
    assert [each.by_own for each in service_of(bodies, RULE).bodies] == [True] * 9
    assert [each.own for each in service_of(bodies, MEAN).bodies] == [None] * 9
