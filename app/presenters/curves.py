"""What a plot shows: curves over the turns of runs, the exact answer, and where something was changed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]

_FLIP_WINDOW = 24


@dataclass(frozen=True, eq=False)
class Curve:
    """A run: ``turns`` (n,), ``values`` (n,); its role is main, warning (main, but vibrating) or ghost."""

    turns: Numbers
    values: Numbers
    role: str
    name: str = ""


@dataclass(frozen=True)
class Event:
    """A change at a ``turn``, in words."""

    turn: float
    words: str


@dataclass(frozen=True, eq=False)
class Plotted:
    """All that one plot shows: ``exact`` is the answer that turns aim at, ``tolerance`` a band about zero."""

    curves: tuple[Curve, ...] = ()
    exact: float | None = None
    exact_is_main: bool = False
    tolerance: float = 0.0
    events: tuple[Event, ...] = ()

    def turns(self) -> tuple[float, float]:
        """Return the first and the last turn, at least ten apart."""
        ends = [(float(curve.turns[0]), float(curve.turns[-1])) for curve in self.curves if len(curve.turns)]
        first = min((end[0] for end in ends), default=0.0)
        return first, max(max((end[1] for end in ends), default=0.0), first + 10.0)

    def values(self, first: float, last: float) -> tuple[float, float]:
        """Return the lowest and the highest of what is drawn between two turns."""
        seen = [
            curve.values[(curve.turns >= first) & (curve.turns <= last) & np.isfinite(curve.values)]
            for curve in self.curves
        ]
        levels = [] if self.exact is None else [self.exact]
        if self.tolerance:
            levels += [-self.tolerance, self.tolerance]
        together = np.concatenate([*seen, np.array(levels, dtype=np.float64)])
        return (float(together.min()), float(together.max())) if len(together) else (0.0, 0.0)

    def strong(self) -> Curve | None:
        """Return the curve of the run that is on the body."""
        return next((curve for curve in self.curves if curve.role != "ghost" and len(curve.turns)), None)

    def nearest(self, turn: float) -> float | None:
        """Return the turn that was made nearest to ``turn``, if there is one."""
        curve = self.strong() or next((each for each in self.curves if len(each.turns)), None)
        return None if curve is None else float(curve.turns[int(np.abs(curve.turns - turn).argmin())])

    def at(self, turn: float) -> list[tuple[Curve, float]]:
        """Return each curve's value at a turn; a run that rests stays where it came to."""
        found = []
        for curve in sorted(self.curves, key=lambda each: each.role == "ghost"):
            made = int(np.searchsorted(curve.turns, turn, side="right")) - 1
            if made >= 0:
                found.append((curve, float(curve.values[made])))
        return found


def flips_every_turn(values: Numbers) -> bool:
    """Return whether the last values go up and down in turn, by more than a trifle."""
    recent = values[-_FLIP_WINDOW:]
    if len(recent) < 8 or not np.isfinite(recent).all():
        return False
    steps = np.diff(recent)
    flips = np.count_nonzero(steps[1:] * steps[:-1] < 0.0)
    span = float(np.ptp(values[np.isfinite(values)]))
    return bool(flips >= 0.8 * (len(steps) - 1) and np.abs(steps).mean() > 0.02 * span > 0.0)


def envelope(values: Numbers) -> tuple[Numbers, Numbers]:
    """Return lower and upper edge, each (n,), of values that flip: their own or their neighbours' mean."""
    padded = np.concatenate([values[1:2], values, values[-2:-1]])
    across = (padded[:-2] + padded[2:]) / 2.0
    return np.minimum(values, across), np.maximum(values, across)
