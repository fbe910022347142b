"""The exact answer that holds the volume of the body itself: an outer loop round the plain one (ours).

Turns and the plain exact answer measure the volume on the control mesh (paper section 4); the body that
follows by t-FFD then keeps its own only nearly. Here the control mesh is given what the body lacks, until it
lacks nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.exact_solution import NEWTON_LIMIT, solve_exact
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium
from core.mechanics.sensitivity import Rates

BodyChange = Callable[[Points], Floats]
"""What the body's left and right have gained [mm^3], (2,), for the control points, shape (n, 3) [mm]."""

PRECISION = 1e-9
"""Largest volume that the body may lack in the end, in parts of the control mesh's volume."""

_ROUNDS = 12


def solve_body_exact(
    model: ConstrainedModel,
    ratios: tuple[float, ...],
    change: BodyChange,
    limit: int = NEWTON_LIMIT,
    *,
    near: Equilibrium | None = None,
) -> Equilibrium:
    """Return the exact balance for line ``ratios`` at which the body keeps its volume.

    With ``volume_of`` "each" both breasts of the body do. It is not ``found`` if the outer loop does not end.
    """
    excess, steps = np.zeros(2), 0
    for _ in range(_ROUNDS):
        last = near = solve_exact(model, ratios, limit, excess=excess, near=near)
        steps += last.steps
        too_much = volume_gain(model, change, last)
        if not last.is_converged or np.abs(too_much).max() < PRECISION * abs(model.volume.rest_volume):
            return replace(last, steps=steps)
        excess = excess - too_much
    return replace(last, steps=steps, residual=np.inf)


def volume_gain(model: ConstrainedModel, change: BodyChange, balance: Equilibrium) -> Floats:
    """Return what the body's left and right have beyond what they are to keep, shape (2,) [mm^3].

    Where only their sum is kept, each side's is half of it.
    """
    more = change(model.tensegric.expand(balance.state.moved))
    return more if model.options.volume_of == "each" else np.full(2, more.sum() / 2.0)


def rates_at_body_volume(rates: Rates, by_excess: Rates, slopes: Floats, *, each: bool) -> Rates:
    """Return the rates at which the body, not the control mesh, keeps its volume.

    ``rates`` are those at which the control mesh keeps it and ``by_excess`` those by its excess; ``slopes``
    (2, 3 f) [mm^2] are those of what the body's left and right have gained by the free points' displacements.
    ``each`` tells whether both sides keep theirs or only their sum.
    """
    given = np.eye(2) if each else np.ones((2, 1))
    kept = slopes if each else slopes.sum(axis=0, keepdims=True)
    excess = -given @ np.linalg.solve(kept @ by_excess.moved @ given, kept @ rates.moved)
    return Rates(rates.moved + by_excess.moved @ excess, rates.multipliers + by_excess.multipliers @ excess)
