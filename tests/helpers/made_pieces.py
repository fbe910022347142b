"""Made-up pieces of a two-part cup with bridge, cradles and wings: smooth curves, seams of equal length."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from core.geometry.plane_sections import arc_length
from core.pattern.notches import notched
from core.pattern.piece import Piece, Side, mirrored

CUP, SHEER, NET = "Cup tricot, stable", "Sheer tricot, no stretch", "Power net"


def curve(*controls: tuple[float, float], count: int = 40) -> np.ndarray:
    """A Bezier curve of any number of control points, (count, 2)."""
    points = np.array(controls, dtype=float)
    share = np.linspace(0.0, 1.0, count)[:, None, None]
    while points.shape[-2] > 1:
        points = (1.0 - share) * points[..., :-1, :] + share * points[..., 1:, :]
    return points[:, 0] if points.ndim == 3 else points


def seam(start: tuple[float, float], end: tuple[float, float], length: float, bulge: float) -> np.ndarray:
    """A bow from one place to another that is as long as asked for; it bulges to its right if positive."""
    a, b = np.array(start), np.array(end)
    way = b - a
    out = np.array([way[1], -way[0]]) * bulge
    low, high = 0.0, 3.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        bow = curve(a, a + 0.3 * way + middle * out, a + 0.7 * way + middle * out, b)
        low, high = (middle, high) if arc_length(bow)[-1] < length else (low, middle)
    return bow


def outline(*parts: tuple[str, np.ndarray, float, tuple[str, int] | None]) -> tuple[Side, ...]:
    return tuple(Side(name, points, allowance, (), partner) for name, points, allowance, partner in parts)


def left_pieces() -> list[Piece]:
    """Upper cup, lower cup, cradle and wing of the left side."""
    upper = outline(
        ("cup seam", seam((0, 0), (180, 12), 196.0, 1.0), 6.5, ("lower cup left", 1)),
        ("armhole", curve((180, 12), (150, 50), (118, 105)), 8.0, None),
        ("strap end", curve((118, 105), (104, 108), count=4), 10.0, None),
        ("neckline", curve((104, 108), (60, 60), (0, 0)), 8.0, None),
    )
    lower = outline(
        ("wire seam", seam((0, 0), (176, 8), 262.0, 1.0), 6.5, ("cradle left", 3)),
        ("cup seam", seam((176, 8), (0, 0), 196.0, 1.0), 6.5, ("upper cup left", 0)),
    )
    cradle = outline(
        ("band edge", curve((0, 0), (120, -6), (205, 4)), 10.0, None),
        ("side seam", curve((205, 4), (203, 60), (208, 96)), 6.5, ("wing left", 3)),
        ("wing top", curve((208, 96), (190, 112), (170, 118), count=12), 10.0, None),
        ("wire seam", seam((170, 118), (6, 62), 262.0, -1.0), 6.5, ("lower cup left", 0)),
        ("bridge seam", curve((6, 62), (2, 30), (0, 0), count=20), 6.5, ("bridge", 1)),
    )
    side = cradle[1].length
    wing = outline(
        ("band edge", curve((0, 0), (90, 8), (190, 2)), 10.0, None),
        ("centre back", curve((190, 2), (192, 40), count=6), 12.0, None),
        ("wing top", curve((192, 40), (120, 42), (60, 66), (4, 91)), 10.0, None),
        ("side seam back", seam((4, 91), (0, 0), side, 1.0), 6.5, ("cradle left", 1)),
    )
    named = (
        ("upper cup", upper, CUP),
        ("lower cup", lower, CUP),
        ("cradle", cradle, SHEER),
        ("wing", wing, NET),
    )
    return [Piece(name, "left", cloth, 1, sides) for name, sides, cloth in named]


def right_of(piece: Piece) -> Piece:
    """The mirror image of a left piece, whose sides refer to the right pieces and their numbers."""
    counts = {each.name: len(each.sides) for each in left_pieces()}
    flat = mirrored(replace(piece, sides=tuple(replace(each, notches=()) for each in piece.sides)))
    return replace(
        flat, sides=tuple(replace(each, partner=_other(each.partner, counts)) for each in flat.sides)
    )


def _other(partner: tuple[str, int] | None, counts: dict[str, int]) -> tuple[str, int] | None:
    if partner is None:
        return None
    name = partner[0].removesuffix(" left")
    if name == "bridge":
        return ("bridge", 3)
    return (f"{name} right", counts[name] - 1 - partner[1])


def bridge(length: float) -> Piece:
    """The piece over the middle, between the cradles."""
    right = seam((-16, 0), (-12, 62), length, 1.0)[::-1]
    sides = outline(
        ("band edge", curve((-16, 0), (16, 0), count=8), 10.0, None),
        ("bridge seam", right[::-1] * [-1.0, 1.0], 6.5, ("cradle left", 4)),
        ("bridge top", curve((12, 62), (0, 50), (-12, 62)), 6.5, None),
        ("bridge seam", right, 6.5, ("cradle right", 0)),
    )
    return Piece("bridge", "", SHEER, 1, sides)


def made_pieces() -> tuple[Piece, ...]:
    """Nine pieces with notches, left and right being mirror images."""
    left = left_pieces()
    middle = bridge(left[2].sides[4].length)
    return notched([each for one in left for each in (one, right_of(one))] + [middle])
