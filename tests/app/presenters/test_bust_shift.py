"""How far the bust points went, in figures and in words."""

from __future__ import annotations

import numpy as np
import pytest

from app.presenters.bust_shift import (
    BustShift,
    BustStep,
    bust_sentence,
    mean_lifts,
    shift_between,
    step_text,
)
from core.mechanics.iteration import Observables

REST = Observables(300.0, 310.0, 320.0, 90.0, 80.0, 70.0)


def test_a_move_is_counted_from_the_body_before() -> None:
    move = shift_between(REST, Observables(304.0, 312.0, 400.0, 0.0, 79.0, 72.0))
    assert (move.left, move.right) == (BustStep(4.0, -1.0), BustStep(2.0, 2.0))
    assert move.mean == BustStep(3.0, 0.5), "the foremost place has no part in it"
    assert mean_lifts(REST, np.array([300.0, 304.0]), np.array([310.0, 312.0])).tolist() == [0.0, 3.0]


@pytest.mark.parametrize(
    ("step", "words"),
    [
        (BustStep(3.94, 2.06), "3.9 mm up, 2.1 mm forward"),
        (BustStep(-3.94, -13.1), "3.9 mm down, 13.1 mm back"),
        (BustStep(-0.04, -0.04), "0.0 mm up, 0.0 mm forward"),
    ],
)
def test_words_say_the_way_and_need_no_sign(step: BustStep, words: str) -> None:
    assert step_text(step) == words


def test_sides_are_told_apart_from_one_millimetre_on() -> None:
    near = BustShift(BustStep(3.0, 1.0), BustStep(2.0, 1.0))
    assert not near.differs
    assert bust_sentence(near) == "Bust points: 2.5 mm up, 1.0 mm forward"
    apart = BustShift(BustStep(3.0, 4.0), BustStep(2.0, -1.0))
    assert apart.differs
    assert bust_sentence(apart).endswith("2.5 mm up, 1.5 mm forward (left 4.0 mm forward, right 1.0 mm back)")
