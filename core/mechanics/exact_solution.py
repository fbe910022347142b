"""The exact answer that turns aim at: balance at exactly the wanted volumes and lengths (ours).

Newton steps lead there from rest, so that the answer depends on the design alone and not on the way there. If
they fail, the lengths are walked from rest in strides. Under sliding lines they always are: no energy tells
one balance from another there, and walking keeps to the one that turns come to, which are the last resort.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.iteration import LineTargets, initial_state, iterate
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium, SlidingSurface, energy_steps, equilibrium_at, sliding_steps
from core.mechanics.potential import Potential
from core.mechanics.sensitivity import Rates

NEWTON_LIMIT = 200
"""Newton steps after which the search is given up; half a dozen are the rule."""

_STRIDE = 0.05
_STRIDE_STEPS = 20
_SHORTEST_STRIDE = 0.01  # of the first one: a walk that must go more slowly has come to its end
_KEEPS_DOWN_TO = 1.0 / 64.0  # of the first one: where no shorter stride keeps to a branch it has an end
_OFF_WAY, _OFF_ANYWAY = 0.5, 0.5  # how far off the first step others may go: in parts of it, and [mm]
_TURNS = 3000
_AT_REST, _AWAY = 1e-6, 1.0  # largest move of a turn that has come to rest, and that runs away [mm]


def solve_exact(
    model: ConstrainedModel,
    ratios: tuple[float, ...],
    limit: int = NEWTON_LIMIT,
    *,
    excess: Floats | None = None,
    near: Equilibrium | None = None,
    turns: bool = True,
) -> Equilibrium:
    """Return the exact balance for line ``ratios``, one per line.

    ``excess`` (k,) [mm^3] is what the zones are to have beyond rest. ``near`` is a
    balance of the same model for other ratios to start from: quicker, but where there are several equilibria
    the answer then depends on it. If there is no balance, the nearest on the way there is returned, which is
    not ``found``. Without ``turns`` those of the last resort, a second of work, are not made.
    """
    *_, last = newton(model, ratios, limit, excess=excess, near=near, turns=turns)
    return last


def newton(
    model: ConstrainedModel,
    ratios: tuple[float, ...],
    limit: int = NEWTON_LIMIT,
    *,
    excess: Floats | None = None,
    near: Equilibrium | None = None,
    turns: bool = True,
) -> Iterator[Equilibrium]:
    """Yield the iterates on the way to the exact balance, the start included; see ``solve_exact``."""
    potential = Potential(model, ratios, excess)
    start = equilibrium_at(potential, initial_state(model).moved) if near is None else near
    last = replace(start, steps=0)
    if near is not None or not _slides(model):
        for last in _steps(potential, start, min(limit, _most_steps(model))):
            yield last
        if last.is_converged or last.steps >= limit:
            return
    slides, spared = _slides(model), _STRIDE_STEPS if _slides(model) else 0
    done, most = last.steps, limit - last.steps - spared
    for last in _continuation(model, ratios, excess, max(most, 1), keeps=slides):
        yield replace(last, steps=done + last.steps)
    if last.is_converged or not slides:
        return
    done += last.steps
    turned = _turned(model, ratios, excess) if turns and most >= 0 else None
    if turned is None or not turned.is_converged:
        for last in _continuation(model, ratios, excess, max(most, 1), keeps=False):
            yield replace(last, steps=done + last.steps)
        done += last.steps
    # Where turns run away, what the walk came to stays the answer.
    if turned is not None and not last.is_converged:
        yield replace(turned, steps=done + turned.steps)


def _most_steps(model: ConstrainedModel) -> int:
    return _STRIDE_STEPS if _slides(model) else NEWTON_LIMIT


def _slides(model: ConstrainedModel) -> bool:
    return model.options.line_contact == "sliding" and len(model.owner) > 0


def _steps(potential: Potential, start: Equilibrium, limit: int) -> Iterator[Equilibrium]:
    steps = sliding_steps if _slides(potential.model) else energy_steps
    return steps(potential, start, limit)


def _continuation(
    model: ConstrainedModel, ratios: tuple[float, ...], excess: Floats | None, limit: int, keeps: bool
) -> Iterator[Equilibrium]:
    """Yield the iterates of a walk from rest to ``ratios`` in strides, the last one where it breaks off.

    Each stride ends in a balance. Under sliding lines others lie about: one that ``keeps`` to the branch that
    comes from rest takes no steps that go elsewhere than the first one leads, but shorter strides. Where the
    branch has an end it leaps to another and goes on.
    """
    way = max(abs(ratio - 1.0) for ratio in ratios)
    first = stride = min(1.0, _STRIDE / max(way, 1e-9))
    done, steps, kept = 0.0, 0, keeps
    last = equilibrium_at(Potential(model, ratios), initial_state(model).moved)
    while done < 1.0 and steps < limit and stride > _SHORTEST_STRIDE * first:
        share = min(done + stride, 1.0)
        between = tuple(1.0 + share * (ratio - 1.0) for ratio in ratios)
        potential = Potential(model, between, None if excess is None else share * excess)
        found, ways = last, _steps(potential, last, min(_STRIDE_STEPS, limit - steps))
        for found in _follow_branch(last, ways) if kept else ways:
            if found.steps or found.is_converged:
                yield replace(found, steps=steps + found.steps)
        steps += found.steps
        if found.is_converged:
            done, last, stride, kept = share, found, 1.5 * stride, keeps
        elif kept and stride < _KEEPS_DOWN_TO * first:
            stride, kept = first, False
        else:
            stride /= 2.0
    if done < 1.0:
        yield replace(last, steps=steps, residual=np.inf)


def _follow_branch(start: Equilibrium, steps: Iterator[Equilibrium]) -> Iterator[Equilibrium]:
    """Yield ``steps`` as long as they keep to where the first of them leads from ``start``."""
    towards, allowed = start.state.moved, np.inf
    for step in steps:
        if step.steps == 1:
            towards = step.state.moved
            allowed = _OFF_WAY * np.abs(towards - start.state.moved).max() + _OFF_ANYWAY
        if np.abs(step.state.moved - towards).max() > allowed:
            return
        yield step


def _turned(model: ConstrainedModel, ratios: tuple[float, ...], excess: Floats | None) -> Equilibrium | None:
    """Return what adaptive turns and a few Newton steps after them come to, None if they run away.

    The sum of all zones is balanced first, as turns of a bust hold it; then each is given what it should
    have.
    """
    moved = initial_state(model).moved
    for state, measured in iterate(model, lambda: LineTargets(ratios), turns=_TURNS):
        moved = state.moved
        if measured.step < _AT_REST:
            break
    both = model.tensegric.with_options(replace(model.options, volume_of="both"))
    potential = Potential(replace(model, tensegric=both), ratios, excess)
    place = potential.at(moved)
    forces, push = SlidingSurface(potential.model).projected(place)
    multipliers = np.asarray(np.linalg.lstsq(push.T, forces, rcond=1e-12)[0])
    start = equilibrium_at(potential, moved, np.inf, multipliers)
    best = min(_steps(potential, start, _STRIDE_STEPS), key=lambda balance: balance.residual)
    zones = len(Potential(model, ratios).groups)
    if best.is_converged and zones > 1:
        best = _balance_zones(model, ratios, np.zeros(zones) if excess is None else excess, best)
    return best if best.is_converged or measured.step < _AWAY else None


def _balance_zones(
    model: ConstrainedModel, ratios: tuple[float, ...], excess: Floats, both: Equilibrium
) -> Equilibrium:
    """Return the balance in which each zone has its volume, from one in which the sum is right."""
    gap = model.volume.zone_volumes(model.tensegric.expand(both.state.moved)) - model.rest_zones - excess
    pressures = np.repeat(both.multipliers[:1], len(excess))
    last = replace(both, multipliers=np.concatenate([pressures, both.multipliers[1:]]))
    for share in np.linspace(0.95, 0.0, 20):
        potential = Potential(model, ratios, excess + share * gap)
        *_, last = _steps(potential, last, _STRIDE_STEPS)
        if not last.is_converged:
            break
    return last


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
