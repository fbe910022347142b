"""Pieces on the screen: in the order of the body, without overlap, as large as they can be."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from app.presenters.pattern_layout import GAP, PieceShape, arranged, joined_at


def box(name: str, width: float, height: float, bearing: float, z: float) -> PieceShape:
    """A piece that is a rectangle, with its lower left corner anywhere."""
    x = 3.0 * bearing
    corners = np.array([[x, z], [x + width, z], [x + width, z + height], [x, z + height]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    sides = tuple((f"side {k}", np.array([k, (k + 1) % 4]), True) for k in range(4))
    return PieceShape(name, corners, faces, np.zeros(2), 0.1, sides, True, (bearing, z), np.zeros((2, 2)))


PIECES = (
    box("wing left", 150, 40, 2.0, -60),
    box("wing right", 150, 42, -2.0, -60),
    box("cup left", 90, 70, 0.5, 20),
    box("cup right", 92, 70, -0.5, 20),
    box("bridge", 50, 60, 0.0, -40),
)


@pytest.mark.parametrize("aspect", [0.3, 1.0, 3.0])
def test_pieces_do_not_touch_and_keep_their_order(aspect: float) -> None:
    moves = arranged(PIECES, aspect)
    low = {p.name: p.points.min(axis=0) + m for p, m in zip(PIECES, moves, strict=True)}
    high = {p.name: p.points.max(axis=0) + m for p, m in zip(PIECES, moves, strict=True)}
    for one, other in combinations(low, 2):
        apart = np.maximum(low[one] - high[other], low[other] - high[one]).max()
        assert apart >= GAP - 1e-9
    for kind in ("wing", "cup"):
        assert high[f"{kind} right"][0] < low[f"{kind} left"][0], "her right is at the left, as she is seen"
        middles = [0.5 * (low[f"{kind} {side}"][1] + high[f"{kind} {side}"][1]) for side in ("left", "right")]
        assert middles[0] == pytest.approx(middles[1], abs=1e-9)
    assert low["cup left"][1] >= low["wing left"][1], "from above"


def test_a_wide_room_takes_one_row_and_a_narrow_one_several() -> None:
    def size(aspect: float) -> np.ndarray:
        whole = np.concatenate([p.points + m for p, m in zip(PIECES, arranged(PIECES, aspect), strict=True)])
        return np.ptp(whole, axis=0)

    wide, narrow = size(12.0), size(0.3)
    assert wide[1] == pytest.approx(70.0)
    assert narrow[0] < 0.6 * wide[0]
    assert len(arranged((), 1.0)) == 0


def test_a_title_stands_within_its_piece() -> None:
    """A cradle is a hook: its middle lies outside."""
    turn = np.linspace(0.0, np.pi, 13)
    outer, inner = (r * np.stack([np.cos(turn), np.sin(turn)], axis=1) for r in (60.0, 40.0))
    points = np.concatenate([outer, inner[::-1], 50.0 * np.stack([np.cos(turn), np.sin(turn)], axis=1)[1:-1]])
    ring = np.append(np.arange(26), 0)
    hook = PieceShape(
        "hook",
        points,
        np.zeros((0, 3), dtype=np.int64),
        np.zeros(0),
        0.1,
        (("edge", ring, True),),
        True,
        (0, 0),
        np.zeros((0, 2)),
    )
    assert 40.0 < np.hypot(*hook.label_place) < 60.0


@pytest.mark.parametrize("share", [0.0, 0.25, 0.9])
def test_two_pieces_are_laid_edge_to_edge_where_a_seam_is_walked(share: float) -> None:
    first, second = box("one", 80, 60, 0.0, 0.0), box("two", 50, 90, 7.0, 30.0)
    first = replace(
        first,
        sides=(("hem", np.array([0, 1]), True), *first.sides[1:]),
        partners=(("two", 1), None, None, None),
    )
    second = replace(
        second,
        sides=(second.sides[0], ("hem", np.array([1, 2]), False), *second.sides[2:]),
        partners=(None, ("one", 0), None, None),
    )
    one, two = joined_at([second, first], "hem", share)
    assert one is first
    here = one.points[0] + share * (one.points[1] - one.points[0])
    there = two.points[2] + share * (two.points[1] - two.points[2])
    assert there == pytest.approx(here)
    assert two.points[:, 1].max() == pytest.approx(0.0), "below the edge that it is sewn to"
    assert np.ptp(two.points, axis=0) == pytest.approx([90.0, 50.0]), "turned, not stretched"
    assert joined_at([second, first], "side 2", share) == (), "an edge has no other piece"
