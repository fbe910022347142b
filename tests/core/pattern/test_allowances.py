"""Cut lines: their widths, corners and blends by hand values, and what holds for any outline."""

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from made_pieces import made_pieces

from core.errors import PatternError
from core.pattern.allowance import BLEND, CLOSED, MITRE, cut_piece
from core.pattern.piece import Piece, Side, signed_area


def piece_of(*sides: tuple[list[tuple[float, float]], float]) -> Piece:
    """A piece of straight stretches: corners of each side but its last, and its allowance."""
    starts = [np.array(points, dtype=float) for points, _ in sides]
    closed = [np.vstack([a, b[:1]]) for a, b in zip(starts, [*starts[1:], starts[0]], strict=True)]
    return Piece("part", "", "cloth", 1, tuple(Side(f"s{k}", p, sides[k][1]) for k, p in enumerate(closed)))


def cut_of(piece: Piece) -> shapely.Polygon:
    return shapely.Polygon(cut_piece(piece).cut)


def test_a_rectangle_gets_right_corners_between_sides_of_different_width():
    piece = piece_of(([(0, 0)], 10), ([(100, 0)], 6), ([(100, 50)], 10), ([(0, 50)], 0))
    expected = shapely.box(0, -10, 106, 60)
    assert cut_of(piece).symmetric_difference(expected).area < 1e-6
    assert len(cut_piece(piece).cut) == 4


def test_a_hollow_corner_has_one_corner_too():
    corners = [(0, 0), (100, 0), (100, 40), (40, 40), (40, 100), (0, 100)]
    widths = [6, 6, 12, 4, 6, 6]
    piece = piece_of(*(([corner], width) for corner, width in zip(corners, widths, strict=True)))
    expected = shapely.Polygon([(-6, -6), (106, -6), (106, 52), (44, 52), (44, 106), (-6, 106)])
    assert cut_of(piece).symmetric_difference(expected).area < 1e-6


def test_where_a_wide_side_meets_a_narrow_one_in_a_flat_hollow_no_tooth_is_left():
    piece = piece_of(([(0, 0), (100, 0), (100, 60)], 6), ([(60, 60), (30, 90)], 15), ([(0, 90)], 6))
    ring = cut_piece(piece).cut
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    turns = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], (before * after).sum(axis=1))
    assert (turns < 0.0).sum() == 1, "one hollow corner"


def test_a_sharp_corner_is_cut_off_square_to_its_middle():
    height = 20.0
    piece = piece_of(([(0, 0)], 5), ([(200, -height)], 5), ([(200, height)], 5))
    ring = cut_piece(piece).cut
    tip = ring[ring[:, 0] < 0.0]
    assert tip[:, 0] == pytest.approx([-MITRE * 5.0] * 2)
    assert len(tip) == 2


def test_two_widths_blend_on_the_narrower_side_of_a_straight_edge():
    piece = piece_of(([(0, 0)], 6), ([(100, 0)], 12), ([(200, 0), (200, 60)], 6), ([(0, 60)], 6))
    ring = cut_of(piece).exterior
    for x, width in ((20, 6), (100 - BLEND, 6), (100 - BLEND / 2, 9), (100, 12), (150, 12)):
        down = shapely.LineString([(x, 0), (x, -30)]).intersection(ring)
        assert -down.y == pytest.approx(width, abs=1e-6)


def test_allowances_that_only_touch_leave_no_crack():
    """A slot of twice the allowance: the two strips meet in its middle, which once was open."""
    piece = piece_of(
        ([(0, 0), (100, 0), (100, 80), (56, 80)], 6), ([(56, 20), (44, 20)], 6), ([(44, 80), (0, 80)], 6)
    )
    cut = cut_of(piece)
    assert shapely.distance(cut.exterior, shapely.Polygon(piece.outline).exterior) == pytest.approx(6.0)
    assert len(cut.interiors) == 0


def test_an_outline_that_overlaps_itself_is_refused():
    with pytest.raises(PatternError, match="'part' overlaps itself"):
        cut_piece(piece_of(([(0, 0), (100, 50)], 6), ([(100, 0), (0, 50)], 6)))
    with pytest.raises(PatternError, match="overlaps itself"):
        cut_piece(piece_of(([(0, 0), (0, 50)], 6), ([(100, 50), (100, 0)], 6)))


