"""Notches: marks on both sides of a seam that meet when it is sewn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from core.pattern.piece import Piece, Side, SideKey

SHARES = (0.30, 0.62)
"""Where a seam has its notches, as shares of its length: never symmetric, so that no piece is sewn turned."""

SHORT_SHARE = 0.38
"""Where a short seam has its only one."""

SHORT, SHORTEST = 60.0, 20.0
"""Seams that are shorter have one notch, or none [mm]."""

DOUBLE = 6.0
"""How far the two marks of a double notch are apart, which is the last one of a seam at the back [mm]."""


NO_NOTCHES: Mapping[str, tuple[float, ...]] = MappingProxyType({})


def is_back(side: Side) -> bool:
    """Return whether a seam is named as one at the back."""
    return "back" in side.name.split()


def notched(pieces: Sequence[Piece], own: Mapping[str, tuple[float, ...]] = NO_NOTCHES) -> tuple[Piece, ...]:
    """Return pieces with notches on all sides that are sewn; edges keep those that they have.

    One side of each seam has them at ``SHARES`` of its length, its partner at the same shares from its other
    end: at equal lengths where the sides are equally long, in proportion where one is eased in. The last one
    is double on seams at the back. Seams named in ``own`` have those shares instead, see ``seam_share``.
    Right sides are mirrored, so call this before ``merge_mirrored``.
    """
    known = {each.key: each for each in pieces}
    names = list(dict.fromkeys(each.name for each in pieces))
    seams = [pair for each in pieces for pair in _seams_of(each, known, names)]
    shortest: dict[tuple[str, str, str], float] = {}
    for owner, partner in seams:
        kind, length = _kind(owner, partner, known), _side(owner, known).length
        shortest[kind] = min(length, shortest.get(kind, length))
    found: dict[SideKey, tuple[float, ...]] = {}
    for owner, partner in seams:
        side, other = _side(owner, known), _side(partner, known)
        shares = own.get(side.name)
        if shares is None:
            double = is_back(side) or is_back(other)
            shares = _shares(shortest[_kind(owner, partner, known)], side.length, double)
        turned = tuple(1.0 - each for each in reversed(shares))
        at_right = known[owner[0]].side == "right"
        found[owner], found[partner] = (turned, shares) if at_right else (shares, turned)
    return tuple(
        replace(
            each,
            sides=tuple(
                replace(side, notches=found.get((each.key, number), side.notches))
                for number, side in enumerate(each.sides)
            ),
        )
        for each in pieces
    )


def seam_share(pieces: Sequence[Piece], key: SideKey, share: float) -> float:
    """Return the share of a seam's own notch from its ``share`` of one of the sides that it joins.

    It counts along the side that decides, on the left of the body; ``notched`` needs it so.
    """
    known = {each.key: each for each in pieces}
    partner = _side(key, known).partner
    names = list(dict.fromkeys(each.name for each in pieces))
    pair = (key,) if partner is None else (key, partner)
    owner = min(pair, key=lambda each: _rank(each, known, names))
    turned = (owner != key) != (known[owner[0]].side == "right")
    return 1.0 - share if turned else share


def _seams_of(piece: Piece, known: dict[str, Piece], names: list[str]) -> list[tuple[SideKey, SideKey]]:
    """Return the seams whose places are decided by a side of this piece, with that side first."""
    found = []
    for number, side in enumerate(piece.sides):
        key = (piece.key, number)
        if side.partner is not None and side.partner[0] in known:
            first = min(key, side.partner, key=lambda each: _rank(each, known, names))
            if first == key:
                found.append((key, side.partner))
    return found


def _rank(key: SideKey, known: dict[str, Piece], names: list[str]) -> tuple[bool, int, int, int]:
    """Return which side of a seam decides: the same one on the left and, mirrored, on the right.

    A piece over the middle comes last: what it is sewn to on both sides must stay each other's mirror image.
    """
    piece, number = known[key[0]], key[1]
    at_right = piece.side == "right"
    return piece.side == "", names.index(piece.name), int(at_right), -number if at_right else number


def _kind(owner: SideKey, partner: SideKey, known: dict[str, Piece]) -> tuple[str, str, str]:
    """Return what a seam has in common with that of the other side of the body."""
    return known[owner[0]].name, known[partner[0]].name, _side(owner, known).name


def _side(key: SideKey, known: dict[str, Piece]) -> Side:
    return known[key[0]].sides[key[1]]


def _shares(shortest: float, length: float, double: bool) -> tuple[float, ...]:
    """Return the notches of a seam, as many on the left as on the right of the body."""
    if shortest < SHORTEST:
        return ()
    *single, last = SHARES if shortest >= SHORT else (SHORT_SHARE,)
    half = 0.5 * DOUBLE / length
    return (*single, last - half, last + half) if double else (*single, last)
