"""Detect the landmarks of the lower trunk on the skin; those that are placed by hand stand."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

import numpy as np

from core.errors import LandmarkError
from core.geometry.mesh import SIGNS, Mesh, Points
from core.landmarks.lower_trunk.levels import Level, Profile
from core.landmarks.lower_trunk.seat import CREASE, buttock_point, gluteal_fold
from core.landmarks.lower_trunk.sections import LowerSections, crossings
from core.landmarks.lower_trunk.suggestions import suggestions
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.manual import project_to_skin, reconcile_with_detected
from core.landmarks.types import SIDES, Landmark, Landmarks
from core.messages import Message
from core.progress import Progress, quiet
from core.scan.body import Body

CROTCH = Message("Highest level at which the legs are apart.")
HIP = Message("On the front centre line, at the largest tape of the hips.")
WAIST = Message("On the front centre line, at the narrowest level between hips and breasts.")
NO_WAIST = Message("No narrowest level between hips and breasts: a usual height below the under-bust.")
BELLY = Message("Foremost place of the front centre line between pubis and waist.")
NO_BELLY = Message("Farthest place of the front centre line before a chord from pubis to waist.")
BUTTOCK = Message("Most prominent place of the seat.")
FLAT_SEAT = Message("Most prominent place of the seat: it lies high, as on a flat seat.")
FOLD = Message("Deepest crease below the seat.")
NO_FOLD = Message("No crease below the seat: most hollow place, approximate.")

HIGHEST_SEAT = 110.0
"""A most backward place higher over the crotch than this is not that of the seat [mm]; ours, by size."""

BELOW_CROTCH = 40.0
"""So far below the crotch a scan must show the legs [mm]; ours, by size."""

LEAST_HEIGHT = 300.0
"""Between under-bust and crotch there is at least so much on a body [mm]; ours, by size."""

NOTHING: Mapping[str, Points] = MappingProxyType({})

_SURE, _CLEAR, _APPROXIMATE = 0.95, 0.9, 0.4


def find_lower_landmarks(
    body: Body, bust: Landmarks, placed: Mapping[str, Points] = NOTHING, progress: Progress = quiet
) -> LowerLandmarks:
    """Return the landmarks of the lower trunk of a body whose ``bust`` is known.

    ``placed`` (3,) [mm] by name stand in place of what is found, and what depends on them follows. Raises
    LandmarkError where the legs are not seen, or a placed landmark is not near the skin, and Cancelled.
    """
    mesh = body.smoothed
    hand = project_to_skin(mesh, placed)
    progress("find lower landmarks", 0.0)
    given = float(hand["crotch"].position[2]) if "crotch" in hand else None
    sections = LowerSections(mesh, bust.underbust_level, given)
    crotch = _crotch(sections)
    progress("find lower landmarks", 0.4)
    profile = Profile(sections, crotch)
    _check_reach(sections, profile)
    found = {mark.name: mark for mark in _found(mesh, sections, profile, hand)}
    points = {name: reconcile_with_detected(hand.get(name), mark) for name, mark in found.items()}
    for mark in suggestions(sections, profile, points):
        points[mark.name] = reconcile_with_detected(hand.get(mark.name), mark)
    return LowerLandmarks(MappingProxyType(points), sections, tuple(_warnings(points)))


def _crotch(sections: LowerSections) -> float:
    """Return the height of the crotch [mm]. Raises LandmarkError if the scan does not show it."""
    crotch = sections.crotch
    if crotch is not None:
        return crotch
    if sections.top - sections.bottom < LEAST_HEIGHT:
        raise LandmarkError(
            Message("The scan ends above the crotch."),
            Message("The lower trunk requires a scan down to mid-thigh."),
        )
    raise LandmarkError(
        Message("The legs are not separate anywhere: the crotch is not detectable."),
        Message("Place the crotch landmark, or scan with the legs slightly apart."),
    )


def _check_reach(sections: LowerSections, profile: Profile) -> None:
    if profile.crotch - sections.bottom < BELOW_CROTCH * profile.scale:
        raise LandmarkError(
            Message("The scan ends just below the crotch."),
            Message("The lower trunk requires a scan down to mid-thigh."),
        )


def _found(
    mesh: Mesh, sections: LowerSections, profile: Profile, hand: Mapping[str, Landmark]
) -> Iterator[Landmark]:
    """Yield what is found; a level that is placed counts for those that are sought from it."""
    yield hand.get("crotch") or Landmark("crotch", _between_legs(sections, profile.crotch), _SURE, CROTCH)
    hip = profile.hip()
    yield _on_front(sections, "hip", hip, HIP)
    waist = profile.waist(_height(hand, "hip", hip))
    yield _on_front(sections, "waist", waist, WAIST if waist.found else NO_WAIST)
    belly = profile.belly(_height(hand, "waist", waist))
    yield _on_front(sections, "belly", belly, BELLY if belly.found else NO_BELLY)
    for side, sign in zip(SIDES, SIGNS, strict=True):
        place = buttock_point(mesh, sections, profile.crotch, sign)
        high = float(place[2]) - profile.crotch > HIGHEST_SEAT * profile.scale
        sure, rule = (_APPROXIMATE, FLAT_SEAT) if high else (_CLEAR, BUTTOCK)
        yield Landmark(f"buttock_{side}", place, sure, rule)
        seat = hand[f"buttock_{side}"].position if f"buttock_{side}" in hand else place
        fold, bend = gluteal_fold(sections, seat, profile.crotch)
        creased = bend >= CREASE
        sure, rule = (0.7, FOLD) if creased else (_APPROXIMATE, NO_FOLD)
        yield Landmark(f"gluteal_fold_{side}", fold, sure, rule)


def _height(hand: Mapping[str, Landmark], name: str, level: Level) -> float:
    return float(hand[name].position[2]) if name in hand else level.z


def _on_front(sections: LowerSections, name: str, level: Level, rule: Message) -> Landmark:
    trunk = sections.at(level.z).trunk
    y = crossings(trunk, sections.middle) if trunk is not None else np.empty(0)
    if not len(y):
        raise LandmarkError(
            Message("The trunk has a hole at the height of {name}.", name=name),
            Message("Fill the holes at the Scan step."),
        )
    place = np.array([sections.middle, y[0], level.z])
    assert trunk is not None
    return Landmark(name, place, level.confidence, rule, evidence=np.concatenate([trunk, trunk[:1]]))


def _between_legs(sections: LowerSections, crotch: float) -> Points:
    """Return the place between the legs where they meet, (3,) [mm]."""
    left, right = sections.at(crotch).legs
    if left is None or right is None:
        return np.array([sections.middle, 0.0, crotch])
    inner = left[np.argmin(left[:, 0])], right[np.argmax(right[:, 0])]
    return np.array([*(0.5 * (inner[0] + inner[1]))[:2], crotch])


def _warnings(points: Mapping[str, Landmark]) -> Iterator[Message]:
    waist = points["waist"]
    if waist.rule == NO_WAIST:
        yield Message("This body has no waist between hips and breasts: check the waist height.")
    if any(points[f"buttock_{side}"].rule == FLAT_SEAT for side in SIDES):
        yield Message("The seat is flat: check the buttock points.")
