"""Stability forecast: equilibrium of the iteration and its growth rate (ours).

Turns of each control come to rest where the forces balance at the volume that the control then keeps. From
there some dozen turns after a small push tell whether a swing fades or grows.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.exact_solution import solve_body_exact, solve_exact
from core.mechanics.gain_limit import OscillationLimit
from core.mechanics.iteration import LineTargets, Record, SolverState, iterate
from core.mechanics.mesh_quality import MeshQuality
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium, equilibrium_at
from core.mechanics.potential import Potential
from core.mechanics.solver_comparison import shape_of
from core.mechanics.volume import KEEPS_VOLUME, Pressure
from core.pipeline.model_stages import line_targets
from core.pipeline.stages import RegionStages

FADES = 0.975
"""Growth of a swing per turn below which it is gone within the turns that a run is watched [1]; ours."""

PUSH = 0.02
"""How far the push moves a point at most [mm]: small enough for turns to answer in proportion."""

_FAR = 0.1  # of the lengths from which another balance is looked for [1]
_QUICK, _FROM_REST = 20, 90  # Newton steps from near by, and from rest, after which no balance is hoped for
_SPAN, _SHORT_SPAN = 30, 10
_CLOSE = (0.9, 1.05)  # growths of a short span that tell nothing: its swing is not yet the one that stays
_ROUNDS = 12
_NEAR = 1e-7  # volume errors this far apart are the same [1]
_NO_GAIN = 1e-6  # stands for none where zones are held separately


@dataclass(frozen=True, eq=False)
class StabilityForecast:
    """Where the turns of a design come to rest, and in what ``condition`` the control mesh is there."""

    model: ConstrainedModel
    targets: LineTargets
    balance: Equilibrium
    condition: MeshQuality

    @cached_property
    def growth(self) -> float:
        """Return the growth of small oscillations per iteration [1]; 0 without oscillation."""
        if self.targets.control == "exact":
            return 0.0
        return oscillation_growth(self.model, self.targets, self.balance)

    @cached_property
    def is_stable(self) -> bool:
        """Return whether the run comes to rest there: a few turns tell, unless it is close."""
        if self.targets.control == "exact":
            return True
        growth = oscillation_growth(self.model, self.targets, self.balance, _SHORT_SPAN)
        return (self.growth if _CLOSE[0] < growth < _CLOSE[1] else growth) < FADES


def forecast(stages: RegionStages, near: StabilityForecast | None = None) -> StabilityForecast | None:
    """Return how the run of a design will end, None where there is nothing for it to rest at.

    From an outlook ``near`` by it is found quickly or held not to be there.
    """
    model, targets = stages.model, line_targets(stages.design, stages)
    return _seen(model, targets, equilibrium_for(stages, targets, _start(near, model, targets)))


def forecast_about(stages: RegionStages, moved: Points) -> StabilityForecast | None:
    """Return where turns rest that stand about ``moved``, (f, 3) [mm], None if nothing is there.

    Where lines slide there may be more than one balance, and turns come to another than a walk from rest.
    """
    model, targets = stages.model, line_targets(stages.design, stages)
    if targets.control == "exact":
        return forecast(stages)
    if not np.isfinite(moved).all():
        return None
    start = equilibrium_at(Potential(combined_volume_model(model), targets.ratios), moved)
    return _seen(model, targets, equilibrium_for(stages, targets, start))


def _seen(model: ConstrainedModel, targets: LineTargets, balance: Equilibrium) -> StabilityForecast | None:
    if not balance.is_converged:
        return None
    condition = shape_of(model).quality(model.tensegric.expand(balance.state.moved))
    return StabilityForecast(model, targets, balance, condition)


def _start(
    near: StabilityForecast | None, model: ConstrainedModel, targets: LineTargets
) -> Equilibrium | None:
    """Return the balance of ``near`` if a search can start there; exact answers are found from rest."""
    if near is None or targets.control == "exact" or length_difference(near, model, targets) > _FAR:
        return None
    return near.balance


def length_difference(near: StabilityForecast, model: ConstrainedModel, targets: LineTargets) -> float:
    """Return how far the lengths of two outlooks are apart [1], inf for those that share no model."""
    if near.model is not model or near.targets.control == "exact":
        return np.inf
    return float(np.abs(np.subtract(near.targets.ratios, targets.ratios)).max(initial=0.0))


def equilibrium_for(
    stages: RegionStages, targets: LineTargets, near: Equilibrium | None = None
) -> Equilibrium:
    """Return the balance that a design comes to rest at with other ``targets``; see ``solve_exact``."""
    model = stages.model
    if targets.control == "exact":
        if stages.design.dense_volume:
            return solve_body_exact(model, targets.ratios, stages.body_change, near=near)
        return solve_exact(model, targets.ratios, _most_steps(near), near=near, turns=False)
    if model.volume.separate:
        return _kept_apart(model, targets, near)
    return _kept(combined_volume_model(model), targets, near)


def combined_volume_model(model: ConstrainedModel) -> ConstrainedModel:
    """Return a model as turns measure it: both breasts together, whatever the exact answer holds.

    Zones that are held separately are so in turns as well.
    """
    if model.volume.separate:
        return model
    both = model.tensegric.with_options(replace(model.options, volume_of="both"))
    return replace(model, tensegric=both)


def _kept(model: ConstrainedModel, targets: LineTargets, near: Equilibrium | None) -> Equilibrium:
    """Return the balance at the volume that a control keeps: another than at rest where it has no memory.

    There the pressure is the gain times what is missing; that is closed in on by secants.
    """
    keeps = targets.control in KEEPS_VOLUME
    excess = 0.0 if keeps or near is None else _excess(model, near)

    def at(excess: float, steps: int, near: Equilibrium | None) -> Equilibrium:
        kept = np.full(2, 0.5 * excess * model.volume.rest_volume)
        return solve_exact(model, targets.ratios, steps, excess=kept, near=near, turns=False)

    here = at(excess, _most_steps(near), near)
    if keeps or not here.is_converged:
        return here
    gain = targets.gain if targets.control == "conventional" else 0.0

    def missing(balance: Equilibrium, excess: float) -> float:
        return float(balance.pressures[0]) / model.pressure_unit + gain * excess

    before, amiss_before = excess, missing(here, excess)
    excess -= amiss_before / (gain + 0.3)
    for _ in range(_ROUNDS):
        here = at(excess, _QUICK, here)
        amiss = missing(here, excess)
        if not here.is_converged or abs(excess - before) < _NEAR or amiss == amiss_before:
            return here
        slope = (amiss - amiss_before) / (excess - before)
        before, amiss_before, excess = excess, amiss, excess - amiss / slope
    return here


def _kept_apart(model: ConstrainedModel, targets: LineTargets, near: Equilibrium | None) -> Equilibrium:
    """Return the balance at the volumes that a control keeps in zones that are held separately."""
    exact = solve_exact(model, targets.ratios, _most_steps(near), near=near, turns=False)
    if targets.control in KEEPS_VOLUME or not exact.is_converged:
        return exact
    gain = targets.gain if targets.control == "conventional" else 0.0
    limit = OscillationLimit(model)
    found = limit.equilibrium(Potential(model, targets.ratios), exact, max(gain, _NO_GAIN))
    return replace(exact, residual=np.inf) if found is None else replace(found, residual=0.0)


def _excess(model: ConstrainedModel, near: Equilibrium) -> float:
    """Return what the volume has there beyond rest, in parts of it [1]."""
    return model.volume.volume(model.tensegric.expand(near.state.moved)) / model.volume.rest_volume - 1.0


def _most_steps(near: Equilibrium | None) -> int:
    return _FROM_REST if near is None else _QUICK


def oscillation_growth(
    model: ConstrainedModel, targets: LineTargets, balance: Equilibrium, span: int = _SPAN
) -> float:
    """Return by how much a small swing about ``balance`` grows in a turn [1]; 0 if there is none.

    That is what it does between one ``span`` of turns and the next.
    """
    outward = _pushed_out(model)
    push = outward * (PUSH / np.linalg.norm(outward, axis=1).max())
    pressure = _pressure_of(model, balance)
    start = SolverState(balance.state.moved + push, pressure, 0, balance.tensions)
    records = [measured for _, measured in iterate(model, lambda: targets, start, turns=2 * span + 2)]
    course = _course(records)
    if len(course) < 2 * span + 2 or not np.isfinite(course).all():
        return np.inf
    bend = course[:-2] - 2.0 * course[1:-1] + course[2:]
    early, late = np.linalg.norm(bend[:span]), np.linalg.norm(bend[span:])
    return float((late / early) ** (1.0 / span)) if late > 1e-12 else 0.0


def _pushed_out(model: ConstrainedModel) -> Points:
    """Return the way of a push, (f, 3): outward, or in and out by turns in zones that are held separately."""
    if not model.volume.separate:
        return model.rest_gradient
    signs = np.where(np.arange(model.volume.zones) % 2, -1.0, 1.0)
    return np.tensordot(signs, model.volume.zone_gradients(model.tensegric.rest), axes=1)


def _pressure_of(model: ConstrainedModel, balance: Equilibrium) -> Pressure:
    """Return the pressure of turns that stand at a balance, with the volume error there."""
    points = model.tensegric.expand(balance.state.moved)
    if model.volume.separate:
        pressure = model.state_pressure(balance.pressures)
        return replace(pressure, error=-model.zone_errors(points, pressure.value))
    missing = model.volume.rest_volume - float(model.volume.volume(points))
    return Pressure(float(balance.pressures[0]) / model.pressure_unit, missing / model.volume.rest_volume)


def _course(records: list[Record]) -> Floats:
    """Return what swings: volume error and lengths of lines in parts of their size, one row per turn."""
    course = np.array([(*(record.zones or (record.error,)), *record.lengths) for record in records])
    if len(course):
        lengths = slice(len(records[0].zones) or 1, None)
        course[:, lengths] /= course[0, lengths]
    return course
