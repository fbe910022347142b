"""The landmarks of the bust: bust points, under-bust folds, lowest points of the breasts, and two levels."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.body import Body
from core.errors import LandmarkError
from core.landmark import SIDES, Landmark, Landmarks
from core.mesh import Floats, Mesh, Points
from core.placed import placed_marks
from core.relief import Anchor, Nipple, Pole, breast_patch, find_anchor, find_nipples, find_poles
from core.sections import arc_length, chains, cut, resample
from core.trunk import Survey, stable_level, survey, trunk_levels

NOTHING: Mapping[str, Points] = MappingProxyType({})

OFFSETS = (-8.0, -4.0, 0.0, 4.0, 8.0)
"""The fold is read on profiles so far beside the bust point [mm]."""

NIPPLE = "The nipple: the spot that stands out of the smooth breast around it."
PROMINENT = "The most prominent point of the breast: no nipple stands out of it."
MIRRORED = "The most prominent point, shifted towards where the nipple of the other breast lies."
CREASE = "The sharpest crease below the breast, on the upright profile through the bust point."
NO_CREASE = "The most hollow place below the breast: the upright profile shows no crease."
LOWEST = "The lowest point of the breast between the bust point and the fold."


def find_landmarks(body: Body, placed: Mapping[str, Points] = NOTHING) -> Landmarks:
    """Return the bust landmarks of ``body``; ``placed`` points, by name, shape (3,) [mm], replace found ones.

    What depends on a placed point follows it. Raises LandmarkError if the body shows no bust, unless bust
    points and folds are all placed, or if a place or its name makes no sense. Source: ours.
    """
    calm = body.calm
    by_hand = placed_marks(calm, placed)
    trunk = survey(calm)
    busts = [by_hand.get(f"bust_point_{side}") for side in SIDES]
    folds = [by_hand.get(f"fold_{side}") for side in SIDES]
    if all(busts) and all(folds):
        low = min(mark.position[2] for mark in folds if mark)
        anchor, found = Anchor(low - 14.0, 0.0, 0.0, 0.0), [mark for mark in busts if mark]
    else:
        anchor = find_anchor(trunk)
        if anchor.kink < 8.0 or anchor.middle_kink > 0.5 * anchor.kink:
            raise _refusal("no fold lies under a left and a right breast")
        poles = find_poles(trunk, anchor)
        found = [by_hand or mark for by_hand, mark in zip(busts, _bust_points(calm, poles), strict=True)]
    for side, bust in zip(SIDES, found[:2], strict=True):
        found += _fold_and_lowest(calm, bust.position, anchor, side, by_hand.get(f"fold_{side}"))
    found = [by_hand.get(mark.name, mark) for mark in found]
    bust_level = 0.5 * (found[0].position[2] + found[1].position[2])
    underbust_level = min(mark.position[2] for mark in found[2:])
    points = {mark.name: mark for mark in found}
    # Here come the further landmarks of the trunk, each replaced by the placed one of its name.
    landmarks = Landmarks(MappingProxyType(points | by_hand), float(bust_level), float(underbust_level))
    if not (all(busts) and all(folds)):
        _check(calm, trunk, poles, landmarks)
    return landmarks


def _check(mesh: Mesh, trunk: Survey, poles: tuple[Pole, Pole], landmarks: Landmarks) -> None:
    """Raise LandmarkError where what was found cannot be a bust."""
    left, right = (landmarks.position(f"bust_point_{side}") for side in SIDES)
    under, bust = stable_level(mesh, landmarks.underbust_level), trunk_levels(mesh, landmarks.bust_level)[0]
    if under.tape == 0.0 or bust.tape == 0.0:
        raise _refusal("the trunk is missing there")
    across, middle = left - right, 0.5 * (left + right)
    wide, deep, _ = np.ptp(under.points, axis=0)
    creases = [landmarks.points[f"fold_{side}"].rule for side in SIDES]
    for wrong, why in (
        (under.longest_straight > 0.2 * under.tape, "the trunk is open, as if only a part of it was scanned"),
        (not 550.0 < under.tape < 1400.0, f"the girth under it would be {under.tape:.0f} mm"),
        (not 15.0 < bust.tape - under.tape < 420.0, "it would not be wider than the trunk under it"),
        (not 1.0 < wide / deep < 2.3, "the trunk is not as deep as a body"),
        (not 90.0 < across[0] < 380.0, f"its points would lie {across[0]:.0f} mm apart"),
        (abs(across[2]) > 45.0, "its points would lie at very different heights"),
        (abs(middle[0] - trunk.middle) > 30.0, "it would lie beside the middle of the body"),
        (min(pole.prominence for pole in poles) < 4.0, "nothing stands out of the chest"),
        (not any(pole.inside for pole in poles), "the chest comes to no point"),
        (not 12.0 < middle[2] - landmarks.underbust_level < 190.0, "no fold lies at a likely depth under it"),
        (creases == [NO_CREASE, NO_CREASE], "there is no crease under it"),
    ):
        if wrong:
            raise _refusal(why)


def _refusal(why: str) -> LandmarkError:
    return LandmarkError(
        f"No bust can be found: {why}.",
        "Open a scan of a whole upper body, or say which way is up and which is the front.",
    )


def _bust_points(mesh: Mesh, poles: tuple[Pole, Pole]) -> list[Landmark]:
    left, right = (breast_patch(mesh, pole.position) for pole in poles)
    nipples = find_nipples(left, right)
    marks = []
    for side, patch, own, other, home in zip(
        SIDES, (left, right), nipples, nipples[::-1], (right, left), strict=True
    ):
        if own is not None and own.sure:
            place, confidence, rule = own.position, _nipple_confidence(own), NIPPLE
        elif other is not None and other.sure:
            shift = 0.5 * (other.position - home.centre) * (-1.0, 1.0, 1.0)
            place, confidence, rule = patch.nearest(patch.centre + shift), 0.3, MIRRORED
        else:
            place, confidence, rule = patch.centre, 0.3, PROMINENT
        marks.append(Landmark(f"bust_point_{side}", place, confidence, rule))
    return marks


def _nipple_confidence(nipple: Nipple) -> float:
    clear = 0.6 * min(nipple.clarity / 6.0, 1.0) + 0.4 * float(np.clip((nipple.ratio - 0.9) / 1.2, 0.0, 1.0))
    return clear * float(np.exp(-max(nipple.offset - 8.0, 0.0) / 15.0))


def _fold_and_lowest(
    mesh: Mesh, bust: Points, anchor: Anchor, side: str, placed: Landmark | None
) -> list[Landmark]:
    """Find the fold on the profiles through and beside the bust point, and the lowest point above it."""
    x = mesh.vertices[:, 0][mesh.faces.T] - bust[0]
    crossed = (x.min(axis=0) <= max(OFFSETS)) & (x.max(axis=0) >= min(OFFSETS))
    strip = Mesh(mesh.vertices, mesh.faces[crossed])
    walks = [_profile(strip, bust, offset, anchor.z - 75.0) for offset in OFFSETS]
    curves = [_smoothed(curve) for curve, _ in walks]
    count = min(len(curve) for curve in curves)
    bends = np.array([_concavity(curve)[:count] for curve in curves])
    own, mean = curves[len(curves) // 2][:count], bends.mean(axis=0)
    high = np.abs(own[:, 2] - anchor.z - 14.0)
    arc = np.arange(count)
    if placed is not None:
        end = int(np.argmin(((own - placed.position) ** 2).sum(axis=1)))
        return [placed, Landmark(f"lowest_{side}", own[: end + 1][np.argmin(own[: end + 1, 2])], 1.0, LOWEST)]
    allowed = (arc > 22) & (arc < count - 12) & (high < 60.0)
    if not allowed.any():
        raise _refusal(f"the surface below the {side} breast is missing")
    value = np.where(allowed, gaussian_filter1d(mean, 6.0) - 0.00035 * np.maximum(high - 22.0, 0.0), -np.inf)
    best = int(np.argmax(value))
    close = allowed & (np.abs(arc - best) <= 10)
    at = int(np.argmax(np.where(close, gaussian_filter1d(mean, 3.0), -np.inf)))
    runner = float(np.max(value, where=np.abs(arc - best) > 18, initial=0.0))
    places = [
        curve[np.argmax(np.where(allowed, bend, -np.inf)), 2]
        for curve, bend in zip(curves, bends, strict=True)
    ]
    slant = np.polyval(np.polyfit(OFFSETS, places, 1), OFFSETS)
    spread = float(np.median(np.abs(places - slant)))
    gap = max(gap for _, gap in walks)
    confidence = min(mean[at] / 0.035, 1.0) * (0.3 + 0.7 * np.clip((value[best] - runner) / 0.02, 0.0, 1.0))
    confidence *= np.exp(-spread / 5.0 - max(gap - 3.0, 0.0) / 12.0)
    lowest = own[: at + 1][np.argmin(own[: at + 1, 2])]
    return [
        Landmark(
            f"fold_{side}",
            own[at],
            confidence,
            CREASE if mean[at] > 0.006 else NO_CREASE,
        ),
        Landmark(f"lowest_{side}", lowest, confidence, LOWEST),
    ]


def _profile(mesh: Mesh, bust: Points, offset: float, bottom: float) -> tuple[Points, float]:
    """Follow the surface from beside the bust point down to the height ``bottom`` [mm], across holes.

    Returns the curve, shape (k, 3) [mm], and the longest hole crossed [mm].
    """
    pieces = chains(cut(mesh, bust + np.array([offset, 0.0, 0.0]), (1.0, 0.0, 0.0)))
    if not pieces:
        raise _refusal("the breast has no profile")
    distances = [((curve - bust) ** 2).sum(axis=1) for curve, _ in pieces]
    nearest = int(np.argmin([distance.min() for distance in distances]))
    curve = _downward(*pieces.pop(nearest), int(np.argmin(distances[nearest])))
    longest = 0.0
    ends = [piece[::turn] for piece, closed in pieces if not closed for turn in (1, -1)]
    while curve[-1, 2] > bottom and ends:
        jumps = [
            float(np.linalg.norm(end[0] - curve[-1])) if end[0, 2] < curve[-1, 2] + 25.0 else np.inf
            for end in ends
        ]
        nearest = int(np.argmin(jumps))
        if jumps[nearest] > 45.0:
            break
        longest = max(longest, jumps[nearest])
        curve = np.concatenate([curve, ends[nearest]])
        del ends[nearest - nearest % 2 : nearest - nearest % 2 + 2]
    below = np.flatnonzero(curve[:, 2] < bottom)
    return (curve[: below[0] + 1] if len(below) else curve), longest


def _downward(curve: Points, closed: bool, start: int) -> Points:
    """Return ``curve`` from ``start`` on in the direction that leads down over the first 18 mm."""
    if closed:
        turned = np.roll(curve[:-1], -start, axis=0)
        ways = [turned, np.roll(turned[::-1], 1, axis=0)]
    else:
        ways = [curve[start:], curve[start::-1]]
    ways = [way for way in ways if len(way) > 1]
    return min(ways, key=lambda way: float(np.interp(18.0, arc_length(way), way[:, 2])))


def _smoothed(curve: Points) -> Points:
    """Return ``curve`` smoothed by 4 mm, at a step of 1 mm of its smoothed length."""
    return resample(gaussian_filter1d(resample(curve, 1.0), 4.0, axis=0, mode="nearest"), 1.0)


def _concavity(curve: Points) -> Floats:
    """Return the curvature of a profile walked downwards, positive where it is hollow, shape (k,) [1/mm]."""
    y, z = curve[:, 1], curve[:, 2]
    dy, dz = np.gradient(y), np.gradient(z)
    bend = dz * np.gradient(dy) - dy * np.gradient(dz)
    return np.asarray(bend / np.maximum(dy**2 + dz**2, 1e-9) ** 1.5)