def test_an_outline_with_a_gap_is_refused():
    sides = piece_of(([(0, 0)], 6), ([(100, 0)], 6), ([(50, 60)], 6)).sides
    with pytest.raises(PatternError, match="not closed"):
        Piece("part", "", "cloth", 1, sides[:2])


@st.composite
def outlines(draw: st.DrawFn) -> Piece:
    """Star-shaped outlines with bays and points, their sides of any width."""
    count = draw(st.integers(5, 24))
    radii = draw(st.lists(st.floats(18.0, 120.0), min_size=count, max_size=count))
    shifts = draw(st.lists(st.floats(0.1, 0.9), min_size=count, max_size=count))
    angles = 2.0 * np.pi * (np.arange(count) + np.array(shifts)) / count
    places = np.array(radii)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    ends = sorted(draw(st.sets(st.integers(1, count - 1), max_size=4)))
    widths = draw(st.lists(st.floats(0.0, 20.0), min_size=len(ends) + 1, max_size=len(ends) + 1))
    stretches = np.split(places, ends)
    return piece_of(*((part.tolist(), width) for part, width in zip(stretches, widths, strict=True)))


def test_a_long_point_on_a_round_outline_keeps_its_allowance_all_round():
    """The union of its strips once lost some of them: they are nearly, but not quite, on each other."""
    angles = np.radians(10.0 + 20.0 * np.arange(17))
    round_part = 18.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    piece = piece_of(([*round_part.tolist(), (81.3273646, -10.481401)], 1.0))
    assert cut_of(piece).exterior.distance(shapely.Polygon(piece.outline).exterior) >= 0.998


def test_corners_of_a_sew_line_without_allowance_are_those_of_the_cut_line():
    """Where points of the cut line were left out, a strip 0.0008 mm wide was once outside."""
    bare = [(91.15183249, 26.7645929), (20.30068275, 23.4282368)]
    narrow = [
        (14.08916899, 97.99232275),
        (-10.4891292, 22.9682079),
        (-15.1425636, 9.73153471),
        (-18.0, 0.0),
        (-15.1425636, -9.73153471),
        (-7.47747023, -16.3733759),
        (2.56166709, -17.816786),
        (11.7874932, -13.6034923),
        (17.2708735, -5.07118602),
    ]
    piece = piece_of((bare, 0.0), (narrow, 0.125))
    cut = cut_of(piece)
    assert shapely.Polygon(piece.outline).difference(cut).area < 1e-3
    for corner in bare:
        assert cut.exterior.distance(shapely.Point(corner)) < 1e-5


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(outlines())
def test_any_piece_is_inside_its_cut_line_by_its_smallest_allowance_and_not_far(piece: Piece):
    sewn, cut = shapely.Polygon(piece.outline), cut_of(piece)
    widths = [side.allowance for side in piece.sides]
    assert cut.is_valid
    assert signed_area(cut_piece(piece).cut) > 0.0
    assert sewn.difference(cut).area < 0.01
    assert sewn.exterior.distance(cut.exterior) >= min(widths) - 0.002
    far = max(shapely.distance(sewn, shapely.Point(each)) for each in cut.exterior.coords)
    assert far <= np.hypot(MITRE, 1.0) * max(widths) + 2.0 * CLOSED, "the corners of a bevel"


@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(outlines())
def test_each_side_has_at_least_its_own_allowance_along_its_middle(piece: Piece):
    cut = cut_of(piece)
    for side in piece.sides:
        place, out = side.place(0.5)
        assert cut.buffer(1e-3).covers(shapely.LineString([place, place + side.allowance * out]))


def test_the_made_pieces_have_the_allowance_of_each_side_along_it():
    for piece in made_pieces():
        cut = cut_of(piece)
        for side in piece.sides:
            place, _ = side.place(0.5)
            assert cut.exterior.distance(shapely.Point(place)) == pytest.approx(side.allowance, abs=0.05)


@pytest.mark.parametrize("angle", [0.3, 1.7, 4.0])
def test_a_piece_that_is_turned_and_moved_has_the_same_cut_line(angle: float):
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    piece = made_pieces()[4]

    def move(places: np.ndarray) -> np.ndarray:
        return places @ turn + np.array([31.0, -7.0])

    moved = shapely.Polygon(move(cut_piece(piece).cut))
    assert cut_of(piece.moved(move)).symmetric_difference(moved).area < 0.01
