"""Space: the unit and the axes that a file is written in, for the program that opens it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.errors import UserError
from core.geometry.mesh import Floats, Points
from core.messages import Message, SettingName

UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}
"""What a file can be written in, in millimetres."""

AXES: dict[str, tuple[tuple[int, int, int], ...]] = {
    "z-up": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "y-up": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "z-up-front-y": ((-1, 0, 0), (0, -1, 0), (0, 0, 1)),
}
"""The axes of a file, each in those of Busk.

"z-up" faces -y (Busk, Blender), "y-up" faces z (glTF, CLO, Maya), "z-up-front-y" faces y.
"""

GLTF = ("glb",)
"""Formats that are glTF, which sets unit and axes: metres, y up and z to the front."""


@dataclass(frozen=True)
class FileSpace:
    """The unit and the axes of a file. Raises UserError for words that are neither."""

    unit: str = "mm"
    axes: str = "z-up"

    def __post_init__(self) -> None:
        for word, choices, what in (
            (self.unit, UNITS, SettingName("unit")),
            (self.axes, AXES, SettingName("axis convention")),
        ):
            if word not in choices:
                raise UserError(
                    Message("There is no {what} '{value}'.", what=what, value=word),
                    Message("Choose one of: {choices}.", choices=", ".join(choices)),
                )

    def places(self, points: Points) -> Points:
        """Return places of Busk, shape (k, 3) [mm], as they stand in the file."""
        return np.asarray(points @ self._turn.T / UNITS[self.unit])

    def normals(self, normals: Points) -> Points:
        """Return directions of Busk, shape (k, 3) [1], as they stand in the file."""
        return np.asarray(normals @ self._turn.T)

    @property
    def _turn(self) -> Floats:
        return np.array(AXES[self.axes], dtype=np.float64)


def space_of(kind: str, unit: str | None = None, axes: str | None = None) -> FileSpace:
    """Return the space of a file of some kind, "ply", "glb" ..; what is not told is as usual for that kind.

    Raises UserError for unknown words.
    """
    usual = ("m", "y-up") if kind in GLTF else ("mm", "z-up")
    return FileSpace(unit or usual[0], axes or usual[1])
