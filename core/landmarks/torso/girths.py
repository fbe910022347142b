"""Tape girths of the body without arms: bust, under-bust and others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from core.geometry.mesh import Mesh
from core.landmarks.torso.cross_sections import STABLE_DOWN, Level, first_stable, trunk_levels
from core.landmarks.types import CERTAIN, SIDES, Landmarks
from core.messages import Message
from core.scan.body import Body

FURTHER = {"waist": ("waist_front",), "hip": ("hip_front",), "armpit": ("armpit_left", "armpit_right")}
"""Levels beside those of the bust, and the landmarks whose mean height they are."""

BUSTS = tuple(f"bust_point_{side}" for side in SIDES)
UNDER = tuple(f"{name}_{side}" for name in ("fold", "lowest") for side in SIDES)
"""The landmarks that the two levels of the bust are taken from."""

MUCH = 50.0
"""Over more than this of an outline that is no skin a girth is an estimate [mm]."""

ESTIMATES = {
    "bust": Message("The bust girth crosses a hole in the scan or a merged arm: estimate."),
    "underbust": Message("The under-bust girth crosses a hole in the scan or a merged arm: estimate."),
}
UNCERTAIN = Message(
    "The under-bust girth is uncertain because the heights of the inframammary folds are uncertain."
)


@dataclass(frozen=True)
class Girth:
    """A girth at height ``level_mm``: ``tape_mm`` bridges the hollows, ``skin_mm`` follows them.

    ``bridged_mm`` of the outline are no skin, but go over holes of the scan or where an arm joins the trunk.
    ``confidence`` (0..1) is that of the landmarks which the height was taken from.
    """

    level_mm: float
    tape_mm: float
    skin_mm: float
    bridged_mm: float = 0.0
    confidence: float = 1.0


def girth_at(mesh: Mesh, z: float) -> Girth:
    """Return the girth of the trunk of ``mesh`` at height ``z`` [mm]; zero where there is no trunk."""
    return _girth(trunk_levels(mesh, [z])[0])


def girths(body: Body, landmarks: Landmarks) -> Mapping[str, Girth]:
    """Return the girths [mm] that the scan shows: always "bust" and "underbust", often others.

    "bust" lies at the bust level; "underbust" where a tape would lie: at the first height from the under-bust
    level down which no longer nicks the breasts, as there the girth hardly changes with the height; "waist"
    and "hip" at their landmarks, and "high_bust" under the armpits, if those were found. Source: ours.
    """
    found = {name: _girth(level) for name, level in trunk_sections(body.smoothed, landmarks).items()}
    sure = confidences(landmarks)
    return MappingProxyType(
        {
            name: replace(girth, confidence=sure.get(name, 1.0))
            for name, girth in found.items()
            if name in ESTIMATES or girth.tape_mm > 0.0
        }
    )


def trunk_sections(mesh: Mesh, landmarks: Landmarks, down: float | None = None) -> dict[str, Level]:
    """Return the levels of ``mesh`` at which girths are measured, by name, as ``girths`` says.

    ``down`` [mm] is how far under the breasts the under-bust is measured, where that is not to be found.
    """
    heights = {"bust": landmarks.bust_level, **girth_levels(landmarks)}
    below = landmarks.underbust_level - (STABLE_DOWN if down is None else np.array([down]))
    z = np.unique([*heights.values(), *below])
    cut = dict(zip(z.tolist(), trunk_levels(mesh, z), strict=True))
    under = [cut[height] for height in below.tolist()]
    found = {name: cut[float(height)] for name, height in heights.items()}
    return {
        "bust": found.pop("bust"),
        "underbust": first_stable(under) if down is None else under[0],
        **found,
    }


def confidences(landmarks: Landmarks) -> dict[str, float]:
    """Return how sure the heights of the girths are: as the surer bust point, else as the lowest mark."""
    marks = {"bust": BUSTS, "underbust": UNDER, **FURTHER, "high_bust": FURTHER["armpit"]}
    found = {name: [landmarks.points[k] for k in own if k in landmarks.points] for name, own in marks.items()}
    sure = {
        name: min(own, key=lambda mark: float(mark.position[2])).confidence
        for name, own in found.items()
        if own
    }
    return sure | {"bust": max((mark.confidence for mark in found["bust"]), default=1.0)}


def levels(landmarks: Landmarks) -> dict[str, float]:
    """Return the heights [mm] of bust and under-bust, and of what else was found; armpits at their mean."""
    heights = {"bust": float(landmarks.bust_level), "underbust": float(landmarks.underbust_level)}
    for name, marks in FURTHER.items():
        found = [float(landmarks.position(mark)[2]) for mark in marks if mark in landmarks.points]
        if found:
            heights[name] = sum(found) / len(found)
    return heights


def girth_levels(landmarks: Landmarks) -> Mapping[str, float]:
    """Return the heights [mm] at which further girths are measured, those whose landmarks were found."""
    found = {name: z for name, z in levels(landmarks).items() if name in ("waist", "hip")}
    pits = [float(landmarks.position(name)[2]) for name in FURTHER["armpit"] if name in landmarks.points]
    if len(pits) == 2 and min(pits) > landmarks.bust_level + 15.0:
        found["high_bust"] = min(pits) - 2.0
    return MappingProxyType(found)


def girth_warnings(found: Mapping[str, Girth]) -> list[Message]:
    """Return one sentence for each girth of the bust that is an estimate, or whose height is uncertain."""
    estimates = [text for name, text in ESTIMATES.items() if name in found and found[name].bridged_mm > MUCH]
    return estimates + [UNCERTAIN] * ("underbust" in found and found["underbust"].confidence < CERTAIN)


def _girth(level: Level) -> Girth:
    return Girth(level.z, level.tape, level.skin, level.bridged_mm)
