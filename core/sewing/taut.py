"""A taut band over a body: where it lies on the skin, where it bridges a hollow, and how it presses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.mesh import Flags, Floats, Indices, Points

STANDS_OFF = 1.5
"""A taut band that stands off the skin by less than this lies on it [mm]."""


@dataclass(frozen=True)
class Bridge:
    """Where a taut band goes straight over a hollow: from ``begin`` to ``end``, up to ``height`` [mm] off."""

    begin: float
    end: float
    height: float

    @property
    def length(self) -> float:
        """How far the band does not lie on the skin [mm]."""
        return self.end - self.begin


def taut(points: Points, normals: Points, closed: bool) -> tuple[Floats, Flags]:
    """Pull a band taut over places of a skin and its outward normals, both (k, 3).

    Returns by how much it turns towards the skin at each place [rad], the force on it over the tension, and
    which places it touches; between them it goes straight. Across the normals it stays where it is sewn.
    """
    count = len(points)
    turns, touched = np.zeros(count), np.ones(count, dtype=np.bool_)
    if count > 2:
        order = _order(points, closed)
        kept = _pressing(points[order], normals[order])
        turns[order[kept]] = _turns(points[order], normals[order], kept, closed)
        touched[:] = False
        touched[order[kept]] = True
    return turns, touched


def straight(points: Points, touched: Flags) -> Points:
    """Return where a band is that goes straight from one ``touched`` (k,) place to the next, (k, 3) [mm]."""
    at, kept = np.arange(len(points)), np.flatnonzero(touched)
    columns = (np.interp(at, kept, axis[kept], period=len(points)) for axis in points.T)
    return np.stack(list(columns), axis=1)


def _order(points: Points, closed: bool) -> Indices:
    """Return the places in turn; round a closed band from one that surely touches, and back to it."""
    first = int(np.linalg.norm(points - points.mean(axis=0), axis=1).argmax()) if closed else 0
    return (np.arange(first, first + len(points) + closed)) % len(points)


def _pressing(points: Points, normals: Points) -> Indices:
    """Return which places are touched, ends included: each that would be pulled off the skin is left out."""
    kept: list[int] = []
    for at in range(len(points)):
        while (
            len(kept) > 1 and _turn(points[kept[-2]], points[kept[-1]], points[at], normals[kept[-1]]) < 0.0
        ):
            kept.pop()
        kept.append(at)
    return np.array(kept)


def _turn(before: Floats, here: Floats, after: Floats, normal: Floats) -> float:
    """Return the turn towards the skin at ``here`` [rad]; negative where a band would be pulled off it."""
    come, go = here - before, after - here
    return float((come / np.linalg.norm(come) - go / np.linalg.norm(go)) @ normal)


def _turns(points: Points, normals: Points, kept: Indices, closed: bool) -> Floats:
    """Return the turn at each kept place; open ends have none, the last of a closed one is its first."""
    ways = np.diff(points[kept], axis=0)
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    inner = np.einsum("kx,kx->k", ways[:-1] - ways[1:], normals[kept[1:-1]])
    end = float((ways[-1] - ways[0]) @ normals[kept[0]]) if closed else 0.0
    return np.asarray(np.maximum(np.concatenate([[end], inner, [end]]), 0.0))


def bridges(off: Floats, step: float, closed: bool) -> tuple[Bridge, ...]:
    """Return where a band stands ``off`` (k,) [mm] its skin so that it shows; places lie ``step`` [mm] apart.

    One that goes over the beginning of a closed band ends beyond its end.
    """
    found = []
    for run in _runs(off > 0.0, closed):
        height = float(off[run % len(off)].max())
        if height > STANDS_OFF:
            found.append(Bridge(step * (float(run[0]) - 0.5), step * (float(run[-1]) + 0.5), height))
    return tuple(found)


def _runs(flags: Flags, closed: bool) -> list[Indices]:
    """Return the places of each run of true ``flags``; round a closed band they go on beyond the end."""
    start = int(np.argmin(flags)) if closed else 0
    turned = np.roll(flags, -start)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], turned, [False]])))
    return [np.arange(a, b) + start for a, b in edges.reshape(-1, 2)]
