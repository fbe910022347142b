"""The exact answer that turns aim at: balance at exactly the wanted volumes and lengths (ours).

Newton steps lead there from rest, so that the answer depends on the design alone and not on the way there. If
they fail, the lengths are walked from rest in strides; under sliding lines turns are the last resort.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from core.mesh import Floats
from core.model import ConstrainedModel
from core.newton import Balance, balance_at, energy_steps
from core.potential import Potential
from core.sliding import Skin, sliding_steps
from core.solver import Targets, at_rest, iterate

NEWTON_LIMIT = 200
"""Newton steps after which the search is given up; half a dozen are the rule."""

_STRIDE_STEPS = 20
_LEAST_STRIDE = 1.0 / 256.0
_TURNS = 3000


def solve_exact(
    model: ConstrainedModel,
    ratios: tuple[float, ...],
    limit: int = NEWTON_LIMIT,
    *,
    excess: Floats | None = None,
    near: Balance | None = None,
) -> Balance:
    """Return the exact balance for line ``ratios``, one per line.

    ``excess`` (2,) [mm^3] is what the left and the right volume are to have beyond rest. ``near`` is a
    balance of the same model for other ratios to start from: quicker, but where there are several equilibria
    the answer then depends on it. If there is no balance, the nearest on the way there is returned, which is
    not ``found``.
    """
    *_, last = newton(model, ratios, limit, excess=excess, near=near)
    return last


def newton(
    model: ConstrainedModel,
    ratios: tuple[float, ...],
    limit: int = NEWTON_LIMIT,
    *,
    excess: Floats | None = None,
    near: Balance | None = None,
) -> Iterator[Balance]:
    """Yield the iterates on the way to the exact balance, the start included; see ``solve_exact``."""
    potential = Potential(model, ratios, excess)
    start = balance_at(potential, at_rest(model).moved) if near is None else near
    last = start
    for last in _steps(potential, start, min(limit, _first_try(model))):
        yield last
    if last.found or last.steps >= limit:
        return
    walked = _walk(model, ratios, excess, limit - last.steps)
    if not walked.found and _slides(model):
        walked = _turned(potential, ratios)
    yield replace(walked, steps=last.steps + walked.steps)


def _first_try(model: ConstrainedModel) -> int:
    return 2 * _STRIDE_STEPS if _slides(model) else NEWTON_LIMIT


def _slides(model: ConstrainedModel) -> bool:
    return model.mechanics.line_contact == "sliding" and len(model.owner) > 0


def _steps(potential: Potential, start: Balance, limit: int) -> Iterator[Balance]:
    steps = sliding_steps if _slides(potential.model) else energy_steps
    return steps(potential, start, limit)


def _walk(model: ConstrainedModel, ratios: tuple[float, ...], excess: Floats | None, limit: int) -> Balance:
    """Return the balance that the lengths lead to on a straight way from rest, as far as that goes."""
    done, stride, steps = 0.0, 0.25, 0
    last = balance_at(Potential(model, ratios), at_rest(model).moved)
    while done < 1.0 and steps < limit and stride > _LEAST_STRIDE:
        share = min(done + stride, 1.0)
        between = tuple(1.0 + share * (ratio - 1.0) for ratio in ratios)
        potential = Potential(model, between, None if excess is None else share * excess)
        *_, found = _steps(potential, last, _STRIDE_STEPS)
        steps += found.steps
        if found.found:
            done, last, stride = share, found, 1.5 * stride
        else:
            stride /= 2.0
    return replace(last, steps=steps, residual=last.residual if done >= 1.0 else np.inf)


def _turned(potential: Potential, ratios: tuple[float, ...]) -> Balance:
    """Return what adaptive turns and a few Newton steps after them come to, balanced or not."""
    moved = at_rest(potential.model).moved
    for state, measured in iterate(potential.model, lambda: Targets(ratios), turns=_TURNS):
        moved = state.moved
        if measured.step < 1e-6:
            break
    place = potential.at(moved)
    forces, push = Skin(potential.model).projected(place)
    multipliers = np.asarray(np.linalg.lstsq(push.T, forces, rcond=1e-12)[0])
    start = balance_at(potential, moved, np.inf, multipliers)
    return min(_steps(potential, start, _STRIDE_STEPS), key=lambda balance: balance.residual)
