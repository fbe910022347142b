"""Monte Carlo samples: all uncertain parameters at random, each design solved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.analysis.uncertainty.outputs import Figures
from core.analysis.uncertainty.parameters import UncertainParameter, perturb
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.blas_threads import one_blas_thread
from core.errors import UserError
from core.geometry.mesh import Floats
from core.progress import Progress, quiet


@dataclass(frozen=True, eq=False)
class Samples:
    """Draws of the ``draws`` (s, k) of knobs in standard deviations, with the ``outputs`` of each.

    ``failed`` counts draws that had no answer and are left out.
    """

    draws: Floats
    outputs: tuple[Figures, ...]
    failed: int

    def values(self, key: str) -> Floats:
        """Return a figure of all draws that have it, shape (d,)."""
        return np.array([each[key] for each in self.outputs if key in each])

    def deviations(self) -> dict[str, float]:
        """Return the standard deviation of each figure that all draws have."""
        keys = set.intersection(*(set(each) for each in self.outputs)) if len(self.outputs) > 1 else set()
        return {key: float(self.values(key).std(ddof=1)) for key in sorted(keys)}


def sample(
    trials: PerturbedSolutions,
    knobs: Sequence[UncertainParameter],
    count: int,
    seed: int = 1,
    progress: Progress = quiet,
) -> Samples:
    """Draw all ``knobs`` ``count`` times from normal distributions, and solve each draw anew."""
    draws = np.random.default_rng(seed).standard_normal((count, len(knobs)))
    kept, figures = [], []
    with one_blas_thread():
        for at, draw in enumerate(draws):
            progress("sampling", at / count)
            turns = dict(zip(knobs, draw.tolist(), strict=True))
            try:
                figures.append(trials(perturb(trials.base, turns), keep=False).values)
                kept.append(draw)
            except UserError:
                continue
    return Samples(np.array(kept).reshape(len(kept), len(knobs)), tuple(figures), count - len(kept))
