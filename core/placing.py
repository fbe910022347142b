"""Where the designer says that a landmark is, in the scan file's own frame: kept, written and read."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from core.errors import LandmarkError
from core.landmark import NAMES
from core.mesh import Floats, Points

HELP = (
    "NAME=x,y,z: a landmark that you place yourself, like bust_point_left=112.5,-140,1204; may be repeated. "
    "The numbers are those of the scan file, in its own frame and unit, as any 3D program shows them and as "
    f"'busk detect' prints them. The names are: {', '.join(NAMES)}"
)
"""What a user has to know to place a landmark."""

FARTHEST = 1e9
"""A coordinate beyond this [file units] is a mistake."""


@dataclass(frozen=True)
class PlacedMark:
    """A landmark placed by hand; ``position`` (x, y, z) is in the frame and unit of the scan file.

    So it stays on its spot of the skin whatever unit and pose the file is read in. Raises LandmarkError.
    """

    name: str
    position: tuple[float, float, float]

    def __post_init__(self) -> None:
        if self.name not in NAMES:
            raise LandmarkError(f"There is no landmark {self.name}.", f"Choose one of {', '.join(NAMES)}.")
        if not all(math.isfinite(x) and abs(x) < FARTHEST for x in self.position):
            raise LandmarkError(f"{self.name} needs a place with three numbers.", "Give x, y and z.")


def placed_mark(text: str) -> PlacedMark:
    """Read ``NAME=x,y,z``; hyphens and underscores mean the same. Raises LandmarkError, see ``HELP``."""
    name, _, place = text.replace("\N{MINUS SIGN}", "-").partition("=")
    try:
        x, y, z = map(float, place.split(","))
    except ValueError:
        raise LandmarkError(
            f"'{text}' places no landmark.", "Write NAME=x,y,z with the numbers of the scan file."
        ) from None
    return PlacedMark(name.strip().lower().replace("-", "_"), (x, y, z))


def in_mm(placed: Iterable[PlacedMark], file_to_mm: Floats) -> dict[str, Points]:
    """Return where placed landmarks are in the canonical frame, each (3,) [mm]; ``file_to_mm`` is (4, 4)."""
    return {mark.name: file_to_mm[:3, :3] @ mark.position + file_to_mm[:3, 3] for mark in placed}


def in_file(position: Points, file_to_mm: Floats) -> tuple[float, float, float]:
    """Return where a place of the canonical frame, shape (3,) [mm], is in the scan file."""
    x, y, z = np.linalg.solve(file_to_mm[:3, :3], position - file_to_mm[:3, 3]).tolist()
    return x, y, z
