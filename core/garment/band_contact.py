"""A taut band over a body: where it lies on the skin, where it bridges a hollow, and how it presses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.geometry.mesh import Flags, Floats, Indices, Points, unit
from core.geometry.plane_sections import interpolate

Outline = npt.NDArray[np.complex128]
"""Places of a plane curve, (k,) [mm]."""

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
        """Return how far the band does not lie on the skin [mm]."""
        return self.end - self.begin


def pull_taut(points: Points, normals: Points, closed: bool) -> tuple[Floats, Flags]:
    """Compute the taut path of a band over points of a skin and its outward normals, both (k, 3).

    Returns by how much it turns towards the skin at each place [rad], the force on it over the tension, and
    which places it touches; between them it goes straight. It comes off along the normals alone: what it
    turns sideways is sewn into it.
    """
    count = len(points)
    turns, touched = np.zeros(count), np.ones(count, dtype=np.bool_)
    if count > 2:
        rounds = 3 if closed else 1  # where the first round begins may be in a hollow: the second is taken
        flat = _rolled_out(points, normals, closed, rounds)
        kept = _pressing(flat)
        ways = np.diff(flat[kept])
        found = np.zeros(len(flat))
        found[kept[1:-1]] = np.angle(ways[1:] / ways[:-1])
        first = count * (rounds // 2)
        turns = np.maximum(found[first : first + count], 0.0)
        touched = np.isin(np.arange(first, first + count), kept)
    return turns, touched


def bridge_between(points: Points, normals: Points, touched: Flags, closed: bool) -> tuple[Points, Floats]:
    """Return where a band is that goes straight from one ``touched`` (k,) place to the next, and how far off.

    Places (k, 3) and distances from the skin (k,) [mm], both along the band and its normals alone.
    """
    at, kept, count = np.arange(len(points)), np.flatnonzero(touched), len(points)
    period = count if closed else None
    places = interpolate(at, kept, points[kept], period)
    ahead = (
        np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0) if closed else np.gradient(points, axis=0)
    )
    side, apart = unit(np.cross(normals, ahead)), places - points
    apart -= np.einsum("kx,kx->k", apart, side)[:, None] * side
    off = np.linalg.norm(apart, axis=1)
    off[touched] = 0.0
    return points + apart, off


def _rolled_out(points: Points, normals: Points, closed: bool, rounds: int) -> Outline:
    """Return the strip that stands on the course along the normals, rolled out flat: its foot, (k,) [mm].

    Every turn towards the skin is kept, and every length; what it turns sideways is lost.
    """
    ways = np.diff(np.concatenate([points, points[:1]]) if closed else points, axis=0)
    lengths = np.linalg.norm(ways, axis=1)
    ways = ways / lengths[:, None]
    turns = np.einsum("kx,kx->k", np.roll(ways, 1, axis=0) - ways, normals[: len(ways)])
    if not closed:
        turns[0] = 0.0
    steps = np.tile(lengths, rounds) * np.exp(1j * np.cumsum(np.tile(turns, rounds)))
    return np.concatenate([[0.0], np.cumsum(steps)])


def _pressing(foot: Outline) -> Indices:
    """Return which places are touched, ends included: each that would be pulled off the skin is left out."""
    kept: list[int] = []
    here = foot.tolist()
    for at, place in enumerate(here):
        while len(kept) > 1:
            before, last = here[kept[-2]], here[kept[-1]]
            if ((place - last) * (last - before).conjugate()).imag >= 0.0:
                break
            kept.pop()
        kept.append(at)
    return np.array(kept)


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
