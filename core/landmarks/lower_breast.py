"""Folds and lowest points of both breasts, and how sure they are: what a hole hides is estimated and said."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.geometry.mesh import Mesh, Points
from core.geometry.mirror_plane import MIRROR
from core.landmarks.breast_profiles import OWN, Profile, profiles
from core.landmarks.inframammary_fold import Trace, trace
from core.landmarks.manual import reconcile_with_detected
from core.landmarks.types import SIDES, Landmark
from core.messages import Message

HOLLOW = 0.006
"""A crease is hollower than this [1/mm]."""

ABOVE = 14.0
"""Folds lie about so far above the level where the body comes forward [mm]."""

BELOW, BEYOND = 75.0, 20.0
"""Profiles go down so far below that level [mm], and so far below a fold that was placed by hand."""

CONTRADICTED = 8.0
"""Beside a hole a fold so far off the height of the other breast's [mm] is taken for the rim of the hole."""

UNSEEN_WEIGHT = 0.4
"""What a hidden place of the crease counts, beside 1 of one that is seen [1]."""

AROUND, LEVEL = 12.0, 1.0
"""Hidden places count less, the further [mm] beside the bust point they are; that the crease runs level
counts as much as so many places that are seen [1]."""

NEAR = 42.0
"""Behind a hole the crease is taken from what is seen of it so far to both sides [mm]."""

CREASE = Message("Sharpest crease below the breast on the vertical profile through the bust point.")
NO_CREASE = Message("Deepest concavity below the breast: the vertical profile has no crease.")
ESTIMATED = Message("Estimated from the surrounding skin: the scan has a hole there.")
MIRRORED = Message("Estimated from the inframammary fold of the other breast: the scan has a hole there.")
GUESSED = Message("Estimated from the height of the hole: no inframammary fold visible in the scan.")
UNSEEN = Message(
    "No inframammary fold detected: estimated slightly above the point where the body begins to slope "
    "forward."
)
HIDDEN = (ESTIMATED, MIRRORED, GUESSED)
"""The rules of folds that a hole of the scan hides."""

LOWEST = Message("Lowest point of the breast between the bust point and the inframammary fold.")

MISSING = 0.3
"""The most confidence [1] in a lowest point over a fold that shows in no crease, or hangs over."""

ASTRAY = 17.0
"""A bust point without any certainty may lie so far to the side [mm], and the profile through it with it."""

ROUGH = 8.0
"""A crease that strays so far from a smooth curve [mm] divides the confidence by e."""

CLIMB, CLIMBS = 4.0, 13.0
"""Over that way the crease may climb by ``CLIMB`` [mm]; each ``CLIMBS`` more divide the confidence by e."""

RIVAL = 1.1, 0.4
"""Another place may be so many times as hollow as the fold; each second part more divides by e."""

OVERHANG = 18.0
"""Behind a breast whose fold lies above its bust point the hollow is wide: so much [mm] divides it by e."""

UNLIKE = 6.0, 8.0
"""Sides may differ by the first [mm], as bodies do; each second [mm] more divides the confidence by e."""


@dataclass(frozen=True, eq=False)
class LowerBreast:
    """What was found under one breast; ``fold`` is None where its crease does not show.

    ``confidence`` is the confidence (0..1) in what the profile shows, whoever placed the fold.
    """

    bundle: Sequence[Profile]
    trace: Trace | None
    fold: Landmark | None
    confidence: float


