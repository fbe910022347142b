"""Figures and limits about one place, with the bends that were learnt on the way (ours).

An answer tells values and slopes, no second derivatives. How slopes changed from one answer to the next
tells these little by little, after Powell's symmetric form of Broyden's rule. Where a limit is bent, or what
is wished cannot be reached, steps that know of it come to the nearest in a few; others creep there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from core.geometry.mesh import Floats

STRICT = 10_000.0
"""A limit that is broken by a ten-thousandth counts as a figure 1 mm off."""

_LAZY = 1e-3  # of several ways that do the same, the shortest [mm / %]
_BENDS = 6  # straight ways that follow a bent one
_TIGHT = 6  # limits that each of them may come to look at
_DONE = 0.01  # a part of the way that is not worth another
_AS_TOLD, _MOSTLY, _HARDLY = 0.01, 0.5, 0.1  # how near, and what part, of what a step promised [1]


def updated_curvature(bends: Floats, step: Floats, turned: Floats) -> Floats:
    """Return ``bends`` (r, p, p) that tell how slopes ``turned`` (r, p) on a ``step`` (p,).

    They stay symmetric, and else as near to what they were as that allows.
    """
    way = step / (step @ step)
    lack = turned - bends @ step
    both = lack[:, :, None] * way
    return np.asarray(
        bends + both + both.transpose(0, 2, 1) - (lack @ way)[:, None, None] * np.outer(step, way)
    )


@dataclass(frozen=True, eq=False)
class QuadraticModel:
    """What figures lack [mm] and the room to limits [1], in ``rows`` (r,), as they are after a step.

    The first ``figures`` rows are to come near to nothing, the others may not be negative. ``slopes`` (r, p)
    are those by the lengths [1 / %], ``bends`` (r, p, p) what these change by.
    """

    rows: Floats
    slopes: Floats
    bends: Floats
    figures: int

    def at_step(self, step: Floats) -> tuple[Floats, Floats]:
        """Return rows and slopes after a ``step`` (p,) [%]."""
        turned = self.bends @ step
        return self.rows + (self.slopes + 0.5 * turned) @ step, self.slopes + turned

    def violation(self, step: Floats) -> float:
        """Return what is amiss after a ``step`` (p,) [%]: see ``violation``."""
        return violation(self.at_step(step)[0], self.figures)

    def minimize(self, low: Floats, high: Floats) -> tuple[Floats, float]:
        """Return the step between ``low`` and ``high`` (p,) [%] that leaves least amiss, and how much.

        It is looked for along straight ways, each with what the bends do to it as a stiffness: that of
        figures that stay off, and of limits by how hard they were leant on.
        """
        count, limits = len(low), len(self.rows) - self.figures
        leant, looked_at = np.zeros(limits), np.zeros(limits, dtype=bool)
        step = best = np.zeros(count)
        left = self.violation(step)
        for _ in range(_BENDS):
            rows, slopes = self.at_step(step)
            looked_at |= self._within_reach(rows, slopes, low - step, high - step)
            chosen = np.append(np.ones(self.figures, dtype=bool), looked_at)
            weights = np.concatenate([rows[: self.figures], leant])[chosen]
            stiff = _root(np.tensordot(weights, self.bends[chosen], 1))
            way, leant[looked_at] = self._straight(rows[chosen], slopes[chosen], stiff, step, low, high)
            step = np.clip(step + way, low, high)
            if (after := self.violation(step)) < left:
                best, left = step, after
            if np.abs(way).max() < _DONE * np.abs(step).max():
                break
        return best, left

    def _within_reach(self, rows: Floats, slopes: Floats, low: Floats, high: Floats) -> Floats:
        """Return which limits a straight way may come to, of those with the least room."""
        room, by_room = rows[self.figures :], slopes[self.figures :]
        least = room + np.minimum(by_room * low, by_room * high).sum(axis=1)
        first = np.argsort(room)[:_TIGHT]
        within = np.zeros(len(room), dtype=bool)
        within[first[least[first] < 0.0]] = True
        return within

    def _straight(
        self, rows: Floats, slopes: Floats, stiff: Floats, step: Floats, low: Floats, high: Floats
    ) -> tuple[Floats, Floats]:
        """Return the straight way on from ``step``, and how hard it leans on each limit.

        Room that is left to a limit is an unknown of its own, which may not be negative.
        """
        count, limits = len(step), len(rows) - self.figures
        scale = np.append(np.ones(self.figures), np.full(limits, STRICT))
        spare = np.zeros((len(rows) + 2 * count, limits))
        spare[self.figures : len(rows)] = -STRICT * np.eye(limits)
        known = np.concatenate([scale[:, None] * slopes, _LAZY * np.eye(count), stiff])
        matrix = np.hstack([known, spare])
        right = -np.concatenate([scale * rows, _LAZY * step, np.zeros(count)])
        # No line may stand still for lack of room between its ends.
        ends = np.minimum(low - step, -1e-9), np.maximum(high - step, 1e-9)
        bounds = np.append(ends[0], np.zeros(limits)), np.append(ends[1], np.full(limits, np.inf))
        found = lsq_linear(matrix, right, bounds, method="bvls").x
        leant = STRICT * (matrix @ found - right)[self.figures : len(rows)]
        return found[:count], leant


def violation(rows: Floats, figures: int) -> float:
    """Return the squares of the first ``figures`` of ``rows``, and how far limits are broken [mm^2]."""
    away, broken = rows[:figures], STRICT * min(float(rows[figures:].min()), 0.0)
    return float(away @ away) + broken * broken


def next_trust_radius(reach: float, bold: float, kept: float) -> float:
    """Return how far the next step may go [%], after one that ``kept`` this part of what it promised.

    Further than ``bold`` it goes only if that was told to a hair.
    """
    if abs(kept - 1.0) < _AS_TOLD:
        return 2.0 * reach
    if kept > _MOSTLY:
        return max(min(2.0 * reach, bold), reach)
    return reach if kept > _HARDLY else reach / 2.0


def _root(matrix: Floats) -> Floats:
    """Return the root R, R^T R = matrix (p, p), without what is negative in it."""
    size, ways = np.linalg.eigh(matrix)
    return np.asarray(np.sqrt(np.maximum(size, 0.0))[:, None] * ways.T)
