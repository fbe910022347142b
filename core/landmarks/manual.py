"""Landmarks placed by hand: written and kept in the frame of the scan file, and laid on the skin."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.errors import LandmarkError
from core.geometry.closest_point import nearest_on
from core.geometry.mesh import MAX_COORDINATE, Floats, Mesh, Points
from core.geometry.mirror_plane import mirror
from core.landmarks.types import ALL_NAMES, CERTAIN, Landmark
from core.messages import LandmarkName, Length, Message

HELP = (
    "NAME=x,y,z: a landmark that you place yourself, like bust_point_left=112.5,-140,1204; may be repeated. "
    "The numbers are those of the scan file, in its own frame and unit, as any 3D program shows them and as "
    f"'busk detect' prints them. The names are: {', '.join(ALL_NAMES)}"
)
"""What a user has to know to place a landmark."""

PLACED = Message("Placed manually.")

ASTRAY, ADRIFT = 15.0, 20.0
"""So far from where a rule finds it [mm], a placed landmark contradicts the rule: one that is sure of itself,
and one that is not quite.
"""

DIM = 0.2
"""A rule with less confidence [1] is contradicted by nothing."""

REACH = 30.0
"""A placed point may lie so far off the skin [mm]."""


@dataclass(frozen=True)
class PlacedMark:
    """A landmark placed by hand; ``position`` (x, y, z) is in the frame and unit of the scan file.

    So it stays on its spot of the skin whatever unit and pose the file is read in. Raises LandmarkError.
    """

    name: str
    position: tuple[float, float, float]

    def __post_init__(self) -> None:
        check_place(self.name, self.position)


def check_place(name: str, place: Sequence[float] | Points) -> None:
    """Raise LandmarkError for a name that no landmark has, and for what is no place."""
    if name not in ALL_NAMES:
        raise LandmarkError(
            Message("There is no landmark {name}.", name=name),
            Message("Choose one of {choices}.", choices=", ".join(ALL_NAMES)),
        )
    if np.shape(place) != (3,) or not (np.abs(place) < MAX_COORDINATE).all():
        raise LandmarkError(
            Message("The position of {name} requires three numbers.", name=name), Message("Enter x, y and z.")
        )


def placed_mark(text: str) -> PlacedMark:
    """Read ``NAME=x,y,z``; hyphens and underscores mean the same. Raises LandmarkError, see ``HELP``."""
    name, _, place = text.replace("\N{MINUS SIGN}", "-").partition("=")
    try:
        x, y, z = map(float, place.split(","))
    except ValueError:
        raise LandmarkError(
            Message("'{text}' is not a landmark position.", text=text),
            Message("Enter NAME=x,y,z in the coordinates of the scan file."),
        ) from None
    return PlacedMark(name.strip().lower().replace("-", "_"), (x, y, z))


def in_mm(placed: Iterable[PlacedMark], file_to_mm: Floats) -> dict[str, Points]:
    """Return where placed landmarks are in the canonical frame, each (3,) [mm]; ``file_to_mm`` is (4, 4)."""
    return {mark.name: file_to_mm[:3, :3] @ mark.position + file_to_mm[:3, 3] for mark in placed}


def in_file(position: Points, file_to_mm: Floats) -> tuple[float, float, float]:
    """Return where a place of the canonical frame, shape (3,) [mm], is in the scan file."""
    x, y, z = np.linalg.solve(file_to_mm[:3, :3], position - file_to_mm[:3, 3]).tolist()
    return x, y, z


def project_to_skin(mesh: Mesh, placed: Mapping[str, Points]) -> dict[str, Landmark]:
    """Return ``placed`` points, each of shape (3,) [mm], as landmarks at the nearest place of the skin.

    Raises LandmarkError for a name that no landmark has, and for a place that is not near the skin.
    """
    return {name: _laid(mesh, name, np.asarray(place, dtype=np.float64)) for name, place in placed.items()}


def reconcile_with_detected(placed: Landmark | None, found: Landmark) -> Landmark:
    """Return a landmark ``placed`` by hand, with how far it is off what its rule ``found``, which stands if
    none was placed.
    """
    if placed is None or found.by_hand:
        return found
    off = float(np.linalg.norm(placed.position - found.position))
    if found.confidence < DIM or off < (ASTRAY if found.confidence >= CERTAIN else ADRIFT):
        return placed
    return replace(
        placed, off=off, rule=Message("Placed manually, {off} from the detected position.", off=Length(off))
    )


def nearest_skin(mesh: Mesh, point: Points) -> Points:
    """Return the place of the skin nearest to ``point``, both of shape (3,) [mm]."""
    corners, reach = mesh.vertices[mesh.faces], REACH
    low, high = corners.min(axis=1), corners.max(axis=1)
    while True:
        near = (low <= point + reach).all(axis=1) & (high >= point - reach).all(axis=1)
        spots = nearest_on(corners[near], np.broadcast_to(point, (int(near.sum()), 3)))
        away = np.linalg.norm(spots - point, axis=1)
        # Outside the box there may be a nearer face, unless this one lies within its ball.
        if away.min(initial=np.inf) <= reach or near.all():
            return np.asarray(spots[np.argmin(away)])
        reach *= 2.0


def mirrored(mesh: Mesh, point: Points, middle: float) -> Points:
    """Return the place of the skin nearest to the mirror image of ``point`` in x = ``middle`` [mm]."""
    return nearest_skin(mesh, mirror(point, middle))


def _laid(mesh: Mesh, name: str, point: Points) -> Landmark:
    check_place(name, point)
    place = nearest_skin(mesh, point)
    if np.linalg.norm(place - point) > REACH:
        raise LandmarkError(
            Message(
                "The landmark {name} is more than {far} off the skin.",
                name=LandmarkName(name.replace("_", " ")),
                far=Length(REACH),
            ),
            Message("Place the landmark on the skin."),
        )
    return Landmark(name, place, 1.0, PLACED, by_hand=True)
