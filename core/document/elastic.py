"""Elastic: a narrow elastic fabric by its own curve of force over elongation, as a design keeps it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from core.document.printable_name import is_blank, is_printable, repeated
from core.errors import LineError

Point = tuple[float, float]
Curve = tuple[Point, ...]
"""Points (elongation [1], force [N]), the unstretched elastic (0, 0) first."""

TISSUE_STIFFNESS = 530.0
"""Force per width and strain of skin and tissue [N/m]; an estimate: skin of 344 kPa and 1.55 mm."""

TISSUE_LIMITS = (50.0, 2000.0)
"""The softest and the stiffest tissue [N/m]; skins alone were measured from about 160 to 1150 N/m."""

LONGEST_NAME = 80
"""Letters of the name of an elastic."""

LONGEST_SOURCE = 500
"""Letters of where the curve of an elastic comes from."""

LIMITS = {"width_mm": (1.0, 200.0), "allowance_mm": (0.0, 200.0)}
"""The least and the largest width and allowance [mm]."""

MOST_POINTS, FURTHEST, STRONGEST = 2000, 5.0, 10_000.0
"""Points of a curve, its longest elongation [1] and its largest force [N]."""

MARGIN = 1.01
"""How much longer than in proportion a line is set so that its elastic is not overstretched: it gives way."""

_WHITE = str.maketrans("\t\r\n", "   ")


@dataclass(frozen=True)
class Elastic:
    """An elastic that lines are made of.

    ``curve`` goes straight between its points, and ends where nothing is known any more. ``allowance_mm`` is
    added to each piece that is cut, both ends together. ``source`` says where the curve comes from;
    ``estimate`` that it was not measured. Raises LineError for what no elastic can be.
    """

    name: str
    width_mm: float
    curve: Curve
    allowance_mm: float = 20.0
    source: str = ""
    estimate: bool = True

    def __post_init__(self) -> None:
        if is_blank(self.name) or not is_printable(self.name, LONGEST_NAME):
            raise LineError("An elastic needs a name.", f"Use up to {LONGEST_NAME} letters.")
        if not is_printable(self.source.translate(_WHITE), LONGEST_SOURCE):
            raise LineError(
                f"The source of the elastic {self.name} is too long or cannot be printed.",
                f"Use up to {LONGEST_SOURCE} letters.",
            )
        for key, (low, high) in LIMITS.items():
            number, what = getattr(self, key), key.removesuffix("_mm")
            if not low <= number <= high:
                raise LineError(
                    f"The {what} {number:g} mm of {self.name} is out of range.",
                    f"It goes from {low:g} to {high:g} mm.",
                )
        self._check_curve()

    def _check_curve(self) -> None:
        rows = self.curve
        whole = all(math.isfinite(number) for row in rows for number in row)
        if not whole or not 2 <= len(rows) <= MOST_POINTS or tuple(rows[0]) != (0.0, 0.0):
            raise LineError(
                f"The table of {self.name} is no curve.", "It begins with no force at no elongation."
            )
        for (before, weaker), (after, stronger) in pairwise(rows):
            if not before < after or not weaker < stronger:
                raise LineError(
                    f"The table of {self.name} goes back after {100.0 * before:g} % and {weaker:g} N.",
                    "Elongation and force must both rise from row to row: leave out the way back.",
                )
        if self.max_elongation > FURTHEST or self.max_force > STRONGEST:
            raise LineError(
                f"The table of {self.name} ends at {100.0 * self.max_elongation:g} %"
                f" and {self.max_force:g} N.",
                f"Look at its units: no elastic goes beyond {100.0 * FURTHEST:g} % or {STRONGEST:g} N.",
            )

    @property
    def max_elongation(self) -> float:
        """The elongation at which the curve ends [1]."""
        return self.curve[-1][0]

    @property
    def max_force(self) -> float:
        """The force at which the curve ends [N]."""
        return self.curve[-1][1]

    def force(self, elongation: float) -> float:
        """Return the force [N] at an elongation [1], 0 for a slack one; see ``secant``."""
        return max(elongation, 0.0) * self.secant(elongation)

    def secant(self, elongation: float) -> float:
        """Return force over elongation, EA of the Hooke line that works at the same point [N].

        A slack elastic has that of its first piece; beyond its end the curve goes on as it ends, for those
        who look at ``max_elongation`` themselves.
        """
        first, rise = self.curve[1]
        if elongation <= first:
            return rise / first
        (e0, f0), (e1, f1) = self._piece(lambda point: elongation <= point[0])
        return (f0 + (elongation - e0) * (f1 - f0) / (e1 - e0)) / elongation

    def elongation(self, force: float) -> float:
        """Return the elongation [1] at a force [N], 0 at none; beyond its end as ``secant``."""
        (e0, f0), (e1, f1) = self._piece(lambda point: force <= point[1])
        return max(e0 + (force - f0) * (e1 - e0) / (f1 - f0), 0.0)

    def _piece(self, ends: Callable[[Point], bool]) -> tuple[Point, Point]:
        """Return the first piece of the curve at whose end the condition holds, or the last piece."""
        pieces = list(pairwise(self.curve))
        return next((piece for piece in pieces if ends(piece[1])), pieces[-1])

    def overstretch_error(
        self, elongation: float, line: str, ratio: float | None = None
    ) -> OverstretchedError:
        """Return what to say of a line, at a ``ratio`` if set, that stretches it beyond its curve."""
        return OverstretchedError(self, elongation, line, ratio)

    def overload_error(self, force: float, line: str) -> ElasticError:
        """Return what to say when a line would pull the elastic with more than its curve knows."""
        needed, end = _beyond(force, self.max_force, 1), f"{self.max_force:g}"
        return ElasticError(
            f"{self.name} would be pulled with {needed} N as {line}; its table ends at {end} N.",
            "Let the line be longer, or take a stronger or wider elastic.",
            f"Too weak: {needed} N at this length, its table ends at {end} N.",
            line,
        )


class ElasticError(LineError):
    """An elastic cannot be used for a ``line``; ``reason`` states why, where both are named beside it."""

    def __init__(self, message: str, hint: str, reason: str, line: str) -> None:
        super().__init__(message, hint)
        self.reason, self.line = reason, line


class OverstretchedError(ElasticError):
    """A ``line`` would stretch its ``elastic`` by ``elongation`` [1], beyond the end of its curve.

    The hint names the shortest ``ratio`` that works, where lengths are set: the line gives way no less there.
    """

    def __init__(self, elastic: Elastic, elongation: float, line: str, ratio: float | None) -> None:
        needed, end = (
            _beyond(100.0 * elongation, 100.0 * elastic.max_elongation, 0),
            f"{100.0 * elastic.max_elongation:g}",
        )
        hint = "Let the line be longer, or take an elastic that stretches further."
        if ratio is not None:
            least = math.ceil(100.0 * MARGIN * ratio * (1.0 + elongation) / (1.0 + elastic.max_elongation))
            hint = f"Set {line} to {least:.0f} % or longer, or choose an elastic that stretches further."
        super().__init__(
            f"{elastic.name} would be stretched by {needed} % as {line}; its table ends at {end} %.",
            hint,
            f"Too short a cut: {needed} % stretch, its table ends at {end} %.",
            line,
        )
        self.elastic, self.elongation = elastic, elongation


def _beyond(value: float, end: float, digits: int) -> str:
    """Return a value beyond an end with ``digits``, or as many as tell it from the end."""
    texts = (f"{value:.{each}f}" for each in range(digits, 6))
    return next((text for text in texts if float(text) > end), f"{value:g}")


def check_elastics(elastics: Sequence[Elastic], made: Mapping[str, str]) -> None:
    """Raise LineError if two elastics share a name, or a line is ``made`` of one that is not there."""
    names = [elastic.name for elastic in elastics]
    if twice := repeated(names):
        raise LineError(f"There are two elastics '{twice}'.", "Give each elastic a name of its own.")
    known = set(names)
    for line, name in made.items():
        if name not in known:
            raise LineError(f"The elastic {name} of the line {line} is missing.", "Choose it again.")
