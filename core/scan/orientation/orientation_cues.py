"""Cues that tell which way up a trunk stands and where its front is: a small table, each with its weight."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import convolve1d, maximum_filter1d

from core.geometry.mesh import Floats
from core.messages import Message
from core.scan.orientation.silhouette import Silhouette

USUAL_LEAN = 0.02
"""The middle of a trunk that stands leans back by this [1]."""

SHORTEST = 250.0
"""A scan of the upper body is taller than this [mm of a typical trunk]; one that lies on its back is not."""

CROTCH = 75.0
"""So near over the legs [mm of a typical trunk] the front sinks in between them as the back does."""

MOST = 100.0
"""Breasts stand out over their folds by less than this [mm]; a chin over a tilted chest does by more."""


HANGING = 10.0
"""Breasts that hang to the hips stand out by more than this further over them [mm]; buttocks do not."""


@dataclass(frozen=True)
class Fold:
    """The hollow under a bust at both sides, the one in between, and its place in the height [mm, mm, 1]."""

    strength: float = 0.0
    middle: float = 0.0
    height: float = 0.0


@dataclass(frozen=True, eq=False)
class Side:
    """What stands out of one side of a trunk, front or back, from hips to neck; each shape (k,) [mm].

    ``middle`` is the profile along the middle line, ``lobes`` how far both halves stand out over it, NaN near
    the legs and where it is unknown.
    """

    middle: Floats
    lobes: Floats

    @property
    def hollow(self) -> Floats:
        """Return how deep the middle line lies under a string stretched over it, shape (k,) [mm]."""
        top = [0]
        for k in range(1, len(self.middle)):
            while len(top) > 1 and self._bends_in(top[-2], top[-1], k):
                top.pop()
            top.append(k)
        return np.interp(np.arange(len(self.middle)), top, self.middle[top]) - self.middle

    def _bends_in(self, a: int, b: int, c: int) -> bool:
        y = self.middle
        return bool((y[b] - y[a]) * (c - b) <= (y[c] - y[b]) * (b - a))


@dataclass(frozen=True, eq=False)
class TorsoFeatures:
    """A trunk as it looks if z is up and its -y is front."""

    trunk: Silhouette
    fold: Fold
    front: Side
    back: Side

    @property
    def lean(self) -> float:
        """Return how far the middle of the trunk leans backwards on its way up [1], over what is usual."""
        middle = 0.5 * (self.back.middle - self.front.middle)
        rows = np.arange(len(middle)) * self.trunk.cell * self.trunk.mm
        return float(np.polyfit(rows, middle, 1)[0]) - USUAL_LEAN if len(middle) > 4 else 0.0


@dataclass(frozen=True)
class Cue:
    """One thing that tells up or front: ``evaluate`` gives -1 (against) .. 1 (for); ``words`` name it."""

    words: Message
    weight: float
    evaluate: Callable[[TorsoFeatures], float]


def extract_features(trunk: Silhouette) -> TorsoFeatures:
    """Extract features of ``trunk`` from the front and from the back."""
    rows = _torso(trunk)
    return TorsoFeatures(
        trunk, find_fold(trunk), _side(trunk, trunk.front, rows), _side(trunk, trunk.back, rows)
    )


def _torso(trunk: Silhouette) -> slice:
    """Return the levels from the hips to where the neck begins: one run, not narrower than half the trunk."""
    wide = np.nan_to_num(trunk.width) > 0.55 * trunk.half_width
    proper = np.flatnonzero(trunk.proper)
    middle = int(proper[len(proper) // 2])
    below, above = np.flatnonzero(~wide[:middle]), np.flatnonzero(~wide[middle:])
    first = int(below[-1]) + 1 if len(below) else 0
    return slice(first, middle + int(above[0]) if len(above) else len(wide))


def _side(trunk: Silhouette, reach: Floats, rows: slice) -> Side:
    reach, across = reach[rows] * trunk.mm, trunk.across
    left = np.arange(len(across)) < len(across) // 2
    lobe = (across > 0.25) & (across < 0.8)
    half = [_largest(reach[:, lobe & side]) for side in (left, ~left)]
    lobes = np.minimum(*half) - _mean(reach[:, across < 0.12])
    if rows.start and trunk.legs[rows.start - 1]:
        lobes[: round(CROTCH / (trunk.cell * trunk.mm))] = np.nan
    return Side(_filled(_mean(reach[:, across < 0.25])), lobes)


def _largest(values: Floats) -> Floats:
    best = np.where(np.isfinite(values), values, -np.inf).max(axis=1, initial=-np.inf)
    return np.where(np.isfinite(best), best, np.nan)


def _mean(values: Floats) -> Floats:
    known = np.isfinite(values)
    count = known.sum(axis=1)
    return np.where(count > 0, np.where(known, values, 0.0).sum(axis=1) / np.maximum(count, 1), np.nan)


def _filled(profile: Floats) -> Floats:
    known = np.flatnonzero(np.isfinite(profile))
    if len(known) == 0:
        return np.zeros(len(profile))
    return np.interp(np.arange(len(profile)), known, profile[known])


def find_fold(trunk: Silhouette) -> Fold:
    """Find the level where both sides of the front stand out above a hollow and the middle does not."""
    cell = trunk.cell * trunk.mm
    kink = _kinks(trunk.front * trunk.mm, cell)
    left = np.arange(kink.shape[1]) < kink.shape[1] // 2
    lobe = (trunk.across > 0.28) & (trunk.across < 0.85)
    tall = max(1, 2 * round(12.0 / cell) + 1)
    halves = [
        maximum_filter1d(kink[:, lobe & side].max(axis=1, initial=-np.inf), tall) for side in (left, ~left)
    ]
    both = np.minimum(*halves)
    middle = kink[:, trunk.across < 0.12].max(axis=1, initial=-np.inf)
    middle = np.where(np.isfinite(middle), middle, 0.0)
    height = trunk.height
    allowed = trunk.proper & (height > 30.0) & (height < height[-1] - 60.0) & np.isfinite(both)
    if not allowed.any():
        return Fold()
    at = int(np.argmax(np.where(allowed, both - 0.8 * np.clip(middle, 0.0, 40.0), -np.inf)))
    return Fold(float(both[at]), float(middle[at]), float(height[at] / height[-1]))


def _kinks(reach: Floats, cell: float) -> Floats:
    """Return how far the front stands out 30 mm higher, less how far 30 mm lower [mm]; -inf if unknown.

    ``reach`` and its ``cell`` are in mm here.
    """
    above, below = (_shifted(reach, rows / cell) - reach for rows in (30.0, -30.0))
    kink = above - np.abs(below)  # nothing on a straight slope, however it leans
    run = max(1, round(20.0 / cell))
    kink = convolve1d(kink, np.full(run, 1.0 / run), axis=1, mode="constant", cval=np.nan)
    return np.where(np.isfinite(kink), kink, -np.inf)


def _shifted(values: Floats, rows: float) -> Floats:
    """Return for each row what stands ``rows`` higher, between rows in proportion; NaN past the ends."""
    whole = int(np.floor(rows))
    padded = np.pad(values, ((abs(whole) + 1, abs(whole) + 1), (0, 0)), constant_values=np.nan)
    start = abs(whole) + 1 + whole
    lower, upper = (padded[start + k : start + k + len(values)] for k in (0, 1))
    return np.asarray(lower + (rows - whole) * (upper - lower))


def _bust(seen: TorsoFeatures) -> float:
    fold = seen.fold
    strength = (
        fold.strength / 10.0 if fold.strength < 20.0 else 2.0 + (min(fold.strength, 60.0) - 20.0) / 40.0
    )
    strength -= 0.8 * float(np.clip(fold.middle / max(fold.strength, 5.0), 0.0, 1.0))
    strength -= min(max(fold.strength - MOST, 0.0) / 10.0, 2.0)
    return strength - 4.0 * max(0.0, 0.25 - fold.height) - 1.5 * (fold.middle < -90.0)


def _breasts(seen: TorsoFeatures) -> float:
    high = slice(int(0.35 * len(seen.front.lobes)), int(0.85 * len(seen.front.lobes)) + 1)
    front, back = (np.nanmax(np.nan_to_num(side.lobes[high], nan=-9.9)) for side in (seen.front, seen.back))
    return float(front - back) / 25.0


def _buttocks(seen: TorsoFeatures) -> float:
    return (_low_lobes(seen.back) - _low_lobes(seen.front)) / 10.0


def _low_lobes(side: Side) -> float:
    """Return how far both halves stand out at the hips [mm]; 0 if what hangs there begins higher."""
    known = np.flatnonzero(np.isfinite(side.lobes))
    lobes = np.nan_to_num(side.lobes[known[0] :]) if len(known) else np.zeros(2)
    low, waist = max(2, int(0.15 * len(lobes))), int(0.45 * len(lobes))
    here, over = float(lobes[:low].mean()), lobes[low:waist]
    hangs = len(over) and np.median(over) > max(here, 0.0) + HANGING
    return 0.0 if hangs else here


def _spine(seen: TorsoFeatures) -> float:
    middle = len(seen.back.middle) // 2
    back, front = seen.back.hollow, seen.front.hollow
    low = back[:middle].max(initial=0.0) - front[:middle].max(initial=0.0)
    high = back[middle:].max(initial=0.0) - front[middle:].max(initial=0.0)
    return float(np.clip(low, -30.0, 30.0) - 0.5 * np.clip(high, -30.0, 30.0)) / 30.0


def _shoulders(seen: TorsoFeatures) -> float:
    middle = 0.5 * (seen.back.middle - seen.front.middle)
    depth = max(float(np.median(seen.back.middle + seen.front.middle)), 1.0)
    top, rest = int(0.85 * len(middle)), int(0.7 * len(middle))
    return float(middle[top:].mean() - middle[: rest + 1].mean()) / depth / 0.2 if len(middle) > 4 else 0.0


def _legs(seen: TorsoFeatures) -> float:
    trunk = seen.trunk
    middle = np.median(np.flatnonzero(trunk.proper))
    below = np.sign(middle - np.flatnonzero(trunk.legs)).sum()
    return float(below) / (0.15 * len(trunk.z))


def _upright(seen: TorsoFeatures) -> float:
    return -min(max(0.0, abs(seen.lean - 0.06) - 0.17) / 0.35, 3.0)


def _taper(seen: TorsoFeatures) -> float:
    width = seen.trunk.width[~seen.trunk.slim]
    end = max(1, len(width) // 6)
    bottom, top = np.median(width[:end]), np.median(width[-end:])
    return float(np.log(max(bottom, 1e-9) / max(top, 1e-9)))


def _arms(seen: TorsoFeatures) -> float:
    trunk = seen.trunk
    merged, free = np.nan_to_num(trunk.width) > 1.3 * trunk.half_width, trunk.arms & trunk.proper
    return (
        float(np.sign(trunk.z[merged].mean() - trunk.z[free].mean())) if merged.any() and free.any() else 0.0
    )


CUES = (
    Cue(Message("the bust with the inframammary folds"), 1.0, _bust),
    Cue(Message("two breasts"), 0.6, _breasts),
    Cue(Message("the cleft of the buttocks"), 1.0, _buttocks),
    Cue(Message("the curve of the lower back"), 1.0, _spine),
    Cue(Message("shoulders closer to the back"), 0.5, _shoulders),
    Cue(Message("the tapered end"), 1.2, _taper),
    Cue(Message("the attachment of the arms"), 0.5, _arms),
    Cue(Message("the legs"), 0.6, _legs),
    Cue(Message("an upright trunk"), 1.5, _upright),
)
"""What tells up and front; weights are ours, from bodies deformed in many ways."""


def score(seen: TorsoFeatures) -> tuple[float, dict[Message, float]]:
    """Return how well this look is that of an upper body that stands, and what each cue adds to it [1]."""
    trunk = seen.trunk
    signals = {cue.words: cue.weight * _bounded(cue, seen) for cue in CUES}
    total = sum(signals.values()) + (0.5 if 1.05 < trunk.stoutness < 2.3 else -2.5)
    return total - 3.0 * float(np.clip((SHORTEST - trunk.height[-1]) / 60.0, 0.0, 1.0)), signals


def _bounded(cue: Cue, seen: TorsoFeatures) -> float:
    value = cue.evaluate(seen)
    return value if cue.evaluate in (_bust, _upright) else float(np.clip(value, -1.0, 1.0))
