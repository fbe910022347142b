"""What a tape measures on the body: bust and under-bust girths, arms taken out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from core.body import Body
from core.landmark import Landmarks
from core.mesh import Mesh
from core.trunk import Level, stable_level, trunk_levels


@dataclass(frozen=True)
class Girth:
    """A girth at height ``level_mm``: ``tape_mm`` bridges the hollows, ``skin_mm`` follows them."""

    level_mm: float
    tape_mm: float
    skin_mm: float


def girth_at(mesh: Mesh, z: float) -> Girth:
    """Return the girth of the trunk of ``mesh`` at height ``z`` [mm]; zero where there is no trunk."""
    return _girth(trunk_levels(mesh, [z])[0])


def girths(body: Body, landmarks: Landmarks) -> Mapping[str, Girth]:
    """Return the "bust" girth at the bust level, and the "underbust" girth where a tape would lie.

    That is the first height from the under-bust level down which no longer nicks the breasts: there the girth
    hardly changes with the height. Source: ours.
    """
    return MappingProxyType(
        {
            "bust": girth_at(body.calm, landmarks.bust_level),
            "underbust": _girth(stable_level(body.calm, landmarks.underbust_level)),
        }
    )


def _girth(level: Level) -> Girth:
    return Girth(level.z, level.tape, level.skin)
