"""What a tape measures on the body: bust, under-bust and the other girths that it shows, arms taken out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from core.body import Body
from core.landmark import Landmarks
from core.mesh import Mesh
from core.trunk import Level, stable_level, trunk_levels

ARMPITS = ("armpit_left", "armpit_right")

MUCH = 50.0
"""Over more than this of an outline that is no skin a girth is an estimate [mm]."""

WARNINGS = {
    "bust": "The bust girth goes over a hole of the scan or over a joined arm: it is an estimate.",
    "underbust": "The under-bust girth goes over a hole of the scan or over a joined arm: it is an estimate.",
}


@dataclass(frozen=True)
class Girth:
    """A girth at height ``level_mm``: ``tape_mm`` bridges the hollows, ``skin_mm`` follows them.

    ``bridged_mm`` of the outline are no skin, but go over holes of the scan or where an arm joins the trunk.
    """

    level_mm: float
    tape_mm: float
    skin_mm: float
    bridged_mm: float = 0.0


def girth_at(mesh: Mesh, z: float) -> Girth:
    """Return the girth of the trunk of ``mesh`` at height ``z`` [mm]; zero where there is no trunk."""
    return _girth(trunk_levels(mesh, [z])[0])


def girths(body: Body, landmarks: Landmarks) -> Mapping[str, Girth]:
    """Return the girths [mm] that the scan shows: always "bust" and "underbust", often others.

    "bust" lies at the bust level; "underbust" where a tape would lie: at the first height from the under-bust
    level down which no longer nicks the breasts, as there the girth hardly changes with the height; "waist"
    and "hip" at their landmarks, and "high_bust" under the armpits, if those were found. Source: ours.
    """
    found = {
        "bust": girth_at(body.calm, landmarks.bust_level),
        "underbust": _girth(stable_level(body.calm, landmarks.underbust_level)),
    }
    further = {name: girth_at(body.calm, z) for name, z in girth_levels(landmarks).items()}
    return MappingProxyType(found | {name: girth for name, girth in further.items() if girth.tape_mm > 0.0})


def girth_levels(landmarks: Landmarks) -> Mapping[str, float]:
    """Return the heights [mm] at which further girths are measured, those whose landmarks were found."""
    points = landmarks.points
    levels = {
        name: float(points[mark].position[2])
        for name, mark in (("waist", "waist_front"), ("hip", "hip_front"))
        if mark in points
    }
    pits = [float(points[name].position[2]) for name in ARMPITS if name in points]
    if len(pits) == 2 and min(pits) > landmarks.bust_level + 15.0:
        levels["high_bust"] = min(pits) - 2.0
    return MappingProxyType(levels)


def girth_doubts(found: Mapping[str, Girth]) -> list[str]:
    """Return one sentence for each girth of the bust that is an estimate: much of its outline is no skin."""
    return [WARNINGS[name] for name in WARNINGS if name in found and found[name].bridged_mm > MUCH]


def _girth(level: Level) -> Girth:
    return Girth(level.z, level.tape, level.skin, level.bridged_mm)
