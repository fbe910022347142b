"""Band of a line: path, colour and width."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from core.document.design import Design
from core.geometry.mesh import Floats, Points
from core.pipeline.line_routes import NO_BACK, LineRoute

Rise = Callable[[Floats], Points]
"""Returns how far a band is off the skin, (rows, 3) [mm], at places along its line, (rows,) 0 to 1."""

BAND_WIDTHS = {"full-bust": 10.0, "mid-bust": 12.0, "under-bust": 22.0}
"""Usual width of the bands of the template's lines [mm]; what they are made of comes with the garment."""

OWN_WIDTH = 12.0
"""Usual width of the band of an own line [mm]."""

OFF_WIDTH = 4.0
"""Width of the dashes that show where a line lies that is off [mm]."""


def band_width(name: str, design: Design | None = None) -> float:
    """Return the width of a line's band as it is drawn [mm]."""
    own, whole = design.line_settings(name).width if design else None, name.rpartition(" ")[0]
    return BAND_WIDTHS.get(name, BAND_WIDTHS.get(whole, OWN_WIDTH)) if own is None else own


@dataclass(frozen=True, eq=False)
class Band:
    """What is drawn of one line: its path on the body at rest, (k, 3) [mm], colour and width [mm].

    ``back``, shape (b, 3) [mm], goes on round the back to where the path begins, or over the shoulder;
    without it the band ends. One that is ``off`` is dashed; a path that was ``drawn`` is kept as it is,
    ends of one that is ``sewn`` are.
    """

    name: str
    path: Points
    colour: str
    width: float = 12.0
    back: Points = field(default_factory=lambda: NO_BACK)
    off: bool = False
    drawn: bool = False
    sewn: bool = False

    @property
    def route(self) -> LineRoute:
        """Return the path of the band."""
        return LineRoute(self.path, self.back, self.drawn, self.sewn)