def folds_and_lowest(
    mesh: Mesh, busts: Sequence[Landmark], level: float, placed: Mapping[str, Landmark]
) -> list[Landmark]:
    """Return folds and lowest points below the bust points ``busts``, left and right.

    ``level`` is where the body comes forward under both [mm]; folds in ``placed`` stay where they are.
    """
    sides = [_under(mesh, bust, level, side, placed) for side, bust in zip(SIDES, busts, strict=True)]
    places, folds = [bust.position for bust in busts], []
    for k, side in enumerate(SIDES):
        own, other, shift = sides[k], sides[1 - k], (places[k], places[1 - k])
        fold = own.fold if own.fold and not _doubtful(own, other, shift) else None
        folds.append(fold or _estimated(own, other, side, shift, level))
    apart = _apart(folds, places)
    folds = [_less_sure(fold, other, apart) for fold, other in zip(folds, folds[::-1], strict=True)]
    lowest = [_lowest(sides[k], sides[1 - k], folds[k], SIDES[k], (places[k], places[1 - k])) for k in (0, 1)]
    return [mark for pair in zip(folds, lowest, strict=True) for mark in pair]


def _apart(folds: Sequence[Landmark], busts: Sequence[Points]) -> float:
    """Return how far apart the folds lie [mm]: in height, or in depth under the bust points if less."""
    apart = float(folds[0].position[2] - folds[1].position[2])
    return min(abs(apart), abs(apart - float(busts[0][2] - busts[1][2])))


def _less_sure(fold: Landmark, other: Landmark, apart: float) -> Landmark:
    """Return ``fold`` with less confidence where the ``other`` is sure and lies ``apart`` from it [mm]."""
    doubt = min(2.0 * other.confidence, 1.0) * max(apart - UNLIKE[0], 0.0) / UNLIKE[1]
    if fold.by_hand or other.by_hand:
        return fold
    return replace(fold, confidence=fold.confidence * float(np.exp(-doubt)))


def _under(
    mesh: Mesh, bust: Landmark, level: float, side: str, placed: Mapping[str, Landmark]
) -> LowerBreast:
    name = f"fold_{side}"
    bottom = level - BELOW
    if name in placed:
        bottom = min(bottom, placed[name].position[2] - BEYOND)
    bundle = profiles(mesh, bust.position, bottom)
    crease = trace(bundle, level + ABOVE)
    found = _fold(name, bust, crease, torn=not bundle[OWN].whole)
    sure = found.confidence if found else 0.0
    if name in placed:
        return LowerBreast(
            bundle, None, reconcile_with_detected(placed[name], found) if found else placed[name], sure
        )
    return LowerBreast(bundle, crease, found, sure)


def _fold(name: str, bust: Landmark, crease: Trace | None, torn: bool) -> Landmark | None:
    """Return the fold that a crease shows below a bust point; a profile that is ``torn`` shows less."""
    if crease is None or not crease.seen[crease.own] or (torn and crease.depth < HOLLOW):
        return None
    rule = CREASE if crease.depth > HOLLOW else NO_CREASE
    confidence = _confidence(crease, bust) * (0.5 if torn else 1.0)
    return Landmark(name, crease.curve[crease.own], confidence, rule, crease.curve)


def _confidence(crease: Trace, bust: Landmark) -> float:
    """Return how sure (0..1) the fold is: a deep, smooth and level crease without a rival.

    A crease of 0.035 /mm that leads by 0.012 /mm is as clear as they come: our judgement, as the weights are.
    The less sure the bust point, the further to the side the crease must keep its height.
    """
    confidence = min(crease.depth / 0.035, 1.0) * (0.3 + 0.7 * np.clip(crease.lead / 0.012, 0.0, 1.0))
    x, z = crease.curve[:, 0], crease.curve[:, 2]
    own, astray = crease.curve[crease.own], ASTRAY * (1.0 - bust.confidence)
    climb = np.abs(np.interp(own[0] + astray * np.linspace(-1.0, 1.0, 9), x, z) - own[2]).max()
    over = max(float(own[2] - bust.position[2]), 0.0)
    doubt = crease.rough / ROUGH + max(climb - CLIMB, 0.0) / CLIMBS + over / OVERHANG
    doubt += max(crease.rival - RIVAL[0], 0.0) / RIVAL[1]
    return float(confidence * np.exp(-doubt))


