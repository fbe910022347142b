"""How far a section may be off is written beside its curves and not on them."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF

from app.gui.plots.section_plot import free_box

ROOM, WIDE = QRectF(34.0, 6.0, 210.0, 160.0), 46.0
OUT = np.array([1.0, 0.0])


def upright(x: float) -> np.ndarray:
    """A curve that goes straight down, (k, 2) [px]."""
    return np.stack([np.full(150, x), np.arange(10.0, 160.0)], axis=1)


def test_words_stand_outside_close_by_where_nothing_is() -> None:
    assert free_box(QPointF(100.0, 80.0), OUT, WIDE, ROOM, upright(100.0)).left() == 113.0


def test_words_step_aside_of_a_curve_and_of_a_bust_point() -> None:
    taken = np.concatenate([upright(100.0), upright(120.0), [[121.0, 80.0]]])
    box = free_box(QPointF(100.0, 80.0), OUT, WIDE, ROOM, taken)
    inside = (taken > [box.left(), box.top()]) & (taken < [box.right(), box.bottom()])
    assert not inside.all(axis=1).any()
    assert ROOM.contains(box)


def test_words_that_find_no_free_place_stay_within_the_plot() -> None:
    every = np.stack(np.meshgrid(np.arange(250.0), np.arange(170.0)), axis=-1).reshape(-1, 2)
    assert ROOM.contains(free_box(QPointF(230.0, 20.0), OUT, WIDE, ROOM, every))
