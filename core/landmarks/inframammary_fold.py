"""The fold under one breast: the crease that runs across its upright profiles."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.mesh import Flags, Floats, Indices, Points
from core.landmarks.breast_profiles import OWN, Profile

SLACK, PULL = 3.0, 0.002
"""From profile to profile the fold may move by ``SLACK`` [mm]; more costs ``PULL`` of curvature a mm."""

FREE, STRAY = 22.0, 0.00035
"""So far off the height where it is looked for [mm] a crease is as good; each mm more costs curvature."""

REACH = 60.0
"""It is looked for so far above and below that height [mm]."""

TOP, END = 22, 12
"""So near to the bust point and to the lower end of a profile [mm] it is not looked for."""

SAME, OWN_BEND = 18, 12
"""So near to the run another one is the same [mm], and so near to the fold another bend of its profile."""

EVEN, ASTRAY = 2.0, 0.01
"""A fold may leave the even course of its run by this [mm]; each mm more costs so much curvature [1/mm]."""

HIDDEN, BLURRED = 1.0, 8.0
"""In a hole the estimated course counts by this share [1], smoothed over this length [mm]."""


@dataclass(frozen=True, eq=False)
class Trace:
    """The crease across the profiles: ``curve`` (p, 3) [mm], whether each was ``seen``, its ``depth`` [1/mm].

    ``depth`` is the mean hollowness near the bust point, ``lead`` that of the run over the next best one
    [1/mm], ``rough`` how far it strays from a smooth curve [mm]; ``own`` is the row of the bust point's
    profile; ``rival`` is how many times as hollow as the crease another place of that profile is.
    """

    curve: Points
    seen: Flags
    depth: float
    lead: float
    rough: float
    own: int
    rival: float = 0.0


def trace(bundle: list[Profile], height: float) -> Trace | None:
    """Trace the crease that runs across the profiles ``bundle`` near ``height`` [mm]; None if none is seen.

    It is the run, from profile to profile, that gathers most curvature and jumps least: dynamic programming.
    What one profile does not show its neighbours do. Source: ours.
    """
    size = max(len(profile.points) for profile in bundle)
    points = np.full((len(bundle), size, 3), np.nan)
    value = np.full((len(bundle), size), -np.inf)
    for k, profile in enumerate(bundle):
        n = len(profile.points)
        points[k, :n] = profile.points
        high = np.abs(profile.points[:, 2] - height)
        shown, hidden = (gaussian_filter1d(profile.bend, width) for width in (4.0, BLURRED))
        worth = np.where(profile.seen, shown, HIDDEN * hidden) - STRAY * np.maximum(high - FREE, 0.0)
        value[k, :n] = np.where(_allowed(profile, height), worth, -np.inf)
    usable = np.isfinite(value).any(axis=1)
    if not usable[OWN]:
        return None
    low, high_end = OWN, OWN
    while low > 0 and usable[low - 1]:
        low -= 1
    while high_end < len(bundle) - 1 and usable[high_end + 1]:
        high_end += 1
    rows = np.arange(low, high_end + 1)
    path, best = _best_run(points[rows], value[rows])
    taken = value[rows].copy()
    taken[np.abs(np.arange(size)[None] - path[:, None]) <= SAME] = -np.inf
    other = _best_run(points[rows], taken)[1] if np.isfinite(taken).any(axis=1).all() else 0.0
    found = _trace(bundle, rows, path, (best - max(other, 0.0)) / len(rows))
    return replace(found, rival=_rival(bundle[OWN], found.curve[found.own], height))


def _allowed(profile: Profile, height: float) -> Flags:
    """Return which points of ``profile`` may be the fold: below the bust point and near ``height`` [mm]."""
    arc, n = np.arange(len(profile.points)), len(profile.points)
    return np.asarray((arc > TOP) & (arc < n - END) & (np.abs(profile.points[:, 2] - height) < REACH))


def _rival(profile: Profile, fold: Points, height: float) -> float:
    """Return how many times as hollow as the ``fold`` the hollowest other place of the profile is."""
    bend = gaussian_filter1d(profile.bend, 4.0)
    at = int(np.argmin(((profile.points - fold) ** 2).sum(axis=1)))
    crease = float(bend[max(at - 4, 0) : at + 5].max())
    summit = np.zeros(len(bend), dtype=bool)
    summit[1:-1] = (bend[1:-1] >= bend[:-2]) & (bend[1:-1] >= bend[2:])
    other = summit & profile.seen & _allowed(profile, height)
    other &= (np.abs(np.arange(len(bend)) - at) > OWN_BEND) & (np.abs(profile.points[:, 2] - fold[2]) > 4.0)
    return float(bend[other].max(initial=0.0)) / max(crease, 1e-3)


def _best_run(points: Points, value: Floats) -> tuple[Indices, float]:
    """Return the best place on each row, shape (r,), and what the run is worth."""
    open_to = [np.flatnonzero(np.isfinite(row)) for row in value]
    total, links = value[0, open_to[0]], []
    for k in range(1, len(value)):
        away = points[k, open_to[k], 1:][:, None] - points[k - 1, open_to[k - 1], 1:][None]
        step = np.hypot(away[..., 0], away[..., 1])
        reached = total[None] - PULL * np.maximum(step - SLACK, 0.0)
        links.append(np.argmax(reached, axis=1))
        total = value[k, open_to[k]] + reached.max(axis=1)
    run = [int(np.argmax(total))]
    for link in reversed(links):
        run.append(int(link[run[-1]]))
    path = [places[at] for places, at in zip(open_to, run[::-1], strict=True)]
    return np.array(path), float(total.max())


def _trace(bundle: list[Profile], rows: Indices, path: Indices, lead: float) -> Trace:
    """Sharpen the run by the bends of all profiles near the bust point, laid over each other along it."""
    own = int(np.flatnonzero(rows == OWN)[0])
    seen = np.array([bundle[row].seen[at] for row, at in zip(rows, path, strict=True)])
    curve = np.array([bundle[row].points[at] for row, at in zip(rows, path, strict=True)])
    even = _evened(curve, seen)
    close = seen & (np.abs(np.arange(len(rows)) - own) <= 6)
    rough = float(np.mean(np.abs(even - curve[:, 2])[close])) if close.any() else 0.0
    near = [k for k in range(len(rows)) if abs(k - own) <= 2 and seen[k]]
    depth = float(np.mean([bundle[rows[k]].bend[path[k]] for k in near])) if near else 0.0
    if seen[own]:
        profile = bundle[OWN]
        shift = np.arange(-8, 9)
        bends = [
            np.interp(path[k] + shift, np.arange(len(bundle[rows[k]].bend)), bundle[rows[k]].bend)
            for k in near
        ]
        sharp = gaussian_filter1d(0.5 * np.mean(bends, axis=0) + 0.5 * bends[near.index(own)], 2.0)
        places = np.clip(path[own] + shift, 0, len(profile.points) - 1)
        # Where noise makes the run stray, the fold keeps near its even course.
        sharp -= ASTRAY * np.maximum(np.abs(profile.points[places, 2] - even[own]) - EVEN, 0.0)
        curve[own] = profile.points[places[np.argmax(sharp)]]
    return Trace(curve, seen, depth, lead, rough, own)


def _evened(curve: Points, seen: Flags) -> Floats:
    """Return the heights of a smooth course through the seen points, shape (p,) [mm]."""
    if seen.sum() < 6:
        return np.asarray(curve[:, 2])
    x = curve[:, 0] - curve[:, 0].mean()
    weight = np.ones(int(seen.sum()))
    for _ in range(3):
        fit = np.polyfit(x[seen], curve[seen, 2], 3, w=weight)
        weight = 1.0 / np.maximum(np.abs(np.polyval(fit, x[seen]) - curve[seen, 2]), 1.0)
    return np.asarray(np.polyval(fit, x))
