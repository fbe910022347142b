"""Landmarks of the lower trunk: detection, placed points, warnings."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from core.geometry.mesh import Points
from core.landmarks.detect import FINDING, NOTHING
from core.landmarks.lower_trunk.levels import (
    belly,
    body_scale,
    crotch,
    hip,
    no_crotch,
    on_midline,
    tape_profile,
    waist,
)
from core.landmarks.lower_trunk.seat import buttock_point, gluteal_fold
from core.landmarks.lower_trunk.sections import LowerSections, lower_sections
from core.landmarks.lower_trunk.suggestions import iliac_crest, leg_opening, side_seam
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.manual import project_to_skin, reconcile_with_detected
from core.landmarks.types import CERTAIN, LOWER_NAMES, SIDES, Landmark, Landmarks
from core.messages import LandmarkName, Message
from core.progress import Progress, quiet
from core.scan.body import Body

SUGGESTIONS = ("iliac_crest", "side_seam", "leg_opening")
"""Landmarks that are never sure: no warning says so."""


def find_lower_landmarks(
    body: Body,
    bust: Landmarks,
    placed: Mapping[str, Points] = NOTHING,
    progress: Progress = quiet,
    sections: LowerSections | None = None,
) -> LowerLandmarks:
    """Detect the landmarks of the lower trunk of ``body``, below the under-bust of ``bust``.

    ``placed`` points by name, shape (3,) [mm], replace detected ones, and levels that depend on them follow;
    ``sections`` are those of ``body.smoothed`` up to the under-bust if they are known already. Raises
    LandmarkError if the scan ends above the crotch, if the thighs touch all the way and no crotch is placed,
    or for an invalid name or place; Cancelled. Source: ours.
    """
    mesh = body.smoothed
    cuts = lower_sections(mesh, bust.underbust_level) if sections is None else sections
    by_hand = project_to_skin(mesh, placed)
    progress(FINDING, 0.2)
    points = _levels(cuts, by_hand)
    progress(FINDING, 0.6)
    points |= _seat(cuts, by_hand, points)
    progress(FINDING, 0.8)
    points |= _suggested(cuts, by_hand, points)
    points = {name: points[name] for name in LOWER_NAMES if name in points}
    levels = {name: float(points[name].position[2]) for name in ("waist", "belly", "hip", "crotch")}
    pairs = (f"{name}_{side}" for name in ("buttock", "gluteal_fold") for side in SIDES)
    levels |= {name: float(points[name].position[2]) for name in pairs}
    levels["buttock"] = float(np.mean([points[f"buttock_{side}"].position[2] for side in SIDES]))
    return LowerLandmarks(MappingProxyType(points), MappingProxyType(levels), cuts, _warnings(points))


def _levels(cuts: LowerSections, by_hand: Mapping[str, Landmark]) -> dict[str, Landmark]:
    """Return crotch, hip, waist and belly: each follows those before it."""
    scale = body_scale(cuts)
    if cuts.search == "ends" or (cuts.search == "touch" and "crotch" not in by_hand):
        raise no_crotch(cuts)
    seen = by_hand["crotch"] if cuts.search == "touch" else crotch(cuts, scale)
    points = {"crotch": reconcile_with_detected(by_hand.get("crotch"), seen)}
    low = float(points["crotch"].position[2])
    profile = tape_profile(cuts, low + 4.0)
    hips = on_midline("hip", cuts, hip(profile, low, cuts.top))
    points["hip"] = reconcile_with_detected(by_hand.get("hip"), hips)
    level = float(points["hip"].position[2])
    narrow = on_midline("waist", cuts, waist(profile, level, cuts.top, scale))
    points["waist"] = reconcile_with_detected(by_hand.get("waist"), narrow)
    high = float(points["waist"].position[2])
    round_ = on_midline("belly", cuts, belly(cuts, low, high, scale))
    points["belly"] = reconcile_with_detected(by_hand.get("belly"), round_)
    return points


def _seat(
    cuts: LowerSections, by_hand: Mapping[str, Landmark], points: Mapping[str, Landmark]
) -> dict[str, Landmark]:
    """Return buttock points and gluteal folds."""
    low, scale, found = float(points["crotch"].position[2]), body_scale(cuts), {}
    for k, side in enumerate(SIDES):
        name = f"buttock_{side}"
        found[name] = reconcile_with_detected(by_hand.get(name), buttock_point(cuts, k, low, scale))
        fold = gluteal_fold(cuts, k, low, found[name])
        found[fold.name] = reconcile_with_detected(by_hand.get(fold.name), fold)
    return found


def _suggested(
    cuts: LowerSections, by_hand: Mapping[str, Landmark], points: Mapping[str, Landmark]
) -> dict[str, Landmark]:
    """Return what is suggested, as far as the scan has skin there."""
    low, hips, high = (float(points[name].position[2]) for name in ("crotch", "hip", "waist"))
    marks = []
    for k, side in enumerate(SIDES):
        fold = float(points[f"gluteal_fold_{side}"].position[2])
        marks += [iliac_crest(cuts, k, low), side_seam(cuts, k, low, hips, high)]
        marks.append(leg_opening(cuts, k, low, fold))
    found = {mark.name: mark for mark in marks if mark is not None}
    return found | {name: mark for name, mark in by_hand.items() if name.startswith(SUGGESTIONS)}


def _warnings(points: Mapping[str, Landmark]) -> tuple[Message, ...]:
    """Return one sentence for each landmark that needs a second look."""
    return tuple(
        Message(
            "Check the landmark {name}: {rule}", name=LandmarkName(name.replace("_", " ")), rule=mark.rule
        )
        for name, mark in points.items()
        if mark.confidence < CERTAIN and not name.startswith(SUGGESTIONS)
    )
