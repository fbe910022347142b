"""Turns: one sweep to local balance, then the volume and the lengths are measured and the forces refreshed.

Paper section 5 tells the turn in words; the equations are ours. What is unbalanced at the beginning of a turn
- cables, lines, volume force - moves the points as ``core.mechanics.gauss_seidel`` tells.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.model import ConstrainedModel
from core.mechanics.volume import Pressure, next_pressure

HELD_GROWTH = 0.1
"""What of a held line's pull for being too long stays in its tension after the turn [1]; ours."""


@dataclass(frozen=True)
class LineTargets:
    """All that can change while a run goes on: a ratio per line [1], volume control, gain [probe units]."""

    ratios: tuple[float, ...]
    control: str = "adaptive"
    gain: float = 1.5


@dataclass(frozen=True)
class Observables:
    """What is watched on the body: height and protrusion of the bust points and of the apex [mm]."""

    bust_point_left_z: float
    bust_point_right_z: float
    apex_z: float
    apex_protrusion: float
    bust_point_left_out: float
    bust_point_right_out: float


Watch = Callable[[Points], Observables]


@dataclass(frozen=True)
class Record:
    """The scalars of one turn: what plot, CSV and tests read.

    ``error`` is (V - V0) / V0 [1], negative when volume is missing; ``error_ml`` [ml]; ``step`` [mm] the
    largest move of a control point in this turn; ``lengths`` [mm] of the lines' front parts. Where zones are
    held separately ``zones`` are the shares of each in ``error``, less what it is to take up inside.
    """

    iteration: int
    error: float
    error_ml: float
    step: float
    lengths: tuple[float, ...]
    marks: Observables | None = None
    zones: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False)
class SolverState:
    """Where a run stands: displacements of the free points, shape (f, 3) [mm], and the turns made.

    ``pressure`` is that of the coming turn; ``tensions`` (lines,) [mm] those of lines whose length is held,
    0 for others.
    """

    moved: Points
    pressure: Pressure = field(default_factory=Pressure)
    iteration: int = 0
    tensions: Floats = field(default_factory=lambda: np.zeros(0))


def initial_state(model: ConstrainedModel) -> SolverState:
    """Return the state in which nothing has moved."""
    return SolverState(np.zeros((len(model.tensegric.free), 3)))


def record(model: ConstrainedModel, state: SolverState, step: float, watch: Watch | None = None) -> Record:
    """Measure a state."""
    points, zones = model.tensegric.expand(state.moved), ()
    if model.volume.separate:
        zones = tuple(model.zone_errors(points, state.pressure.value).tolist())
        change = sum(zones) * model.volume.rest_volume
    else:
        change = model.volume.volume(points) - model.volume.rest_volume
    return Record(
        state.iteration,
        change / model.volume.rest_volume,
        change / 1000.0,
        step,
        model.line_lengths(points),
        watch(points) if watch else None,
        zones,
    )


def step(
    model: ConstrainedModel, targets: LineTargets, state: SolverState, watch: Watch | None = None
) -> tuple[SolverState, Record]:
    """Make one turn: every point to its local balance, then measure, then refresh the forces.

    Source: paper section 5.
    """
    moved, volume = state.moved, model.volume
    spans, lengths = model.segments.spans(moved)
    natural, tensions = natural_lengths_for(model, targets, state, lengths)
    gradients = volume.zone_gradients(model.tensegric.expand(moved))
    outward = gradients.sum(axis=0)
    inner = model.tensegric.forces(moved)
    if targets.control != "none":
        inner += model.volume_force(state.pressure.value, gradients)
    line = -model.segments.gradient(spans, lengths, natural)
    shift = model.sweep_at(moved).solve(inner, line, outward)
    step = float(np.sqrt(np.max(np.einsum("ij,ij->i", shift, shift), initial=0.0)))
    after = SolverState(moved + shift, state.pressure, state.iteration + 1, tensions)
    measured = record(model, after, step, watch)
    missing = -np.array(measured.zones) if volume.separate else -measured.error
    pressure = next_pressure(targets.control, state.pressure, missing, targets.gain)
    return replace(after, pressure=pressure), measured


def natural_lengths_for(
    model: ConstrainedModel, targets: LineTargets, state: SolverState, lengths: Floats
) -> tuple[Floats, Floats]:
    """Return the natural lengths of the worn segments in the coming turn, (s,) [mm], and the lines' tensions.

    A spring has its own (paper section 3). A line whose length is held pulls with one tension all along and,
    while it is too long, as a spring of its tape besides; a part of that pull stays in the tension (the
    method of multipliers, damped: if all of it stayed the line would swing about its length for hundreds of
    turns; if it pulled harder short lines would run away; ours).
    """
    natural = model.natural_lengths(targets.ratios)
    if model.options.line_hold == "spring":
        slackens = model.options.tissue == "solid"
        return np.minimum(natural, lengths) if slackens else natural, state.tensions
    before = state.tensions if len(state.tensions) else np.zeros(len(model.lines))
    excess = model.tapes * model.sums(lengths - natural)
    pull = (before + excess)[model.owner]
    return lengths - pull / model.segments.stiffness, before + HELD_GROWTH * excess


def iterate(
    model: ConstrainedModel,
    targets: Callable[[], LineTargets],
    state: SolverState | None = None,
    *,
    turns: int,
    watch: Watch | None = None,
) -> Iterator[tuple[SolverState, Record]]:
    """Yield up to ``turns`` turns; not asking for the next one is how to stop."""
    state = initial_state(model) if state is None else state
    for _ in range(turns):
        state, measured = step(model, targets(), state, watch)
        yield state, measured
        if not np.isfinite(measured.error) or abs(measured.error) > 10.0:
            return