def _estimated(
    own: LowerBreast, other: LowerBreast, side: str, busts: tuple[Points, Points], level: float
) -> Landmark:
    """Return the fold that a hole hides: as on the other side, else as its visible parts or the hole lie."""
    name = f"fold_{side}"
    mirrored = _mirrored(other, busts)
    if mirrored is not None:
        return Landmark(name, mirrored, 0.3, MIRRORED, mirrored[None])
    beside = _beside(own.trace, busts[0])
    if own.trace and beside is not None:
        return Landmark(name, beside, 0.2, ESTIMATED, own.trace.curve)
    points, hidden = own.bundle[OWN].points, np.flatnonzero(~own.bundle[OWN].seen)
    if len(points) > 1 and len(hidden) > 3:
        return Landmark(name, 0.5 * (points[hidden[0]] + points[hidden[-1]]), 0.1, GUESSED, points)
    z = level + ABOVE
    y = float(np.interp(z, points[::-1, 2], points[::-1, 1]))
    place = np.array([busts[0][0], y, z])
    return Landmark(name, place, 0.05, UNSEEN, place[None])


def _doubtful(own: LowerBreast, other: LowerBreast, busts: tuple[Points, Points]) -> bool:
    """Return whether a hole makes one side unlike the other, so that the whole one is to be trusted."""
    if own.fold is None or own.trace is None or own.bundle[OWN].whole or not other.bundle[OWN].whole:
        return False
    mirrored = _mirrored(other, busts)
    return mirrored is not None and abs(float(mirrored[2] - own.fold.position[2])) > CONTRADICTED


def _mirrored(other: LowerBreast, busts: tuple[Points, Points]) -> Points | None:
    """Return the fold of the other breast below the own bust point, shape (3,) [mm]; None if it is unsure."""
    if other.fold is None or other.fold.rule == NO_CREASE:
        return None
    return np.asarray(busts[0] + MIRROR * (other.fold.position - busts[1]))


def _beside(crease: Trace | None, bust: Points) -> Points | None:
    """Return the fold below ``bust`` from the visible parts of the crease on both sides of it, (3,) [mm]."""
    if crease is None or len(crease.curve) < 6:
        return None
    x, y, z = (crease.curve - (bust[0], 0.0, 0.0)).T
    weight = np.where(crease.seen, np.abs(x) < NEAR, UNSEEN_WEIGHT * np.exp(-0.5 * (x / AROUND) ** 2))
    terms = np.stack([np.ones(len(x)), x / NEAR, (x / NEAR) ** 2], axis=1)
    hold = np.diag([0.0, LEVEL, LEVEL])  # a few places do not show its slope and bend
    share = np.linalg.solve((terms * weight[:, None]).T @ terms + hold, (terms * weight[:, None]).T)
    return np.array([bust[0], *(float(share[0] @ each) for each in (y, z))])


def _lowest(
    own: LowerBreast, other: LowerBreast, fold: Landmark, side: str, busts: tuple[Points, Points]
) -> Landmark:
    """Return the lowest point of the profile between bust point and fold."""
    profile = own.bundle[OWN]
    end = int(np.argmin(((profile.points - fold.position) ** 2).sum(axis=1)))
    curve = np.concatenate([profile.points[: end + 1][profile.seen[: end + 1]], fold.position[None]])
    if fold.rule == MIRRORED and other.fold is not None:
        points = other.bundle[OWN].points
        last = int(np.argmin(((points - other.fold.position) ** 2).sum(axis=1)))
        lowest = points[np.argmin(points[: last + 1, 2])]
        curve = np.concatenate([curve, [busts[0] + MIRROR * (lowest - busts[1])]])
    over = fold.position[2] > busts[0][2]  # which is right only where the breast hangs over its fold
    # That a hand has placed the fold says nothing about the profile above it.
    seen = max(own.confidence, MISSING) if fold.by_hand else fold.confidence
    sure = min(seen, MISSING) if over else seen
    return Landmark(f"lowest_{side}", curve[np.argmin(curve[:, 2])], sure, LOWEST, curve)
