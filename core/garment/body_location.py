"""Names of positions on the body: side and height."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.geometry.mesh import Floats, Mesh

SIDES = (
    *("front", "front left", "left side", "back left"),
    *("back", "back right", "right side", "front right"),
)
"""The sides of a body, from the front round by the subject's left; each is an eighth of a turn wide."""

SHOULDERS = ("left shoulder", "right shoulder")
"""Where skin looks up in the middle between front and back."""

_SLAB = 15.0  # how far above and below a place the body's depth is taken [mm]
_UP = 0.7  # skin whose normal points up more than this lies on top
_BETWEEN = 0.25  # how far from the middle between front and back a shoulder reaches, in depths


@dataclass(frozen=True)
class BodyLocation:
    """``side`` is one of ``SIDES`` or ``SHOULDERS``; ``height_mm`` is that above the lowest point."""

    side: str
    height_mm: float


def body_location(body: Mesh, middle: float, place: Floats, normal: Floats) -> BodyLocation:
    """Return where a place on a body with the skin's ``normal``, both (3,) [mm], is.

    Left is where x is larger than ``middle`` [mm].
    """
    z = body.vertices[:, 2]
    level = body.vertices[np.abs(z - place[2]) < _SLAB, 1]
    front, back = (float(level.min()), float(level.max())) if len(level) else (place[1], place[1])
    aside, ahead = float(place[0]) - middle, 0.5 * (front + back) - float(place[1])
    if normal[2] > _UP and abs(ahead) < _BETWEEN * (back - front):
        side = SHOULDERS[0 if aside > 0.0 else 1]
    else:
        turn = np.arctan2(aside, ahead) / (2.0 * np.pi)
        side = SIDES[round(float(turn) * len(SIDES)) % len(SIDES)]
    return BodyLocation(side, float(place[2] - z.min()))
