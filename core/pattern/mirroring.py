"""Left and right pieces that are mirror images of each other: which they are, and both as one piece."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.geometry.plane_sections import arc_length, interpolate
from core.pattern.piece import BOTH, Piece, Points2, Side, SideKey, mirrored

SAME = 1.0
"""Left and right are one piece where they differ by less anywhere [mm]."""

SEWN = 0.02
"""What is sewn to a side may become longer or shorter by this where left and right become one [mm]."""

_SAME_GRAIN = float(np.cos(np.radians(3.0)))
_STEP = 1.0  # between places where two outlines are compared [mm]


@dataclass(frozen=True)
class MirrorPair:
    """The keys of a ``left`` and a ``right`` piece that are mirror images.

    ``sides`` are the numbers of the right one's sides in the order of those of the left one.
    """

    left: str
    right: str
    sides: tuple[int, ...]


def mirror_pairs(pieces: Sequence[Piece], same_mm: float = SAME) -> tuple[MirrorPair, ...]:
    """Return the pieces of which left and right are the same.

    They are if no place of the mirrored sew line is ``same_mm`` or more from that of the other, side by side,
    nor a notch, the grain lines differ by less than 3 degrees, and cloth, allowances and number are equal.
    """
    known = {each.key: each for each in pieces}
    pairs = []
    for left in pieces:
        right = known.get(f"{left.name} right") if left.side == "left" else None
        turn = None if right is None else _matching_turn(left, mirrored(right), same_mm)
        if right is not None and turn is not None:
            count = len(left.sides)
            sides = tuple(count - 1 - (number + turn) % count for number in range(count))
            pairs.append(MirrorPair(left.key, right.key, sides))
    return tuple(pairs)


def merge_mirrored(pieces: Sequence[Piece], same_mm: float = SAME) -> tuple[Piece, ...]:
    """Return pieces with left and right as one, cut twice and mirrored, where they are the same.

    The left one is kept, and partners refer to what is kept. A pair stays apart where what is sewn to the
    right one would not fit the left one.
    """
    known = {each.key: each for each in pieces}
    pairs = mirror_pairs(pieces, same_mm)
    while sewn := tuple(pair for pair in pairs if _can_be_sewn(pair, pairs, known)):
        if sewn == pairs:
            break
        pairs = sewn
    return _merged(pieces, sewn)


def _can_be_sewn(pair: MirrorPair, pairs: Sequence[MirrorPair], known: Mapping[str, Piece]) -> bool:
    """Return whether all that is sewn to the right piece of a pair fits its left one.

    What becomes one piece itself does, as its left one is sewn to the left one here.
    """
    by_right = {each.right: each for each in pairs}
    left, right = known[pair.left], known[pair.right]
    for number, other in enumerate(pair.sides):
        side, partner = left.sides[number], right.sides[other].partner
        if partner is None or partner[0] not in known or partner == (pair.left, number):
            continue
        one = by_right.get(partner[0])
        if one is not None and side.partner == (one.left, one.sides.index(partner[1])):
            continue
        if _apart(side, right.sides[other]) > SEWN:
            return False
    return True


def _apart(left: Side, right: Side) -> float:
    """Return by how much a side differs from its mirror image in length, or in where its notches are [mm]."""
    places = np.array(left.notches) * left.length
    others = (1.0 - np.array(right.notches[::-1])) * right.length
    return max(abs(left.length - right.length), float(np.abs(places - others).max(initial=0.0)))


def _merged(pieces: Sequence[Piece], pairs: Sequence[MirrorPair]) -> tuple[Piece, ...]:
    """Return pieces with these pairs as one each."""
    known = {each.key: each for each in pieces}
    kept: dict[SideKey, SideKey] = {}
    for pair in pairs:
        for number, other in enumerate(pair.sides):
            kept[pair.left, number] = kept[pair.right, other] = (known[pair.left].name, number)
    left, right = ({getattr(pair, side) for pair in pairs} for side in ("left", "right"))
    merged = []
    for piece in pieces:
        sides = tuple(
            replace(each, partner=kept.get(each.partner, each.partner) if each.partner else None)
            for each in piece.sides
        )
        if piece.key in left:
            merged.append(replace(piece, side=BOTH, count=2 * piece.count, sides=sides))
        elif piece.key not in right:
            merged.append(replace(piece, sides=sides))
    return tuple(merged)


def _matching_turn(piece: Piece, other: Piece, same_mm: float) -> int | None:
    """Return by how many sides the outline of another piece is turned where both are the same, else None."""
    if (piece.cloth, piece.count, len(piece.sides)) != (other.cloth, other.count, len(other.sides)):
        return None
    for turn in range(len(other.sides)):
        turned = replace(other, sides=(*other.sides[turn:], *other.sides[:turn]))
        alike = all(_like(one, two, same_mm) for one, two in zip(piece.sides, turned.sides, strict=True))
        if alike and _is_same(piece, turned, same_mm):
            return turn
    return None


def _like(one: Side, two: Side, same_mm: float) -> bool:
    """Return whether two sides have one name, allowance and elastic, and notches in the same places."""
    if _alike(one) != _alike(two):
        return False
    return all(
        abs(a - b) * one.length < same_mm
        for a, b in zip(sorted(one.notches), sorted(two.notches), strict=True)
    )


def _alike(side: Side) -> tuple[object, ...]:
    """Return what sides must have in common, beside places."""
    elastic = side.elastic and (side.elastic.line, side.elastic.elastic)
    return side.name, side.allowance, len(side.notches), elastic


def _is_same(piece: Piece, other: Piece, same_mm: float) -> bool:
    """Return whether two outlines are the same at equal shares of their sides, laid on each other as well."""
    pairs = list(zip(piece.sides, other.sides, strict=True))
    counts = [max(2, round(max(a.length, b.length) / _STEP) + 1) for a, b in pairs]
    ones, twos = (
        np.concatenate([_even(side.points, count) for side, count in zip(each.sides, counts, strict=True)])
        for each in (piece, other)
    )
    ones, twos = ones - ones.mean(axis=0), twos - twos.mean(axis=0)
    u, _, vt = np.linalg.svd(twos.T @ ones)
    spin = u @ np.diag([1.0, float(np.linalg.det(u @ vt))]) @ vt
    apart = np.linalg.norm(twos @ spin - ones, axis=1).max()
    return bool(apart < same_mm and np.array(other.grain) @ spin @ np.array(piece.grain) > _SAME_GRAIN)


def _even(points: Points2, count: int) -> Points2:
    """Return ``count`` places at equal distances along a side."""
    along = arc_length(points)
    return interpolate(np.linspace(0.0, along[-1], count), along, points)
