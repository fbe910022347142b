"""Pieces: left and right as one where they are the same, and sides that still find each other."""

from dataclasses import replace

import numpy as np
import pytest
from made_pieces import left_pieces, made_pieces

from core.pattern.mirroring import merge_mirrored
from core.pattern.notches import notched
from core.pattern.piece import BOTH, Piece, Side, mirrored, signed_area


def changed(piece: Piece, by: float, side: int = 0) -> Piece:
    """The piece with a bump of so many millimetres in the middle of a side."""
    points = piece.sides[side].points.copy()
    share = np.linspace(0.0, 1.0, len(points))
    points[:, 1] += by * np.sin(np.pi * share) ** 4
    sides = [*piece.sides]
    sides[side] = replace(sides[side], points=points)
    return replace(piece, sides=tuple(sides))


def with_other(pieces: tuple[Piece, ...], other: Piece) -> list[Piece]:
    return [other if each.key == other.key else each for each in pieces]


def test_mirror_images_are_one_piece_that_is_cut_twice():
    merged = merge_mirrored(made_pieces())
    assert [(each.name, each.side, each.count) for each in merged] == [
        ("upper cup", BOTH, 2),
        ("lower cup", BOTH, 2),
        ("cradle", BOTH, 2),
        ("wing", BOTH, 2),
        ("bridge", "", 1),
    ]
    known = {each.key: each for each in merged}
    for piece in merged:
        for number, side in enumerate(piece.sides):
            if side.partner is not None:
                other = known[side.partner[0]].sides[side.partner[1]]
                assert other.length == pytest.approx(side.length)
                assert other.partner[0] == piece.key
                assert other.partner[1] == number or piece.name == "bridge"


@pytest.mark.parametrize(("bump", "one"), [(0.0, True), (0.7, True), (1.6, False)])
def test_sides_are_one_piece_where_they_differ_by_less_than_a_millimetre_anywhere(bump, one):
    pieces = made_pieces()
    merged = merge_mirrored(with_other(pieces, changed(pieces[3], bump, side=1)))
    names = [each.key for each in merged]
    assert ("lower cup" in names) == one
    assert ("lower cup right" in names) == (not one)


def test_pieces_that_stay_apart_are_sewn_to_what_was_merged():
    pieces = made_pieces()
    other = changed(pieces[1], 5.0, side=2)  # the strap end, an edge
    known = {each.key: each for each in merge_mirrored(with_other(pieces, other))}
    left, right = known["upper cup left"], known["upper cup right"]
    assert left.sides[0].partner == right.sides[3].partner == ("lower cup", 1)
    assert known["lower cup"].sides[1].partner == ("upper cup left", 0)
    for side in (left.sides[0], right.sides[3]):
        assert known["lower cup"].sides[1].length == pytest.approx(side.length, abs=0.05)


@pytest.mark.parametrize(("other_lower", "one"), [(1.003, True), (1.02, False)])
def test_pieces_are_one_only_where_what_is_sewn_to_them_still_fits(other_lower, one):
    pieces = [*made_pieces()]
    for number, size in ((1, 1.003), (3, other_lower)):
        pieces[number] = pieces[number].moved(lambda places, size=size: size * places)
    names = {each.key for each in merge_mirrored(pieces)}
    assert ("upper cup" in names) == ("lower cup" in names) == one, "0.6 mm longer at the cup seam"


def test_other_allowances_cloths_or_grain_keep_them_apart():
    pieces = made_pieces()
    right = pieces[1]
    wider = replace(right, sides=(replace(right.sides[0], allowance=9.0), *right.sides[1:]))
    leaning = replace(right, grain=(float(np.sin(0.1)), float(np.cos(0.1))))
    for other in (wider, leaning, replace(right, cloth="Stretch lace"), replace(right, count=2)):
        assert "upper cup right" in {each.key for each in merge_mirrored(with_other(pieces, other))}


def test_a_piece_that_lies_elsewhere_or_begins_at_another_side_is_the_same():
    pieces = made_pieces()
    angle = 0.02
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    other = pieces[1].moved(lambda places: places @ turn + np.array([500.0, 20.0]))
    assert merge_mirrored(with_other(pieces, other))[0].side == BOTH
    begun = replace(pieces[1], sides=(*pieces[1].sides[2:], *pieces[1].sides[:2]))
    alone = [
        replace(each, sides=tuple(replace(s, partner=None) for s in each.sides))
        for each in (pieces[0], begun)
    ]
    assert [each.side for each in merge_mirrored(alone)] == [BOTH]


def test_mirroring_twice_changes_nothing_and_keeps_the_face_up():
    for piece in made_pieces():
        flat, again = mirrored(piece), mirrored(mirrored(piece))
        assert signed_area(flat.outline) == pytest.approx(piece.area)
        assert again.side == piece.side
        for a, b in zip(piece.sides, again.sides, strict=True):
            np.testing.assert_allclose(a.points, b.points)
            assert a.notches == pytest.approx(b.notches)


def test_a_place_on_a_side_and_the_way_out_of_the_piece():
    side = Side("edge", np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 10.0]]), 6.0)
    for share, place, out in ((0.0, (0, 0), (0, -1)), (0.5, (20, 0), (0, -1)), (1.0, (30, 10), (1, 0))):
        found = side.place(share)
        np.testing.assert_allclose(found[0], place, atol=1e-12)
        np.testing.assert_allclose(found[1], out, atol=1e-12)


def test_notches_before_merging_and_after_are_the_same():
    once = merge_mirrored(made_pieces())
    left = {each.name: each for each in notched(made_pieces()) if each.side != "right"}
    for piece in once:
        assert [s.notches for s in piece.sides] == [s.notches for s in left[piece.name].sides]
    assert len(left_pieces()) + 1 == len(once)
