"""Solve a model with every volume control at many lengths (paper section 5)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, islice

import numpy as np

from core.control_mesh.fit import ControlMesh
from core.geometry.mesh import Floats, Points
from core.mechanics.convergence import CONVERGED_STEP, Convergence, assess_convergence
from core.mechanics.exact_solution import solve_exact
from core.mechanics.gain_limit import gain_limit
from core.mechanics.iteration import LineTargets, Record, iterate
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.newton import Equilibrium
from core.mechanics.options import ModelOptions
from core.mechanics.solver_comparison import assess_equilibrium, shape_of
from core.pipeline.stages import GAIN_SHARE

TURNS = 300
"""Turns of every run that does not diverge before."""

RIPPLE_TURNS = 40
"""Last turns over which the ripple of the volume error is measured."""

LONGEST = 6000
"""Turns after which even an adaptive run that has not come to rest is left."""

_QUIET_TURNS = 5

GAINS = {"conventional": None, "conventional 1.5": 1.5, "conventional 2.0": 2.0}
"""The conventional gains that are tried, None for the default of the model [probe units]."""

TRIED_CONTROLS = ("none", *GAINS, "accumulating", "adaptive", "exact")
"""The volume controls that are tried, as they are named in a trial."""


@dataclass(frozen=True, eq=False)
class Subject:
    """A control mesh with the choices of its model and the name of the line that is worn on it."""

    name: str
    control: ControlMesh
    line: str
    mechanics: ModelOptions


@dataclass(frozen=True)
class Trial:
    """What came of one control at one length.

    ``ratio`` [1] is the natural length set over that at rest, ``reached`` [1] the length it came to;
    ``error``, ``ripple`` (peak to peak) and ``peak`` [1] are those of the volume error. ``calm_at`` and
    ``calmer_at`` are the turns from which on it stays below 0.1 % and 0.01 %, ``rest_at`` the turn at which
    nothing moves any more; None for never. ``away`` [mm] is how far the furthest control point ends from the
    exact answer, whose shape is ``folded``, ``inverted`` or ``overstrained``.
    """

    subject: str
    member_law: str
    line_force: str
    line_stiffness: float
    ratio: float
    control: str
    gain: float
    motion: str
    turns: int
    reached: float
    error: float
    ripple: float
    peak: float
    calm_at: int | None
    calmer_at: int | None
    rest_at: int | None
    away: float
    folded: bool
    inverted: bool
    overstrained: bool


def trials(subject: Subject, lengths: tuple[float, ...], controls: tuple[str, ...]) -> Iterator[Trial]:
    """Yield what comes of each of ``controls`` at each of ``lengths`` [1]."""
    model = constrained_model(subject.control, worn=[subject.line], mechanics=subject.mechanics)
    limit = gain_limit(model)
    for length in lengths:
        ratios = tuple(length if line.name == subject.line else 1.0 for line in model.lines)
        exact = solve_exact(model, ratios)
        for control in controls:
            yield _trial(subject, model, ratios, control, limit, exact)


def _trial(
    subject: Subject,
    model: ConstrainedModel,
    ratios: tuple[float, ...],
    control: str,
    limit: float,
    exact: Equilibrium,
) -> Trial:
    at = next(index for index, line in enumerate(model.lines) if line.name == subject.line)
    gain = GAINS.get(control) or GAIN_SHARE * limit
    targets = LineTargets(ratios, control.partition(" ")[0], gain)
    records, moved, rest_at, verdict = _outcome(model, targets, exact)
    errors = np.array([abs(record.error) for record in records] or [abs(verdict.error)])
    late = np.array([record.error for record in records[-RIPPLE_TURNS:]] or [0.0])
    shape = shape_of(model).quality(model.tensegric.expand(exact.state.moved))
    choices = subject.mechanics
    return Trial(
        subject.name,
        choices.member_law,
        choices.line_force,
        choices.line_stiffness,
        ratios[at],
        control,
        gain if control in GAINS else 0.0,
        verdict.motion,
        verdict.iterations,
        model.lines[at].length(model.tensegric.expand(moved)) / model.lines[at].rest_length,
        float(errors[-1]),
        float(np.ptp(late)),
        float(errors.max()),
        _stays_below(errors, 1e-3),
        _stays_below(errors, 1e-4),
        rest_at,
        _furthest(model, moved, exact.state.moved),
        shape.folded,
        shape.inverted,
        shape.overstrained,
    )


def _outcome(
    model: ConstrainedModel, targets: LineTargets, exact: Equilibrium
) -> tuple[list[Record], Points, int | None, Convergence]:
    """Return the records of a control, its last points, the iteration after which it rests, its verdict.

    The exact answer has no records: its steps are Newton's.
    """
    if targets.control == "exact":
        rest_at = exact.steps if exact.is_converged else None
        return [], exact.state.moved, rest_at, assess_equilibrium(model, exact)
    records, moved, rest_at = _run(model, targets)
    return records, moved, rest_at, assess_convergence(records)


def _run(model: ConstrainedModel, targets: LineTargets) -> tuple[list[Record], Points, int | None]:
    """Return the records of TURNS turns, where they end, and the turn at which nothing moves any more.

    An adaptive run is followed beyond its records until that turn.
    """
    run = iterate(model, lambda: targets, turns=LONGEST if targets.control == "adaptive" else TURNS)
    made = list(islice(run, TURNS))
    quiet, rest_at = 0, None
    for _, record in chain(made, run):
        quiet = quiet + 1 if record.step < CONVERGED_STEP else 0
        if quiet == _QUIET_TURNS:
            rest_at = record.iteration
            break
    return [record for _, record in made], made[-1][0].moved, rest_at


def _stays_below(errors: Floats, limit: float) -> int | None:
    """Return the turn, from 1, from which on all errors (n,) are below ``limit``; None if the last is not."""
    above = np.flatnonzero(~(errors < limit))
    first = int(above[-1]) + 2 if len(above) else 1
    return first if first <= len(errors) else None


def _furthest(model: ConstrainedModel, moved: Points, goal: Points) -> float:
    """Return the largest distance between two places of the free points (f, 3) [mm].

    Nothing holds a free body in its place: there it does not count where it has drifted and turned to.
    """
    one, other = (model.tensegric.rest[model.tensegric.free] + shift for shift in (moved, goal))
    if model.volume.closed and np.isfinite(one).all():
        one, other = one - one.mean(axis=0), other - other.mean(axis=0)
        left, _, right = np.linalg.svd(one.T @ other)
        one = one @ left @ right
    return float(np.linalg.norm(one - other, axis=1).max())
