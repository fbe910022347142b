"""Line settings: active lines, lengths, custom lines and their options."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from itertools import pairwise
from math import isfinite

from core.control_mesh.embedding import Cell
from core.document.printable_name import check_line_name, is_blank, is_printable
from core.errors import LineError
from core.mechanics.options import RANGES
from core.messages import LineName, Message, length_of

BUST, LOWER = "bust", "lower"
"""The regions that a line may be in."""

LONGEST_TITLE = 60
"""Letters of a line's title."""

WIDTHS = (2.0, 100.0)
"""The narrowest and the widest band [mm]."""


@dataclass(frozen=True)
class ActiveLine:
    """A line that is worn, and its natural length as ratio of its length at rest [1] (paper section 3).

    Raises LineError for a name that no line has.
    """

    name: str
    ratio: float

    def __post_init__(self) -> None:
        check_line_name(self.name)


@dataclass(frozen=True)
class CustomLine:
    """A line of the designer's own; "closed" goes round.

    It runs through control points of the template, by number, or is a free line through ``places`` between
    them, by row and column of the template (``embedding``). One that goes ``over_shoulder`` runs on from
    its upper end down the back to the under-bust band. ``region`` tells whose template it is on: "bust" or
    "lower". One of the lower trunk may be the part there of a line of the bust, which it ``continues``: both
    are one band. Raises LineError if it has no name, does not go from point to point, or is closed and goes
    over the shoulder.
    """

    name: str
    points: tuple[int, ...] = ()
    closed: bool = False
    places: tuple[Cell, ...] = ()
    over_shoulder: bool = False
    region: str = BUST
    continues: str = ""

    def __post_init__(self) -> None:
        self._check_region()
        if is_blank(self.name):
            raise LineError(Message("A line has no name."), Message("Give each line a unique name."))
        check_line_name(self.name)
        stops: tuple[object, ...] = self.places or self.points
        following = stops + stops[:1] if self.closed else stops
        if len(stops) < (3 if self.closed else 2) or any(a == b for a, b in pairwise(following)):
            raise LineError(
                Message("The line {name} is not a sequence of points.", name=LineName(self.name)),
                Message(
                    "Enter at least two control points (three if the line is closed), with no "
                    "point repeated in succession."
                ),
            )
        if not all(isfinite(number) for place in self.places for number in place):
            raise LineError(
                Message("The line {line} has a point without a position.", line=LineName(self.name)),
                Message("Draw the line again."),
            )
        if self.closed and self.over_shoulder:
            raise LineError(
                Message(
                    "The line {line} is closed and cannot run over the shoulder.", line=LineName(self.name)
                ),
                Message("Leave the ends of the line open."),
            )

    def _check_region(self) -> None:
        if self.region not in (BUST, LOWER):
            raise LineError(
                Message("'{text}' is not a region.", text=self.region),
                Message("Choose one of: {choices}.", choices=f"{BUST}, {LOWER}"),
            )
        if self.region == LOWER and self.over_shoulder:
            raise LineError(
                Message("The line {line} is below the bust.", line=LineName(self.name)),
                Message("Only lines of the bust run over the shoulder."),
            )
        if self.continues and (self.region != LOWER or self.closed):
            raise LineError(
                Message("The line {line} cannot continue another line.", line=LineName(self.name)),
                Message("Choose an open line below the bust."),
            )

    @property
    def free(self) -> bool:
        """Return whether it runs between control points."""
        return bool(self.places)

    def count(self) -> int:
        """Return how many points or places it has."""
        return len(self.points) + len(self.places)

    @property
    def path(self) -> tuple[int, ...]:
        """Return the control points in order; a closed line ends with the one that it begins with."""
        return self.points + self.points[:1] if self.closed else self.points

    @property
    def grid_path(self) -> tuple[Cell, ...]:
        """Return the places of a free line in order; a closed line ends with the one that it begins with."""
        return self.places + self.places[:1] if self.closed else self.places


@dataclass(frozen=True)
class LineSettings:
    """How the designer treats a line, whether it is worn or not.

    ``title`` and ``colour`` ("#rrggbb") are empty where the usual ones stand. A ``locked`` line keeps its
    length and cannot be removed; a ``linked`` one shares its length with its partner of the other side.
    ``stiffness`` [1] is its own in place of the design's, or None; ``width`` [mm] is that of its band as it
    is drawn, or None for the usual one. ``elastic`` names what it is made of among the design's elastics, and
    gives it its stiffness; empty for nothing in particular. Raises LineError for what cannot be.
    """

    name: str
    title: str = ""
    colour: str = ""
    locked: bool = False
    linked: bool = True
    stiffness: float | None = None
    width: float | None = None
    elastic: str = ""

    def __post_init__(self) -> None:
        check_line_name(self.name)
        if not is_printable(self.title, LONGEST_TITLE):
            raise LineError(
                Message(
                    "The title of the line {name} is too long or contains unprintable characters.",
                    name=LineName(self.name),
                ),
                Message("Use at most {count} characters.", count=LONGEST_TITLE),
            )
        if self.colour and not re.fullmatch("#[0-9a-fA-F]{6}", self.colour):
            raise LineError(
                Message("'{text}' is not a colour.", text=self.colour),
                Message("Enter a colour such as #e5536b."),
            )
        low, high = RANGES["line_stiffness"]
        if self.stiffness is not None and not low <= self.stiffness <= high:
            raise LineError(
                Message(
                    "The stiffness {value} of the line {name} is out of range.",
                    value=f"{self.stiffness:g}",
                    name=LineName(self.name),
                ),
                Message("Enter a value from {low} to {high}.", low=f"{low:g}", high=f"{high:g}"),
            )
        if self.width is not None and not WIDTHS[0] <= self.width <= WIDTHS[1]:
            raise LineError(
                Message(
                    "The width {width} of the line {name} is out of range.",
                    name=LineName(self.name),
                    width=length_of(self.width),
                ),
                Message("Enter a value from {low} to {high}.", low=f"{WIDTHS[0]:g}", high=f"{WIDTHS[1]:g}"),
            )

    def mechanical(self) -> LineSettings:
        """Return what of it acts on the model: a name, a colour, a lock and a link do not."""
        return replace(self, title="", colour="", locked=False, linked=True)


def partner_of(name: str) -> str:
    """Return what a line's partner on the other side is called, or an empty text if it has no side.

    Lines of the templates have a hyphen before their side, a designer's own a space.
    """
    for side, other in ((" left", " right"), (" right", " left"), ("-left", "-right"), ("-right", "-left")):
        if name.endswith(side):
            return name.removesuffix(side) + other
    return ""
