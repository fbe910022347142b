"""The smallest number of sizes that serves a share of the bodies: partial covering by garments of bodies.

Each body is a candidate: a garment made for it serves every body within the tolerance. The smallest number
for a share is an integer program, solved by HiGHS (scipy); sizes of large runs are chosen one by one.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, milp
from scipy.sparse import csr_array, hstack, identity

from core.analysis.grading.tolerance import ComparedBodies
from core.geometry.mesh import Flags, Floats, Indices

MOST_EXACT = 400
"""Bodies up to which the smallest number is searched exactly."""

MOST_BODIES = 4000
"""More bodies are represented by a sample: the table of who serves whom grows with the square."""

NODES = 2000
"""Branches of the search. It is no time, so that results are the same on every machine."""

FOLDS = 5
_SEED = 20260101


@dataclass(frozen=True)
class ChosenSize:
    """A size made for a ``body``, by its place; ``serves`` are the places of those it suits best.

    A body is counted once: at the size with the smallest deviation.
    """

    body: int
    serves: tuple[int, ...]


@dataclass(frozen=True)
class Coverage:
    """Sizes that serve at least ``share`` of ``count`` bodies; ``needed`` bodies.

    ``least`` is a number below which no choice is enough: the number of sizes itself if it is the smallest.
    ``curve`` are the shares served by 1, 2, 3 ... sizes, each added to those before it. ``held_out`` is the
    share of bodies served by as many sizes chosen without them, None for fewer than 2 * FOLDS bodies.
    ``sampled`` is whether the bodies are a sample of all.
    """

    share: float
    count: int
    needed: int
    sizes: tuple[ChosenSize, ...]
    least: int
    curve: tuple[float, ...]
    held_out: float | None
    sampled: bool

    @property
    def served(self) -> int:
        """Return how many bodies the sizes serve."""
        return sum(len(each.serves) for each in self.sizes)

    @property
    def is_smallest(self) -> bool:
        """Return whether fewer sizes are proved not to be enough."""
        return len(self.sizes) == self.least


def coverage(compared: ComparedBodies, share: float) -> Coverage | None:
    """Return the fewest sizes found that serve a ``share`` (0 to 1) of the complete bodies.

    None if no body is complete.
    """
    places = np.flatnonzero(compared.complete)
    sampled = len(places) > MOST_BODIES
    rows = np.arange(len(places))
    if sampled:
        rows = np.sort(np.random.default_rng(_SEED).choice(len(places), MOST_BODIES, replace=False))
    if not len(rows):
        return None
    excess = compared.excess(rows)
    serves = excess <= 1.0
    needed = max(1, ceil(share * len(rows) - 1e-9))
    order, counts = greedy(serves)
    chosen = order[: int(np.searchsorted(counts, needed)) + 1]
    least = lower_bound(serves, order, needed)
    if len(rows) <= MOST_EXACT and least < len(chosen):
        chosen, least = _smallest(serves, needed, chosen, least)
    curve = tuple(float(count) / len(rows) for count in counts)
    sizes = _assigned(excess, chosen, places[rows])
    return Coverage(share, len(rows), needed, sizes, least, curve, _held_out(serves, len(chosen)), sampled)


def greedy(serves: Flags, most: int | None = None) -> tuple[Indices, Indices]:
    """Return candidates (k,), each serving most bodies not yet served, and the bodies served (k,).

    ``serves`` (n, n) is whether a candidate, by row, serves a body, itself too. All bodies are served in
    the end, or as many as ``most`` candidates serve.
    """
    left = np.ones(serves.shape[1], dtype=bool)
    gains = serves.sum(axis=1)
    order: list[int] = []
    counts: list[int] = []
    while left.any() and (most is None or len(order) < most):
        best = int(np.argmax(gains))
        newly = np.flatnonzero(serves[best] & left)
        order.append(best)
        left[newly] = False
        counts.append(int((~left).sum()))
        gains = gains - serves[:, newly].sum(axis=1)
    return np.array(order, dtype=np.int64), np.array(counts, dtype=np.int64)


def lower_bound(serves: Flags, order: Indices, needed: int) -> int:
    """Return a number of sizes below which no choice serves ``needed`` bodies.

    After any candidates are chosen, k more serve no more than the k largest gains together; so do any k.
    """
    left, gains, bound = np.ones(serves.shape[1], dtype=bool), serves.sum(axis=1), 1
    for candidate in order:
        reached = int((~left).sum()) + np.cumsum(np.sort(gains)[::-1])
        if reached[0] >= needed:
            break
        bound = max(bound, int(np.searchsorted(reached, needed)) + 1)
        newly = np.flatnonzero(serves[candidate] & left)
        left[newly] = False
        gains = gains - serves[:, newly].sum(axis=1)
    return bound


def _smallest(serves: Flags, needed: int, chosen: Indices, least: int) -> tuple[Indices, int]:
    """Return the smallest choice that the search finds, and a number below which there is none.

    The unknowns are n candidates, chosen or not, and n bodies, served or not: a body is served only by a
    candidate that is chosen, and ``needed`` are served.
    """
    count = len(serves)
    links = hstack([csr_array(serves.T.astype(float)), -identity(count)], format="csr")
    all_served = csr_array(np.concatenate([np.zeros(count), np.ones(count)])[None, :])
    chosen_sum = csr_array(np.concatenate([np.ones(count), np.zeros(count)])[None, :])
    found = milp(
        np.concatenate([np.ones(count), np.zeros(count)]),
        integrality=np.concatenate([np.ones(count), np.zeros(count)]),
        bounds=Bounds(0.0, 1.0),
        constraints=[
            LinearConstraint(links, 0.0, np.inf),
            LinearConstraint(all_served, needed, np.inf),
            LinearConstraint(chosen_sum, least, len(chosen)),
        ],
        options={"node_limit": NODES},
    )
    bound = found.fun if found.status == 0 else found.mip_dual_bound  # 0: the smallest is found
    if bound is not None and np.isfinite(bound):
        least = max(least, ceil(bound - 1e-6))
    if found.x is not None:
        better = np.flatnonzero(found.x[:count] > 0.5)
        if len(better) < len(chosen) and serves[better].any(axis=0).sum() >= needed:
            chosen = better
    return chosen, min(least, len(chosen))


def _assigned(excess: Floats, chosen: Indices, places: Indices) -> tuple[ChosenSize, ...]:
    """Return the sizes with the bodies that each serves best, that with most bodies first."""
    nearest, least = np.argmin(excess[chosen], axis=0), np.min(excess[chosen], axis=0)
    sizes = [
        ChosenSize(int(places[body]), tuple(map(int, places[(nearest == at) & (least <= 1.0)])))
        for at, body in enumerate(chosen)
    ]
    return tuple(sorted(sizes, key=lambda each: (-len(each.serves), each.body)))


def _held_out(serves: Flags, sizes: int) -> float | None:
    """Return the share of bodies that is served by ``sizes`` sizes chosen among the other folds of bodies."""
    count = len(serves)
    if count < 2 * FOLDS:
        return None
    fold = np.random.default_rng(_SEED).permutation(count) % FOLDS
    reached = 0
    for number in range(FOLDS):
        inside, outside = np.flatnonzero(fold != number), np.flatnonzero(fold == number)
        order, _ = greedy(serves[np.ix_(inside, inside)], sizes)
        reached += int(serves[np.ix_(inside[order], outside)].any(axis=0).sum())
    return reached / count
