"""Cloth: what pieces are cut from, how far it gives across and down, and how far it is worn stretched."""

from __future__ import annotations

import math
from dataclasses import dataclass

from core.document.printable_name import is_blank, is_printable
from core.errors import PatternError
from core.messages import ClothName, Message

Pair = tuple[float, float]
"""Across (in most cloths the direction of greatest stretch) and down."""

LONGEST_NAME, LONGEST_SOURCE = 80, 500
"""Letters of a name or title, and of where the values of a cloth come from."""

MOST_STRETCH = 3.0
"""Cloths do not stretch further by hand [1]."""

STIFFNESS_LIMITS = (0.01, 100.0)
"""The softest and the stiffest cloth [1]."""


@dataclass(frozen=True)
class Cloth:
    """A cloth that pieces are cut from.

    ``stiffness`` across, down and in shear is relative to a stable cup tricot across [1]. Worn lengths are
    1 + ``ease`` times the lengths of the piece (negative ease in the trade: the piece is cut smaller); on top
    of that a piece may be stretched or compressed by ``limit`` [1]. ``stretch`` is what the cloth gives by
    hand, None if it was not tested. ``source`` says where the values come from, ``estimate`` that they were
    not measured. Raises PatternError for what no cloth can be.
    """

    name: str
    title: str
    stiffness: tuple[float, float, float]
    poisson: float
    ease: Pair
    limit: float
    stretch: Pair | None = None
    source: str = ""
    estimate: bool = True

    def __post_init__(self) -> None:
        for each in (self.name, self.title):
            if is_blank(each) or not is_printable(each, LONGEST_NAME):
                raise self._name_error(each)
        if not is_printable(self.source, LONGEST_SOURCE):
            raise PatternError(
                Message(
                    "The source of the cloth {name} is too long or contains unprintable characters.",
                    name=ClothName(self.title),
                ),
                Message("Use at most {count} characters.", count=LONGEST_SOURCE),
            )
        stretches = [(each, (0.0, MOST_STRETCH)) for each in self.stretch or ()]
        for what, values in (
            (Message("stretch"), stretches),  # first, as other values may be estimated from it
            (Message("stiffness"), [(each, STIFFNESS_LIMITS) for each in self.stiffness]),
            (Message("Poisson's ratio"), [(self.poisson, (0.0, 0.9))]),
            (Message("ease"), [(each, (-0.3, 1.0)) for each in self.ease]),
            (Message("limit"), [(self.limit, (0.001, 2.0))]),
        ):
            for value, (low, high) in values:
                if not low <= value <= high:
                    raise self._range_error(what, value, low, high)

    @staticmethod
    def _name_error(name: str) -> PatternError:
        hint = Message("Use at most {count} characters.", count=LONGEST_NAME)
        if not is_blank(name) and len(name) <= LONGEST_NAME:
            return PatternError(Message("The name of the cloth contains unprintable characters."), hint)
        return PatternError(
            Message(
                "The name of the cloth is missing or longer than {count} characters.", count=LONGEST_NAME
            ),
            hint,
        )

    @property
    def stretches_down(self) -> bool:
        """Return whether it gives more down than across; by its stiffness where its stretch is not known."""
        across, down = self.stretch or (self.stiffness[1], self.stiffness[0])
        return down > across

    def _range_error(self, what: Message, value: float, low: float, high: float) -> PatternError:
        name = ClothName(self.title)
        return PatternError(
            Message(
                "The {what} {value} of the cloth {name} is out of range.",
                what=what,
                value=f"{value:g}",
                name=name,
            )
            if math.isfinite(value)
            else Message("The {what} of the cloth {name} is not a number.", what=what, name=name),
            Message("Enter a value from {low} to {high}.", low=f"{low:g}", high=f"{high:g}"),
        )
