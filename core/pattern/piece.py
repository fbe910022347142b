"""Pieces: what is cut from cloth, flat, by the sides of their outlines."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from core.errors import PatternError
from core.geometry.mesh import Floats
from core.geometry.plane_sections import arc_length
from core.messages import Message

Points2 = Floats
"""Places on paper, shape (k, 2) [mm]: x across, y up on the body."""

SideKey = tuple[str, int]
"""A side by the key of its piece and its number in it."""

BOTH = "both"
"""The side of a piece that is cut for both sides of the body, the right one mirrored."""


@dataclass(frozen=True)
class EdgeElastic:
    """What an edge carries of an elastic of ``width_mm``: its share from ``start`` to ``end`` [1].

    ``line`` is the worn line without its side, ``elastic`` is empty where none is chosen. ``cut_mm`` is its
    length to cut, None where that is not known, ``part_mm`` what of it lies on this edge, without its own
    seam allowance. ``marks`` are its quarters, as shares of the edge from its first point [1].
    """

    line: str
    elastic: str
    width_mm: float | None
    cut_mm: float | None
    part_mm: float | None
    start: float
    end: float
    marks: tuple[float, ...] = ()

    @property
    def quarter_mm(self) -> float | None:
        """Return how far its quarter marks are apart unstretched [mm], None where that is not known."""
        return None if self.part_mm is None else 0.25 * self.part_mm / (self.end - self.start)

    @property
    def mirrored(self) -> EdgeElastic:
        """Return it on the edge in the other direction."""
        marks = tuple(1.0 - each for each in self.marks[::-1])
        return replace(self, start=1.0 - self.end, end=1.0 - self.start, marks=marks)


NO_ELASTICS: Mapping[SideKey, EdgeElastic] = MappingProxyType({})

_OTHER = {"left": "right", "right": "left"}


@dataclass(frozen=True, eq=False)
class Side:
    """A stretch of an outline between two corners: a seam or an edge.

    ``points`` (k, 2) run counter-clockwise round the piece [mm]; its ends are shared with the neighbours.
    ``notches`` are shares of its length from its first point [1]. ``partner`` is the side that is sewn to it,
    reversed; None for an edge, which may carry an ``elastic``.
    """

    name: str
    points: Points2
    allowance: float
    notches: tuple[float, ...] = ()
    partner: SideKey | None = None
    elastic: EdgeElastic | None = None

    @property
    def length(self) -> float:
        """Return the length on the sew line [mm]."""
        return float(arc_length(self.points)[-1])

    def place(self, share: float) -> tuple[Floats, Floats]:
        """Return the place at a share of the length and the unit direction outward, (2,) and (2,) [mm, 1]."""
        along = arc_length(self.points)
        at = share * along[-1]
        k = int(np.clip(np.searchsorted(along, at, side="right") - 1, 0, len(along) - 2))
        step = self.points[k + 1] - self.points[k]
        way = step / max(float(np.linalg.norm(step)), 1e-12)
        return self.points[k] + way * (at - along[k]), np.array([way[1], -way[0]])


@dataclass(frozen=True, eq=False)
class Piece:
    """A piece that is cut ``count`` times from ``cloth``, named by its title.

    ``side`` is "left", "right", ``BOTH`` (cut mirrored) or "" (over the middle of the body). ``sides`` close
    the outline, counter-clockwise. ``internal`` are lines inside by kind (dart legs, control lines), each
    (k, 2) [mm]. ``grain`` and ``stretch`` are the unit directions of the grain line and greatest stretch.
    ``title`` and ``cloth_title`` are written on it in place of its name and cloth, if there are any.
    """

    name: str
    side: str
    cloth: str
    count: int
    sides: tuple[Side, ...]
    internal: tuple[tuple[str, Points2], ...] = ()
    grain: tuple[float, float] = (0.0, 1.0)
    stretch: tuple[float, float] = (1.0, 0.0)
    title: str = ""
    cloth_title: str = ""

    def __post_init__(self) -> None:
        after = (*self.sides[1:], *self.sides[:1])
        gaps = [
            float(np.linalg.norm(b.points[0] - a.points[-1])) for a, b in zip(self.sides, after, strict=True)
        ]
        if max(gaps, default=np.inf) > 1e-6:
            raise PatternError(
                Message("The outline of the piece '{name}' is not closed.", name=self.key),
                Message("Flatten the piece again."),
            )

    @property
    def key(self) -> str:
        """Return the name by which sides refer to the piece: "lower cup left"."""
        return f"{self.name} {self.side}" if self.side in _OTHER else self.name

    @property
    def outline(self) -> Points2:
        """Return the sew line without its first point again, (n, 2) [mm]."""
        return np.concatenate([side.points[:-1] for side in self.sides])

    @property
    def darts(self) -> tuple[tuple[Points2, Floats], ...]:
        """Return the legs of each dart, from the outline to its tip and back, (k, 2), and the tip, (2,) [mm].

        A dart is a slit, whose two sides follow each other and are sewn to each other.
        """
        after = (*self.sides[1:], *self.sides[:1])
        return tuple(
            (np.concatenate([one.points, other.points[1:]]), one.points[-1])
            for number, (one, other) in enumerate(zip(self.sides, after, strict=True))
            if one is not other
            and one.partner == (self.key, (number + 1) % len(self.sides))
            and other.partner == (self.key, number)
        )

    @property
    def area(self) -> float:
        """Return the area inside the sew line [mm^2]."""
        return signed_area(self.outline)

    def moved(self, move: Callable[[Points2], Points2]) -> Piece:
        """Return the piece with all points moved by a function of places (k, 2), which keeps directions."""
        return replace(
            self,
            sides=tuple(replace(each, points=move(each.points)) for each in self.sides),
            internal=tuple((kind, move(points)) for kind, points in self.internal),
        )


def signed_area(outline: Points2) -> float:
    """Return the area of an outline (n, 2), positive where it is counter-clockwise [mm^2]."""
    after = np.roll(outline, -1, axis=0)
    return 0.5 * float(outline[:, 0] @ after[:, 1] - outline[:, 1] @ after[:, 0])


def mirrored(piece: Piece) -> Piece:
    """Return the piece with its face down: x negative, sides in the other order."""
    flip = np.array([-1.0, 1.0])
    sides = tuple(
        replace(
            each,
            points=(flip * each.points)[::-1],
            notches=tuple(1.0 - s for s in each.notches[::-1]),
            elastic=each.elastic and each.elastic.mirrored,
        )
        for each in piece.sides[::-1]
    )
    return replace(
        piece,
        side=_OTHER.get(piece.side, piece.side),
        sides=sides,
        internal=tuple((kind, flip * points) for kind, points in piece.internal),
        grain=(-piece.grain[0], piece.grain[1]),
        stretch=(-piece.stretch[0], piece.stretch[1]),
    )


def sewn_length(pieces: Mapping[str, Piece], side: Side) -> float | None:
    """Return the length of what is sewn to a side [mm]; None for an edge, or where its piece is not there."""
    if side.partner is None or side.partner[0] not in pieces:
        return None
    name, number = side.partner
    return pieces[name].sides[number].length
