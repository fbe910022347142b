"""Measures of the designer's own, by name: between two landmarks, or round the trunk at a level."""

from __future__ import annotations

import re
from dataclasses import dataclass

from core.document.printable_name import is_blank, is_printable
from core.errors import UserError
from core.landmarks.types import NAMES
from core.messages import LandmarkName, Message, length_of

LONGEST_CUSTOMER = 120
"""Letters of what a customer is called."""

KINDS = ("straight", "skin", "girth")
"""Straight between two landmarks, over the skin between them, or round the trunk on a level plane."""

LONGEST_NAME = 60
"""Letters of the name of a measure."""

WORN_TIGHT = 0.0, 20.0
"""What a tape that is worn tight may take off the under-bust [mm]: a band presses into the body, a scan does
not.
"""

FURTHEST = 3000.0
"""No level lies so high or so low [mm]."""


@dataclass(frozen=True)
class CustomMeasurement:
    """A measure of the designer's own.

    ``kind`` is one of ``KINDS``. The first two go between the two landmarks in ``marks``; a girth lies
    ``level`` [mm] above the one landmark in ``marks``, or if there is none above the scan's lowest point.
    Raises UserError for what cannot be measured.
    """

    name: str
    kind: str
    marks: tuple[str, ...] = ()
    level: float = 0.0

    def __post_init__(self) -> None:
        if is_blank(self.name) or not is_printable(self.name, LONGEST_NAME):
            raise UserError(
                Message("A measurement requires a unique name."),
                Message("Use at most {count} characters.", count=LONGEST_NAME),
            )
        if self.kind not in KINDS:
            raise UserError(
                Message("Unknown measurement type '{kind}'.", kind=self.kind),
                Message("Choose straight, skin or girth."),
            )
        unknown = [mark for mark in self.marks if mark not in NAMES]
        if unknown:
            raise UserError(
                Message("There is no landmark {name}.", name=unknown[0]),
                Message("Choose one of {choices}.", choices=tuple(NAMES)),
            )
        if self.kind == "girth" and (len(self.marks) > 1 or not abs(self.level) < FURTHEST):
            raise UserError(
                Message("The girth {name} has no level.", name=self.name),
                Message("Specify one landmark, or a height in mm, or both."),
            )
        if self.kind != "girth" and (len(set(self.marks)) != 2 or len(self.marks) != 2 or self.level):
            raise UserError(
                Message("The measurement {name} does not have two end points.", name=self.name),
                Message("Specify two different landmarks."),
            )

    @property
    def text(self) -> Message:
        """Return how it is taken, in a sentence."""
        places = [LandmarkName(mark) for mark in self.marks]
        if self.kind == "straight":
            return Message("Custom: straight distance from {start} to {end}.", start=places[0], end=places[1])
        if self.kind == "skin":
            return Message(
                "Custom: shortest path over the skin from {start} to {end}.", start=places[0], end=places[1]
            )
        if not places:
            return Message(
                "Custom: horizontal tape, {height} above the lowest point of the scan.",
                height=length_of(self.level),
            )
        if self.level > 0.0:
            return Message(
                "Custom: horizontal tape, {height} above {place}.",
                height=length_of(self.level),
                place=places[0],
            )
        if self.level < 0.0:
            return Message(
                "Custom: horizontal tape, {height} below {place}.",
                height=length_of(-self.level),
                place=places[0],
            )
        return Message("Custom: horizontal tape at {place}.", place=places[0])


def check_customer(name: str) -> None:
    """Raise UserError if no sheet could name a customer so; nobody may be named."""
    if not is_printable(name, LONGEST_CUSTOMER):
        raise UserError(
            Message("The name of the customer is too long or contains unprintable characters."),
            Message("Use at most {count} characters.", count=LONGEST_CUSTOMER),
        )


def with_measurement(
    those: tuple[CustomMeasurement, ...], measure: CustomMeasurement, former: str = ""
) -> tuple[CustomMeasurement, ...]:
    """Return ``those`` with one more, in the place of the ``former`` one or of one of the same name."""
    former = former or measure.name
    if former in {each.name for each in those}:
        return tuple(measure if each.name == former else each for each in those)
    return (*those, measure)


HELP = (
    "NAME=KIND:PLACES: a measure of your own, may be repeated. 'Gore=straight:bust_point_left,front_centre' "
    "is straight between two landmarks, 'Arc=skin:...' the shortest way over the skin, "
    "'Ribs=girth:waist_front+60' a tape 60 mm above a landmark, 'Chest=girth:1250' one so "
    "high above the lowest point of the scan"
)
"""What a user has to know to write a measure."""


def parse_measurement(text: str) -> CustomMeasurement:
    """Read ``NAME=KIND:PLACES``, see ``HELP``. Raises UserError."""
    told = re.fullmatch(r"([^=]+)=\s*(\w+)\s*:(.*)", text.replace("\N{MINUS SIGN}", "-"))
    if told is None:
        raise UserError(
            Message("'{text}' is not a measurement.", text=text),
            Message("Enter NAME=KIND:PLACES. See 'busk measure --help'."),
        )
    name, kind, places = (part.strip() for part in told.groups())
    if kind != "girth":
        return CustomMeasurement(name, kind, tuple(place.strip() for place in places.split(",")))
    level = re.fullmatch(r"([a-z_]*)\s*([+-]?\s*\d+(?:\.\d+)?)?", places)
    if level is None or not places:
        raise UserError(
            Message("The girth {name} has no level.", name=name),
            Message("Specify one landmark, or a height in mm, or both."),
        )
    marks = (level[1],) if level[1] else ()
    return CustomMeasurement(name, kind, marks, float((level[2] or "0").replace(" ", "")))
