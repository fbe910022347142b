"""Steps that know how figures and limits bend, against what is known of circles and of quadratic figures."""

from __future__ import annotations

import numpy as np
import pytest

from core.analysis.inverse_design.quadratic_model import QuadraticModel, next_trust_radius, updated_curvature

RNG = np.random.default_rng(4)


def quadratic(rows: int, p: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    bends = RNG.normal(size=(rows, p, p))
    return RNG.normal(size=rows), RNG.normal(size=(rows, p)), bends + bends.transpose(0, 2, 1)


def test_what_is_learnt_tells_how_slopes_turned_and_stays_symmetric() -> None:
    _, _, true = quadratic(5, 3)
    bends = np.zeros_like(true)
    for step in (*np.eye(3), *RNG.normal(size=(40, 3))):
        bends = updated_curvature(bends, step, true @ step)
        assert bends @ step == pytest.approx(true @ step)
        assert bends == pytest.approx(bends.transpose(0, 2, 1))
    assert bends == pytest.approx(true, abs=1e-6)


def test_rows_after_a_step_are_those_of_the_quadratic() -> None:
    rows, slopes, bends = quadratic(4, 2)
    step = np.array([0.3, -0.7])
    after, turned = QuadraticModel(rows, slopes, bends, 2).at_step(step)
    assert after == pytest.approx(rows + slopes @ step + 0.5 * np.einsum("rij,i,j->r", bends, step, step))
    assert turned == pytest.approx(slopes + np.einsum("rij,j->ri", bends, step))


@pytest.mark.parametrize("wish", [(3.0, 2.0), (0.5, 4.0), (-3.0, -0.1)])
def test_the_nearest_within_a_bent_limit_is_found_at_once(wish: tuple[float, float]) -> None:
    """Within a circle of radius 1 the nearest to a place outside lies on the way there from its middle."""
    start = np.array([0.2, 0.1])
    rows = np.array([*(start - wish), 1.0 - start @ start])
    slopes = np.vstack([np.eye(2), -2.0 * start])
    bends = np.stack([np.zeros((2, 2)), np.zeros((2, 2)), -2.0 * np.eye(2)])
    step, left = QuadraticModel(rows, slopes, bends, 2).minimize(np.full(2, -8.0), np.full(2, 8.0))
    away = np.hypot(*wish)
    assert start + step == pytest.approx(np.array(wish) / away, abs=2e-3)
    assert left == pytest.approx((away - 1.0) ** 2, rel=0.1)  # a hair outside counts
    straight, _ = QuadraticModel(rows, slopes, np.zeros_like(bends), 2).minimize(
        np.full(2, -8.0), np.full(2, 8.0)
    )
    assert np.linalg.norm(start + straight) > 1.2  # which knows of no bend, and leaves the circle


def test_a_step_stays_between_its_ends() -> None:
    rows, slopes, bends = quadratic(6, 3)
    step, left = QuadraticModel(np.abs(rows), slopes, bends, 3).minimize(np.full(3, -0.2), np.zeros(3))
    assert (step >= -0.2).all()
    assert (step <= 0.0).all()
    assert left <= QuadraticModel(np.abs(rows), slopes, bends, 3).violation(np.zeros(3))


def test_only_what_was_told_to_a_hair_makes_steps_bolder_than_at_first() -> None:
    assert next_trust_radius(8.0, 8.0, 0.999) == 16.0
    assert next_trust_radius(8.0, 8.0, 0.9) == 8.0
    assert next_trust_radius(2.0, 8.0, 0.9) == 4.0
    assert next_trust_radius(2.0, 8.0, 0.05) == 1.0
