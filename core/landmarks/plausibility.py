"""Plausibility of an upright upper body of true size, by its proportions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.mesh import Mesh, Points
from core.geometry.plane_sections import hull_corners
from core.landmarks.body_scale import Build, size_hint
from core.landmarks.torso.cross_sections import Level, stable_level, trunk_levels
from core.landmarks.types import CERTAIN, SIDES, Hint, Landmark, Landmarks
from core.landmarks.validation import refusal
from core.messages import Length, Message
from core.scan.orientation.lean_angles import corrected_up
from core.scan.orientation.pose import Pose

BACK, UPRIGHT, LEANS = 190.0, 9.0, 11.5
"""So far below the arm-pits [mm] a back slopes backward on its way up by so much [degrees]; one that does so
much more or less leans."""


ANGULAR = 0.91
"""A section fills this share of the rectangle around it [1] if it is angular: those of bodies fill 0.89."""

FLAT_GIRTH, FLAT_DEPTH = 0.11, 34.0
"""A bust that is wider than the trunk under it by less than this part and stands out by less [mm] is flat."""

FLAT_SLOPE, FLAT_RUN, FLAT_AROUND, FAINT = 0.45, 42.0, 0.17, 0.3
"""So is one that stands out by less than this part of its drop to a fold that is hardly seen, and less than
so far, and is wider than the trunk by less than this part [1, mm, 1, 1]."""

SHALLOW = 24.0
"""So is one that stands out by less than this [mm], and by less than that part of its drop."""

SMALL, SEEN = 0.085, 0.8
"""One with both bust points certain over a fold that is seen so clearly [1] is flat if it is wider than the
trunk by less than this part: a small or compressed bust is no doubt."""

AHEAD, AROUND, BESIDE_SPINE = 1.2, 2.4, (1.4, 2.5)
"""Directions from the front in which cloth under the bust hangs in waves, so far round, and those between
arms and spine where it does at any height [radians]."""

WRINKLED = (2.2, 2.5), 4.5
"""Upright waves of the skin [mm, root of the mean square] under the bust ahead and around: women have 1.9 at
most ahead, men 2.5 around. Beside the spine, where the scan ends at the bust: bodies have 3.6 at most."""

CREASED = 2.4
"""Waves around [mm] that are enough where cloth hides the folds as well."""

FEWEST = 3
"""Levels that show waves [1]."""

BRIDGED, LONG = 16.0, 45.0
"""Cloth that hides folds leaves the middle so little behind the bust points, and drops so far [mm]."""

DOUBTED = 0.45
"""The most that a landmark of the bust claims (0..1) where no breasts or clothes show."""

UNCLEAR = ("flat", "clothes")
"""The kinds of hints that make landmarks of the bust doubtful."""


def lean_hint(build: Build, pose: Pose) -> tuple[Hint, ...]:
    """Return a hint where the trunk leans in a file that is level, and the up that would correct it."""
    levels = [level for level in build.levels if level.z > build.armpit - BACK]
    if len(levels) < 8 or pose.tilt > 0.0:
        return ()
    slope = np.polyfit([level.z for level in levels], [_back(level) for level in levels], 1)[0]
    lean = UPRIGHT - float(np.degrees(np.arctan(slope)))
    if abs(lean) < LEANS:
        return ()
    up = corrected_up(pose, lean, 0.0)
    forward, lean = lean > 0.0, abs(lean)
    if forward:
        sentence = Message(
            "The trunk leans forward by about {lean} degrees, and girths are measured horizontally. Set "
            "the body upright at the Scan step.",
            lean=f"{lean:.0f}",
        )
    else:
        sentence = Message(
            "The trunk leans backward by about {lean} degrees, and girths are measured horizontally. Set "
            "the body upright at the Scan step.",
            lean=f"{lean:.0f}",
        )
    return (Hint("lean", sentence, up),)


def _back(level: Level) -> float:
    """Return how far back a level reaches near its middle [mm]."""
    x, y = level.points[:, 0], level.points[:, 1]
    low, high = x.min(), x.max()
    return float(y[np.abs(x - 0.5 * (low + high)) < 0.25 * (high - low)].max(initial=y.min()))


def require_not_angular(build: Build, landmarks: Landmarks) -> None:
    """Raise LandmarkError where the trunk is a block rather than a body."""
    under = [level for level in build.levels if level.z < landmarks.underbust_level - 5.0]
    if len(under) > 2 and np.median([_filling(level) for level in under[-4:]]) > ANGULAR:
        raise refusal(Message("the cross-section of the trunk is rectangular, unlike that of a body"))


def hints(build: Build, pose: Pose, landmarks: Landmarks) -> tuple[Hint, ...]:
    """Return what the body seems to be that it should not be, most important first. Source: ours."""
    clothes = clothes_hint(build, landmarks)
    flat = () if clothes else flat_hint(build.mesh, landmarks)
    size = () if flat else size_hint(build, pose)
    return (*size, *clothes, *flat, *lean_hint(build, pose))


def flat_hint(mesh: Mesh, landmarks: Landmarks) -> tuple[Hint, ...]:
    """Return a hint where hardly a breast stands out of the chest."""
    under, bust = stable_level(mesh, landmarks.underbust_level), trunk_levels(mesh, landmarks.bust_level)[0]
    more = bust.tape - under.tape
    depth, drop = _breast(landmarks)
    seen = max(landmarks.points[f"fold_{side}"].confidence for side in SIDES)
    points = min(landmarks.points[f"bust_point_{side}"].confidence for side in SIDES)
    clear = seen > SEEN and points >= CERTAIN
    low = more < (SMALL if clear else FLAT_GIRTH) * under.tape and depth < FLAT_DEPTH
    low |= not clear and depth < min(FLAT_SLOPE * drop, SHALLOW)
    hung = depth < min(FLAT_SLOPE * drop, FLAT_RUN) and seen < FAINT and more < FLAT_AROUND * under.tape
    if not (low or hung):
        return ()
    sentence = Message(
        "The bust girth is only {more} larger than the under-bust girth. The breasts may be "
        "small, compressed, removed or covered by loose clothes, or the body may be male: check "
        "bust points and inframammary folds.",
        more=Length(more),
    )
    return (Hint("flat", sentence),)


def clothes_hint(build: Build, landmarks: Landmarks) -> tuple[Hint, ...]:
    """Return a hint where the skin under the bust is wrinkled like loose clothes, or cloth hides folds."""
    under = [level for level in build.levels if level.z < landmarks.underbust_level - 10.0]
    around = _waves(under, 0.0, AROUND)
    wrinkled = _waves(under, 0.0, AHEAD) > WRINKLED[0][0] and around > WRINKLED[0][1]
    wrinkled |= len(under) < FEWEST and _waves(build.levels, *BESIDE_SPINE) > WRINKLED[1]
    seen = [landmarks.points[f"fold_{side}"].confidence for side in SIDES]
    centre = landmarks.points.get("front_centre")
    busts = np.mean([landmarks.position(f"bust_point_{side}") for side in SIDES], axis=0)
    bridged = centre is not None and centre.position[1] - busts[1] < BRIDGED
    hidden = max(seen) < 0.5 and min(seen) < FAINT and bridged and _breast(landmarks)[1] > LONG
    if not (wrinkled or (around > CREASED and hidden)):
        return ()
    sentence = Message(
        "The surface under the bust has wrinkles like loose clothing. Bust points and inframammary folds "
        "under clothing are uncertain: scan the body in close-fitting underwear, or check these landmarks."
    )
    return (Hint("clothes", sentence),)


def _breast(landmarks: Landmarks) -> tuple[float, float]:
    """Return how far bust points lie before and above the folds, means of both sides [mm]."""
    busts, folds = (
        np.mean([landmarks.position(f"{kind}_{side}") for side in SIDES], axis=0)
        for kind in ("bust_point", "fold")
    )
    return float(folds[1] - busts[1]), float(busts[2] - folds[2])


def _waves(levels: Sequence[Level], low: float, high: float) -> float:
    """Return the size of upright waves that go through most levels [mm]: of radius over direction.

    Directions from ``low`` to ``high`` from the front [radians] are measured, 0 for too few levels.
    """
    turn = np.radians(np.arange(-180.0, 180.0, 2.0))
    waves = []
    for level in levels:
        p = level.segments.reshape(-1, 3)[:, :2]
        if len(p) < 60:
            continue
        p = p - 0.5 * (p.min(axis=0) + p.max(axis=0))
        way, radius = np.arctan2(p[:, 0], -p[:, 1]), np.hypot(p[:, 0], p[:, 1])
        order = np.argsort(way)
        even = np.interp(turn, way[order], radius[order], period=2.0 * np.pi)
        waves.append(gaussian_filter1d(even, 0.8, mode="wrap") - gaussian_filter1d(even, 7.0, mode="wrap"))
    if len(waves) < FEWEST:
        return 0.0
    measured = (np.abs(turn) >= low) & (np.abs(turn) < high)
    return float(np.sqrt((np.median(waves, axis=0)[measured] ** 2).mean()))


def confidence_limit(points: Mapping[str, Landmark], found: tuple[Hint, ...]) -> float:
    """Return the most that landmarks of the bust may claim (0..1) with these hints."""
    by_hand = all(points[f"bust_point_{side}"].by_hand for side in SIDES)
    return DOUBTED if not by_hand and any(hint.kind in UNCLEAR for hint in found) else 1.0


def _filling(level: Level) -> float:
    """Return how much of the rectangle around a level its hull fills [1]."""
    flat: Points = level.points[:, :2]
    ring = flat[hull_corners(flat)]
    following = np.roll(ring, -1, axis=0)
    area = 0.5 * abs(float((ring[:, 0] * following[:, 1] - ring[:, 1] * following[:, 0]).sum()))
    return area / max(float(np.prod(np.ptp(ring, axis=0))), 1e-9)
