"""Source of a scan: file, orientation and edits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from core.errors import UserError
from core.geometry.mesh import MAX_COORDINATE
from core.messages import Length, Message

SIDES = ("left", "right")
"""The sides of a body that can be kept and mirrored; left is +x."""

MOST_FILLED = 200
"""Holes that are filled one by one."""

LEAST_HEIGHT = 100.0
"""A crop must leave at least this height [mm]."""


_LONGEST_WORD = 100  # letters of a unit or an axis


@dataclass(frozen=True)
class ScanEdits:
    """The edits of a scan, applied in this order: crop, mirror, fill.

    ``low`` and ``high`` are the lowest and highest level that is kept [mm above the lowest point of the whole
    upright scan], None without a crop. ``kept`` is the side that is mirrored onto the other one, or "".
    ``filled`` are the centres of the holes to fill, (x, y, z) [mm] on the upright body; ``fill_all`` fills
    every hole. Raises UserError for what is no edit.
    """

    low: float | None = None
    high: float | None = None
    kept: str = ""
    filled: tuple[tuple[float, float, float], ...] = ()
    fill_all: bool = False

    def __post_init__(self) -> None:
        levels = [level for level in (self.low, self.high) if level is not None]
        if not all(0.0 <= level < MAX_COORDINATE for level in levels):
            raise UserError(
                Message("The crop height is out of range."), Message("Enter a height of 0 mm or more.")
            )
        if len(levels) == 2 and levels[1] - levels[0] < LEAST_HEIGHT:
            raise UserError(
                Message("The crop removes the whole body."),
                Message("Keep at least {least} of the body height.", least=Length(LEAST_HEIGHT)),
            )
        if self.kept not in ("", *SIDES):
            raise UserError(
                Message("Unknown side of the body: '{kept}'.", kept=self.kept),
                Message("Choose left or right."),
            )
        if len(self.filled) > MOST_FILLED:
            raise UserError(
                Message("Too many holes selected individually: {count}.", count=len(self.filled)),
                Message("Fill all holes at once."),
            )
        if not all(
            np.shape(place) == (3,) and (np.abs(place) < MAX_COORDINATE).all() for place in self.filled
        ):
            raise UserError(
                Message("The centre of a hole requires three coordinates."),
                Message("Enter x, y and z in mm."),
            )

    def with_filled(self, centre: tuple[float, float, float]) -> ScanEdits:
        """Return the edits with one more hole filled, by its centre [mm]."""
        return replace(self, filled=(*self.filled, centre))

    def without_filled(self) -> ScanEdits:
        """Return the edits with every hole left as it is in the scan."""
        return replace(self, filled=(), fill_all=False)


UNEDITED = ScanEdits()
"""A scan as it came."""


def hole_centre(text: str) -> tuple[float, float, float]:
    """Read the centre of a hole, ``x,y,z`` [mm]. Raises UserError."""
    try:
        x, y, z = map(float, text.replace("\N{MINUS SIGN}", "-").split(","))
    except ValueError:
        raise UserError(
            Message("The centre of a hole requires three coordinates."), Message("Enter x, y and z in mm.")
        ) from None
    return x, y, z


@dataclass(frozen=True)
class ScanSource:
    """Where the scan lies: the file ``path``, or ``member`` of the project ``path``.

    ``unit``, ``up`` and ``front`` are None unless they were set by hand; ``up`` and ``front`` are axes of the
    file like "+z", or directions in it like "0.2,0,1". ``edits`` refer to the upright body; the file is never
    changed. Raises UserError for what is far too long.
    """

    path: str
    member: str = ""
    unit: str | None = None
    up: str | None = None
    front: str | None = None
    edits: ScanEdits = UNEDITED

    def __post_init__(self) -> None:
        if any(len(word or "") > _LONGEST_WORD for word in (self.unit, self.up, self.front)):
            raise UserError(
                Message("The unit, up axis or front axis of the scan is not valid."),
                Message("Specify a unit such as cm and axes such as +z."),
            )

    def set_up(self, **told: str | None) -> ScanSource:
        """Return the source with another unit, up or front, without edits, which refer to the former."""
        values: dict[str, Any] = dict(told)
        after = replace(self, **values)
        return after if after == self else replace(after, edits=UNEDITED)

    @property
    def name(self) -> str:
        """Return the scan's file name."""
        return Path(self.member or self.path).name
