"""The nipples: spots that stand out of both breasts at the same place, and how likely each of them is one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter

from core.geometry.mesh import Points
from core.geometry.mirror_plane import MIRROR, mirror
from core.landmarks.nipple import GRID, BreastPatch

NEAR = 40.0
"""A nipple is looked for so far from the pole [mm]."""

EVEN = 24.0
"""How rough a breast is, is measured so far round its pole [mm]."""

APART = 14.0
"""Spots lie further apart than this [mm]: a nearer one is the same."""

OUTSIDE, HIGHER, USUAL = 7.0, 1.5, 4.0
"""A nipple lies by the first outside of the foremost place, by the second above it, within the third [mm]."""

LEVEL, CELLS = 5.0, 8
"""Where the breast turns down by more than this [degrees], over so many cells, a spot is its lower edge."""

LEAST = 0.9
"""What stands out by less than this [mm] is too faint for a nipple, however round."""

UNLIKE, UNLIKELY = 6.0, 9.0
"""A pair may lie so unlike on their breasts [mm]; each ``UNLIKELY`` [mm] more makes it less likely."""

BORNE, ALONE = 1.0, 2.0
"""The odds of nipples are greater than the first, in the mean of both; than the second if only one shows."""


@dataclass(frozen=True, eq=False)
class Nipple:
    """A spot that stands out of the breast: its centre, shape (3,) [mm], and what tells that it is a nipple.

    ``from_pole`` leads to it from the pole and ``out`` from the place that reaches furthest forward, (3,)
    [mm]; ``relief`` is how far it stands out [mm], and ``clarity`` that over the roughness of the breast;
    ``roundness`` is 1 for a spot and 0 for an edge;
    ``aside`` is how far it lies from where nipples do [mm]; ``down`` how steeply the breast turns down there
    [degrees]. The weights in ``log_odds`` are a logistic regression over the spots of 200 made bodies.
    """

    position: Points
    from_pole: Points
    out: Points
    relief: float
    clarity: float
    roundness: float
    aside: float
    down: float

    @property
    def log_odds(self) -> float:
        """Return the logarithm of the odds that this is a nipple, by its looks and its place alone.

        Each trait counts within bounds beyond which more of it tells nothing.
        """
        looks = 0.63 * min(self.relief, 2.5) + 0.57 * min(self.clarity, 5.0) + 3.15 * self.roundness
        place = 0.262 * min(max(self.aside - USUAL, 0.0), 30.0)
        return looks - place - 0.038 * min(max(self.down - LEVEL, 0.0), 50.0) - 1.51

    def apart(self, other: Nipple, middle: float) -> float:
        """Return how far it lies from the mirror image of that of the other breast [mm].

        The less of two: pole laid over pole, as breasts differ, or at the ``middle`` of the body, x [mm].
        """
        across = self.position - mirror(other.position, middle)
        return float(min(np.linalg.norm(self.from_pole - MIRROR * other.from_pole), np.linalg.norm(across)))


def find_nipples(
    left: BreastPatch | None, right: BreastPatch | None, middle: float
) -> tuple[Nipple | None, Nipple | None]:
    """Return the nipples, which are likely alike on both sides; None where none shows, or there is no breast.

    ``middle`` is x of the middle of the body [mm]. Source: ours.
    """
    spots = [
        [spot for spot in relief_summits(patch) if spot.relief > LEAST] if patch else []
        for patch in (left, right)
    ]
    alone = ALONE if left and right else BORNE

    def worth(a: Nipple | None, b: Nipple | None) -> float:
        if a is None or b is None:
            only = a or b
            return only.log_odds - alone if only else 0.0
        return (
            a.log_odds
            + b.log_odds
            - 2.0 * BORNE
            - 0.5 * (max(a.apart(b, middle) - UNLIKE, 0.0) / UNLIKELY) ** 2
        )

    pairs = ((a, b) for a in (None, *spots[0]) for b in (None, *spots[1]))
    return max(pairs, key=lambda pair: worth(*pair))


def relief_summits(patch: BreastPatch) -> list[Nipple]:
    """Return the summits of the relief near the pole, the likeliest nipple first."""
    r = np.where(np.isnan(patch.relief), -np.inf, patch.relief)
    summits = (r == maximum_filter(r, 2 * round(APART / GRID) + 1)) & (patch.distance < NEAR) & (r > 0.0)
    near = r[(patch.distance < EVEN) & np.isfinite(r)]
    rough = 1.48 * float(np.median(np.abs(near - np.median(near)))) + 0.12 if len(near) else np.inf
    spots = []
    for row, column in np.argwhere(summits):
        top = float(r[row, column])
        place = _centre(patch, row, column)
        from_forward = place - patch.forward
        looks = patch.normal(row, column, CELLS)
        spots.append(
            Nipple(
                position=place,
                from_pole=place - patch.centre,
                out=from_forward,
                relief=top,
                clarity=top / rough,
                roundness=patch.roundness(row, column),
                aside=float(
                    np.hypot(patch.side * from_forward[0] - OUTSIDE, 1.5 * (from_forward[2] - HIGHER))
                ),
                down=-float(np.degrees(np.arcsin(np.clip(np.nan_to_num(looks[2]), -1.0, 1.0)))),
            )
        )
    return sorted(spots, key=lambda spot: spot.log_odds, reverse=True)


def _centre(patch: BreastPatch, row: int, column: int) -> Points:
    """Return the centre of the upper half of a summit, on the surface, shape (3,) [mm]."""
    rows, columns = np.indices(patch.relief.shape)
    close = np.hypot(rows - row, columns - column) * GRID <= 9.0
    weight = np.where(
        close, np.maximum(np.nan_to_num(patch.relief) - 0.5 * patch.relief[row, column], 0.0), 0.0
    )
    return np.asarray(np.average(patch.points[weight > 0.0], axis=0, weights=weight[weight > 0.0]))
