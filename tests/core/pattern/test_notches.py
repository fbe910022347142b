"""Notches meet when they are sewn, are never symmetric, and mirror each other on both sides of the body."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from made_pieces import left_pieces, made_pieces, outline, seam

from core.pattern.allowance import cut_piece
from core.pattern.notches import DOUBLE, SHARES, SHORT_SHARE, notched, seam_share
from core.pattern.piece import Piece, mirrored


def strips(length: float, other: float, name: str = "seam") -> tuple[Piece, Piece]:
    """Two pieces that are sewn along one side, as long as asked for."""
    pieces = []
    for key, partner, long in (("one", "two", length), ("two", "one", other)):
        sides = outline(
            (name, np.array([[0.0, 0.0], [long, 0.0]]), 6.0, (partner, 0)),
            ("end", np.array([[long, 0.0], [long, 40.0]]), 6.0, None),
            ("rest", np.array([[long, 40.0], [0.0, 40.0], [0.0, 0.0]]), 6.0, None),
        )
        pieces.append(Piece(key, "", "cloth", 1, sides))
    return pieces[0], pieces[1]


def test_the_notches_of_a_seam_meet_when_it_is_sewn():
    known = {piece.key: piece for piece in made_pieces()}
    pairs = 0
    for piece in known.values():
        for side in piece.sides:
            if side.partner is None:
                assert side.notches == ()
                continue
            other = known[side.partner[0]].sides[side.partner[1]]
            ours = np.array(side.notches) * side.length
            theirs = other.length - np.array(other.notches)[::-1] * other.length
            np.testing.assert_allclose(ours, theirs, atol=0.1)
            pairs += len(ours)
    assert pairs == 2 * 2 * (2 + 2 + 2 + 3), (
        "cup, wire, bridge and side seams, on both pieces, left and right"
    )


def test_an_eased_seam_has_its_notches_in_proportion():
    one, two = notched(strips(200.0, 190.0))
    assert one.sides[0].notches == SHARES
    assert two.sides[0].notches == pytest.approx((1.0 - SHARES[1], 1.0 - SHARES[0]))


def test_notches_are_never_symmetric():
    for piece in made_pieces():
        for side in piece.sides:
            ours = np.array(side.notches)
            if len(ours):
                assert np.abs(np.sort(1.0 - ours) - np.sort(ours)).max() * side.length > 4.5


@pytest.mark.parametrize(("length", "expected"), [(19.0, ()), (21.0, (SHORT_SHARE,)), (59.0, (SHORT_SHARE,))])
def test_short_seams_have_one_notch_or_none(length, expected):
    assert notched(strips(length, length))[0].sides[0].notches == expected


def test_the_last_notch_of_a_seam_at_the_back_is_double():
    one, two = notched(strips(100.0, 100.0, "side seam back"))
    places = np.array(one.sides[0].notches) * 100.0
    assert places == pytest.approx([30.0, 62.0 - DOUBLE / 2.0, 62.0 + DOUBLE / 2.0])
    assert len(two.sides[0].notches) == 3


def test_right_pieces_are_mirror_images_with_their_notches_whatever_the_order_of_pieces():
    for order in (1, -1):
        pieces = notched([replace(each, sides=each.sides) for each in made_pieces()[::order]])
        known = {piece.key: piece for piece in pieces}
        for left in left_pieces():
            one, two = known[left.key], mirrored(known[f"{left.name} right"])
            for a, b in zip(one.sides, two.sides, strict=True):
                assert a.name == b.name
                assert a.notches == pytest.approx(b.notches)


def test_edges_keep_the_notches_that_they_have():
    one, two = strips(100.0, 100.0)
    marked = replace(one, sides=(one.sides[0], replace(one.sides[1], notches=(0.25,)), one.sides[2]))
    assert notched([marked, two])[0].sides[1].notches == (0.25,)


def test_a_seam_whose_other_piece_is_not_there_has_none_and_harms_nothing():
    one, _ = strips(100.0, 100.0)
    assert notched([one])[0].sides[0].notches == ()


def test_marks_lead_from_the_cut_line_inward_and_end_in_the_allowance():
    for piece in made_pieces():
        cut = cut_piece(piece)
        ring, sewn = shapely.Polygon(cut.cut).exterior, shapely.Polygon(piece.outline)
        assert len(cut.notches) == sum(len(side.notches) for side in piece.sides)
        for mark in cut.notches:
            assert ring.distance(shapely.Point(mark[0])) < 1e-6
            assert np.linalg.norm(mark[1] - mark[0]) == pytest.approx(4.0)
            assert sewn.distance(shapely.Point(mark[1])) == pytest.approx(6.5 - 4.0, abs=0.05)


def test_without_allowance_a_mark_leads_into_the_piece():
    butted = notched(
        [replace(p, sides=tuple(replace(s, allowance=0.0) for s in p.sides)) for p in strips(99, 99)]
    )
    for mark in cut_piece(butted[0]).notches:
        assert mark[:, 1] == pytest.approx([0.0, 2.0])


def test_a_bow_is_as_long_as_asked_for():
    bow = seam((0, 0), (100, 10), 123.0, 1.0)
    assert np.linalg.norm(np.diff(bow, axis=0), axis=1).sum() == pytest.approx(123.0)


@pytest.mark.parametrize("order", [1, -1])
def test_a_notch_of_ones_own_is_where_it_was_put_on_whichever_piece(order):
    pieces = made_pieces()[::order]
    known = {each.key: each for each in pieces}
    for piece in pieces:
        for number, side in enumerate(piece.sides):
            if side.partner is None:
                continue
            share = seam_share(pieces, (piece.key, number), 0.2)
            other, at = side.partner
            own = {side.name: (share,), known[other].sides[at].name: (share,)}
            marked = {each.key: each for each in notched(pieces, own)}
            assert marked[piece.key].sides[number].notches == pytest.approx((0.2,))
            assert marked[other].sides[at].notches == pytest.approx((0.8,))


def test_a_seam_may_have_no_notches_at_all():
    one, two = notched(strips(100.0, 100.0, "side seam"), {"side seam": ()})
    assert one.sides[0].notches == two.sides[0].notches == ()
