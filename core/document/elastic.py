"""Elastic: a narrow elastic fabric by its own curve of force over elongation, as a design keeps it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from core.document.printable_name import is_blank, is_printable, repeated
from core.errors import LineError
from core.messages import ElasticName, LengthRange, LineName, Message, length_of

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
            raise LineError(
                Message("An elastic requires a name."),
                Message("Use at most {count} characters.", count=LONGEST_NAME),
            )
        if not is_printable(self.source.translate(_WHITE), LONGEST_SOURCE):
            raise LineError(
                Message(
                    "The source of the elastic {name} is too long or contains unprintable characters.",
                    name=ElasticName(self.name),
                ),
                Message("Use at most {count} characters.", count=LONGEST_SOURCE),
            )
        for key, what in (("width_mm", Message("width")), ("allowance_mm", Message("seam allowance"))):
            number, (low, high) = getattr(self, key), LIMITS[key]
            if not low <= number <= high:
                raise LineError(
                    Message(
                        "The {what} {length} of {name} is out of range.",
                        what=what,
                        length=length_of(number),
                        name=self.name,
                    ),
                    Message("Enter a value from {range}.", range=LengthRange(low, high)),
                )
        self._check_curve()

    def _check_curve(self) -> None:
        rows = self.curve
        whole = all(math.isfinite(number) for row in rows for number in row)
        if not whole or not 2 <= len(rows) <= MOST_POINTS or tuple(rows[0]) != (0.0, 0.0):
            raise LineError(
                Message("The table of {name} is not valid.", name=self.name),
                Message("The table must begin with zero force at zero elongation."),
            )
        for (before, weaker), (after, stronger) in pairwise(rows):
            if not before < after or not weaker < stronger:
                raise LineError(
                    Message(
                        "The table of {name} decreases after {elongation} % and {force} N.",
                        name=self.name,
                        elongation=f"{100.0 * before:g}",
                        force=f"{weaker:g}",
                    ),
                    Message(
                        "Elongation and force must increase from row to row: remove the rows measured "
                        "during unloading."
                    ),
                )
        if self.max_elongation > FURTHEST or self.max_force > STRONGEST:
            raise LineError(
                Message(
                    "The table of {name} ends at {elongation} % and {force} N.",
                    name=self.name,
                    elongation=f"{100.0 * self.max_elongation:g}",
                    force=f"{self.max_force:g}",
                ),
                Message(
                    "Check the units: elastics do not exceed {elongation} % or {force} N.",
                    elongation=f"{100.0 * FURTHEST:g}",
                    force=f"{STRONGEST:g}",
                ),
            )

    @property
    def max_elongation(self) -> float:
        """Return the elongation at which the curve ends [1]."""
        return self.curve[-1][0]

    @property
    def max_force(self) -> float:
        """Return the force at which the curve ends [N]."""
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
        self, elongation: float, line: LineName, ratio: float | None = None
    ) -> OverstretchedError:
        """Return what to say of a line, at a ``ratio`` if set, that stretches it beyond its curve."""
        return OverstretchedError(self, elongation, line, ratio)

    def overload_error(self, force: float, line: LineName) -> ElasticError:
        """Return what to say when a line would pull the elastic with more than its curve knows."""
        needed, end = _beyond(force, self.max_force, 1), f"{self.max_force:g}"
        return ElasticError(
            Message(
                "{name} requires {force} N for {line}; the table of the elastic ends at {strength} N.",
                name=ElasticName(self.name),
                force=needed,
                line=line,
                strength=end,
            ),
            Message("Make the line longer, or choose a stronger or wider elastic."),
            Message(
                "Too weak: {force} N at this length; the table of the elastic ends at {strength} N.",
                force=needed,
                strength=end,
            ),
            line,
        )


class ElasticError(LineError):
    """An elastic cannot be used for a ``line``; ``reason`` states why, where both are named beside it."""

    def __init__(self, message: Message, hint: Message, reason: Message, line: LineName) -> None:
        super().__init__(message, hint)
        self.reason, self.line = reason, line.text


class OverstretchedError(ElasticError):
    """A ``line`` would stretch its ``elastic`` by ``elongation`` [1], beyond the end of its curve.

    The hint names the shortest ``ratio`` that works, where lengths are set: the line gives way no less there.
    """

    def __init__(self, elastic: Elastic, elongation: float, line: LineName, ratio: float | None) -> None:
        needed, end = (
            _beyond(100.0 * elongation, 100.0 * elastic.max_elongation, 0),
            f"{100.0 * elastic.max_elongation:g}",
        )
        hint = Message("Make the line longer, or choose an elastic with higher elongation.")
        if ratio is not None:
            least = math.ceil(100.0 * MARGIN * ratio * (1.0 + elongation) / (1.0 + elastic.max_elongation))
            hint = Message(
                "Set {line} to {percent} % or more, or choose an elastic with higher elongation.",
                line=line,
                percent=f"{least:.0f}",
            )
        super().__init__(
            Message(
                "{name} requires {elongation} % elongation for {line}; the table of the elastic "
                "ends at {reach} %.",
                name=ElasticName(elastic.name),
                elongation=needed,
                line=line,
                reach=end,
            ),
            hint,
            Message(
                "Cut length too short: {elongation} % elongation; the table of the elastic ends "
                "at {reach} %.",
                elongation=needed,
                reach=end,
            ),
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
        raise LineError(
            Message("Two elastics are named '{name}'.", name=twice),
            Message("Give each elastic a unique name."),
        )
    known = set(names)
    for line, name in made.items():
        if name not in known:
            raise LineError(
                Message(
                    "The elastic {name} of the line {line} is missing.",
                    name=ElasticName(name),
                    line=LineName(line),
                ),
                Message("Choose the elastic again."),
            )
