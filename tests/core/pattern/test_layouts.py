"""Layouts and tiles: nothing overlaps, everything is on paper; words and arrows stay inside their pieces."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from made_pieces import bridge, made_pieces

from core.pattern.allowance import CutPiece, cut_piece, sew_shape
from core.pattern.annotation import annotate, piece_words, text_width
from core.pattern.layout import (
    APART,
    OVERLAP,
    PAPERS,
    SQUARE,
    SQUARE_ROOM,
    Layout,
    cut_shape,
    lay_out,
    lay_out_on_tiles,
    whole_sheet,
)
from core.pattern.mirroring import merge_mirrored
from core.pattern.piece import Piece, Side

WORDS = ("Lower cup, left", "Cup tricot, stable", "cut 1", "Customer 0412", "2026-11-26")


@pytest.fixture(scope="module")
def pieces() -> list[CutPiece]:
    return [cut_piece(each) for each in made_pieces()]


def box(wide: float, high: float) -> CutPiece:
    corners = np.array([[0.0, 0.0], [wide, 0.0], [wide, high], [0.0, high], [0.0, 0.0]])
    return cut_piece(Piece("box", "", "cloth", 1, (Side("edge", corners, 5.0),)))


def square_of(layout: Layout) -> shapely.Polygon:
    return shapely.box(*layout.square, *(layout.square + SQUARE))


def assert_is_free(layout: Layout) -> None:
    shapes = [cut_shape(each) for each in layout.pieces]
    for k, one in enumerate(shapes):
        assert one.distance(square_of(layout)) > 0.0
        assert all(one.distance(other) >= APART - 1e-5 for other in shapes[k + 1 :])
    everything = shapely.union_all([*shapes, square_of(layout)])
    assert shapely.box(0.0, -layout.height, layout.width, 0.0).buffer(1e-6).covers(everything)


@pytest.mark.parametrize("width", [260.0, 600.0, 1400.0])
def test_pieces_lie_apart_on_a_width_with_the_square_in_a_free_place(pieces, width):
    layout = lay_out(pieces, width)
    assert_is_free(layout)
    assert layout.width <= width
    assert [each.piece.key for each in layout.pieces] == [each.piece.key for each in pieces]
    for before, after in zip(pieces, layout.pieces, strict=True):
        shift = after.cut[0] - before.cut[0]
        np.testing.assert_allclose(after.cut, before.cut + shift, atol=1e-9)
        np.testing.assert_allclose(after.notches, before.notches + shift, atol=1e-9)


def test_the_square_takes_no_room_of_its_own_where_there_is_a_free_corner(pieces):
    tall = max(float(np.ptp(each.cut[:, 1])) for each in pieces)
    assert lay_out(pieces, 4000.0).height < tall + 20.0


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.tuples(st.floats(20.0, 420.0), st.floats(20.0, 420.0)), min_size=1, max_size=8),
    st.sampled_from(sorted(PAPERS)),
)
def test_any_pieces_are_whole_on_the_tiles_and_the_square_on_one(sizes, paper):
    tiling = lay_out_on_tiles([box(*size) for size in sizes], PAPERS[paper])
    assert_is_free(tiling.layout)
    windows = [shapely.box(*each.window) for each in tiling.tiles]
    paper_area = shapely.union_all(windows).buffer(1e-6)
    assert all(paper_area.covers(cut_shape(each)) for each in tiling.layout.pieces)
    assert any(each.buffer(1e-6).covers(square_of(tiling.layout)) for each in windows)
    assert len({each.name for each in tiling.tiles}) == len(tiling.tiles) <= tiling.rows * tiling.columns


def test_neighbouring_tiles_overlap_as_far_as_they_are_glued(pieces):
    tiling = lay_out_on_tiles(pieces, PAPERS["letter"])
    for one in tiling.tiles:
        assert one.window[2] - one.window[0] == pytest.approx(tiling.size[0] - 20.0)
        assert one.window[3] - one.window[1] == pytest.approx(tiling.size[1] - 20.0)
        for other in tiling.tiles:
            if (other.row, other.column) == (one.row + 1, one.column):
                assert other.window[3] - one.window[1] == pytest.approx(OVERLAP)
            if (other.row, other.column) == (one.row, one.column + 1):
                assert one.window[2] - other.window[0] == pytest.approx(OVERLAP)


def test_larger_paper_needs_fewer_sheets_and_sheets_without_a_piece_are_left_out(pieces):
    merged = [cut_piece(each) for each in merge_mirrored(made_pieces())]
    counts = {name: len(lay_out_on_tiles(merged, size).tiles) for name, size in PAPERS.items()}
    assert counts == {"a4": 4, "a3": 2, "letter": 4}
    small = lay_out_on_tiles([box(100.0, 60.0)], PAPERS["a4"])
    assert len(small.tiles) == 1


def test_one_sheet_is_as_large_as_the_layout(pieces):
    sheet = whole_sheet(pieces, 900.0)
    assert len(sheet.tiles) == 1
    assert sheet.size == pytest.approx((sheet.layout.width + 20.0, sheet.layout.height + 20.0))
    assert SQUARE_ROOM[0] > SQUARE


def room_of_words(lines: tuple[str, ...], bases: np.ndarray, size: float) -> shapely.Polygon:
    boxes = [
        shapely.box(
            x - 0.5 * size * text_width(line), y - 0.25 * size, x + 0.5 * size * text_width(line), y + size
        )
        for line, (x, y) in zip(lines, bases, strict=True)
    ]
    return shapely.union_all(boxes)


def test_words_and_arrows_are_inside_the_sew_line_and_beside_each_other(pieces):
    for cut in pieces:
        note, shape = annotate(cut, WORDS), sew_shape(cut.piece)
        words = room_of_words(note.lines, note.bases, note.size)
        grain, stretch = shapely.LineString(note.grain), shapely.LineString(note.stretch)
        assert "".join(note.lines).replace(" ", "") == "".join(WORDS).replace(" ", ""), "nothing is left out"
        assert all(shape.covers(each) for each in (words, grain, stretch))
        assert not words.intersects(grain)
        assert not words.intersects(stretch)
        assert not grain.intersects(stretch)
        assert grain.length >= 20.0
        assert stretch.length >= 12.0
        assert np.ptp(note.grain[:, 0]) == pytest.approx(0.0, abs=1e-9)
        assert np.ptp(note.stretch[:, 1]) == pytest.approx(0.0, abs=1e-9)


def test_arrows_follow_the_grain_of_the_piece():
    way = (float(np.sin(0.5)), float(np.cos(0.5)))
    turned = replace(made_pieces()[2], grain=way, stretch=(way[1], -way[0]))
    note = annotate(cut_piece(turned), WORDS)
    for line, along in ((note.grain, way), (note.stretch, (way[1], -way[0]))):
        step = line[1] - line[0]
        assert abs(step @ np.array(along)) == pytest.approx(np.linalg.norm(step))


def test_lines_inside_a_piece_are_not_written_over():
    piece = made_pieces()[2]
    low, high = piece.outline.min(axis=0), piece.outline.max(axis=0)
    dart = np.array([[0.5 * (low[0] + high[0]), low[1]], [0.5 * (low[0] + high[0]), high[1] - 20.0]])
    note = annotate(cut_piece(replace(piece, internal=(("dart", dart),))), WORDS)
    assert not room_of_words(note.lines, note.bases, note.size).intersects(shapely.LineString(dart))


@pytest.mark.parametrize("cloth", ["Sheer tricot, no stretch", "薄地トリコット（伸びなし）"])
def test_long_words_are_broken_where_a_piece_is_narrow(cloth):
    lines = ("Bridge", cloth, "cut 1")
    note = annotate(cut_piece(bridge(62.3)), lines)
    assert "".join(note.lines).replace(" ", "") == "".join(lines).replace(" ", "")
    assert len(note.lines) > len(lines)


@pytest.mark.parametrize("size", [(8.0, 8.0), (3.0, 200.0), (200.0, 6.0), (30.0, 12.0)])
def test_a_tiny_piece_still_has_its_name(size):
    note = annotate(box(*size), WORDS)
    assert note.lines[0][:5] == WORDS[0][:5]
    assert np.isfinite([*note.centre, *note.grain.ravel(), *note.stretch.ravel()]).all()


def test_the_words_of_a_piece():
    both, middle = merge_mirrored(made_pieces())[0], bridge(60.0)
    assert piece_words(both, about=("Customer 0412", "")) == (
        "Upper cup",
        "Cup tricot, stable",
        "cut 2, mirrored",
        "Customer 0412",
    )
    assert piece_words(middle)[::2] == ("Bridge", "cut 1")
    assert piece_words(made_pieces()[1])[0] == "Upper cup, right"
