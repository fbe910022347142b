"""Opposing constraints: forces of each constraint at equilibrium, and the most opposed pair.

Read off the balance that the run itself comes to rest at (ours): tensions and directions of lines, the
multiplier of the volume and its gradient. At the free points these forces and what the skin answers with add
up to nothing. Two lines seldom share a point, so angles are those between what the forces do to the skin,
which passes them on: they are taken with its compliance, the inverse of its stiffness at rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy import sparse
from scipy.sparse import linalg as sparse_linalg

from core.analysis.diagnosis.stability import equilibrium_for
from core.geometry.mesh import Floats, Points
from core.mechanics.banded_matrix import over_axes
from core.mechanics.force_units import newtons_per_unit
from core.mechanics.iteration import LineTargets
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium, SlidingSurface
from core.mechanics.potential import Evaluation, Potential
from core.pipeline.active_lines import LineGroup, active_line_groups
from core.pipeline.model_stages import line_targets
from core.pipeline.stages import RegionStages
from core.progress import Progress, quiet

OPPOSED = 100.0
"""Angle from which on two constraints count as pulling against each other [degrees]; ours."""

OUTSTANDING = 1.25
"""How many times as much as any other two they take from each other where a pair stands out [1]; ours."""

_STRIDE, _PRECISION = 0.25, 0.01
_NOTHING = 1e-6  # N


@dataclass(frozen=True, eq=False)
class ConstraintForce:
    """What one constraint does to the free points: that of ``lines``, linked ones together, or the volume.

    ``lines`` is empty for the volume. ``force`` (f, 3) [N]; ``newtons`` its sizes at all points, added up;
    ``sides`` its parts on the left and the right where the volume is held on each. ``to_volume`` [degrees] is
    its angle to the volume gradient: above 90 it takes volume away.
    """

    lines: tuple[str, ...]
    force: Points
    newtons: float
    to_volume: float
    sides: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class Opposition:
    """Two constraints that pull against each other.

    ``angle`` [degrees] between what they do to the skin; ``cancelled`` [N mm] is the work that one undoes of
    the other's.
    """

    one: ConstraintForce
    other: ConstraintForce
    angle: float
    cancelled: float


@dataclass(frozen=True, eq=False)
class ConstraintForces:
    """All constraints in a balance.

    ``share`` [1] is how far on the way from rest to the lengths that are set it lies: 1 where these can be
    balanced. ``oppositions`` begin with those that take most from each other; ``worst`` is the first if it
    stands out. ``skin`` [N] is what the skin answers with. Newtons rest on the design's tissue, an estimate.
    """

    share: float
    forces: tuple[ConstraintForce, ...]
    oppositions: tuple[Opposition, ...]
    skin: float

    @property
    def worst(self) -> Opposition | None:
        """Return the two that fight, or None if no pair stands out."""
        first, *others = self.oppositions or (None,)
        if first is None or first.angle < OPPOSED:
            return None
        return (
            first if all(first.cancelled >= OUTSTANDING * each.cancelled for each in others if each) else None
        )


def analyse(stages: RegionStages, progress: Progress = quiet) -> ConstraintForces:
    """Return what fights in a region, where its run comes to rest or at the last balance on the way there."""
    targets = line_targets(stages.design, stages)
    balance, share = _last_balance(stages, targets, progress)
    potential = Potential(stages.model, _between(targets, share).ratios)
    place = potential.at(balance.state.moved)
    newtons = newtons_per_unit(stages.model, stages.design.tissue_stiffness)
    passed_on = _Skin(stages.model, place, newtons)
    pulls = [
        passed_on.pull(names, newtons * force) for names, force in _lines(stages, potential, place, balance)
    ]
    volume = _volume(passed_on, place, newtons * balance.pressures)
    pulls += [volume] if stages.design.volume != "none" and volume.newtons > _NOTHING else []
    clashes = [passed_on.clash(one, other) for one, other in combinations(pulls, 2)]
    clashes = sorted((each for each in clashes if each.cancelled > 0.0), key=lambda each: -each.cancelled)
    return ConstraintForces(share, tuple(pulls), tuple(clashes), newtons * _added(place.inner))


class _Skin:
    """How the skin of a model passes forces on, in one place; ``newtons`` [N/mm] is a unit of stiffness."""

    def __init__(self, model: ConstrainedModel, place: Evaluation, newtons: float) -> None:
        self.model = model
        stiffness = sparse.csc_array(over_axes(model.tensegric.stiffness, len(model.tensegric.free)))
        self._solve = sparse_linalg.splu(newtons * stiffness).solve
        self._outward = model.volume.gradient(place.points)

    def pull(self, lines: tuple[str, ...], force: Points) -> ConstraintForce:
        """Return what a constraint with ``force`` (f, 3) [N] does."""
        return ConstraintForce(lines, force, _added(force), self._angle(force, self._outward))

    def clash(self, one: ConstraintForce, other: ConstraintForce) -> Opposition:
        """Return how two constraints stand to each other."""
        undone = -float(np.vdot(one.force, self._moves(other.force)))
        return Opposition(one, other, self._angle(one.force, other.force), undone)

    def _moves(self, force: Points) -> Points:
        """Return how a force moves the skin, both (f, 3) [N, mm]."""
        return np.asarray(self._solve(force.ravel())).reshape(-1, 3)

    def _angle(self, one: Points, other: Points) -> float:
        """Return the angle between what two forces do to the skin [degrees], 90 where one is nothing."""
        moves, others = self._moves(one), self._moves(other)
        sizes = float(np.sqrt(np.vdot(one, moves) * np.vdot(other, others)))
        if not sizes > 0.0:
            return 90.0
        return float(np.degrees(np.arccos(np.clip(np.vdot(one, others) / sizes, -1.0, 1.0))))


def _last_balance(
    stages: RegionStages, targets: LineTargets, progress: Progress
) -> tuple[Equilibrium, float]:
    """Return where a run rests, or the last balance on the way from rest, and its share of the way."""
    balance = equilibrium_for(stages, targets)
    if balance.is_converged:
        return balance, 1.0
    last, share, stride = equilibrium_for(stages, _between(targets, 0.0)), 0.0, _STRIDE
    while stride > _PRECISION and share < 1.0:
        progress("diagnosing", 0.0)
        further = min(share + stride, 1.0)
        there = equilibrium_for(stages, _between(targets, further), last)
        if there.is_converged:
            last, share = there, further
        else:
            stride /= 2.0
    return last, share


def _between(targets: LineTargets, share: float) -> LineTargets:
    return replace(targets, ratios=tuple(1.0 + share * (ratio - 1.0) for ratio in targets.ratios))


def _lines(
    stages: RegionStages, potential: Potential, place: Evaluation, balance: Equilibrium
) -> Iterator[tuple[LineGroup, Points]]:
    """Yield the force of each worn line that acts, linked ones together, in units of the model."""
    model = potential.model
    tension = potential.tape * potential.stretch(place.lengths)
    if len(balance.tensions):
        tension = tension + balance.tensions[model.owner]
    along = (tension / place.lengths)[:, None] * place.spans
    acts = SlidingSurface(model).across(place) if _slides(model) else None
    names = [line.name for line in model.lines]
    for together in active_line_groups(stages):
        owners = [names.index(name) for name in together]
        mine = np.isin(model.owner, owners)[:, None]
        force = -model.segments.sum(np.where(mine, along, 0.0))
        yield together, force if acts is None else acts(force).reshape(-1, 3)


def _slides(model: ConstrainedModel) -> bool:
    return model.options.line_contact == "sliding" and len(model.owner) > 0


def _volume(skin: _Skin, place: Evaluation, pressures: Floats) -> ConstraintForce:
    model = skin.model
    sides = pressures[:, None, None] * model.volume.zone_gradients(place.points)
    pull = skin.pull((), sides.sum(axis=0))
    if model.volume.closed or model.volume.separate or model.options.volume_of == "both":
        return pull
    # A point in the middle is pushed by both: its force goes to each by what it adds.
    left, right = np.linalg.norm(sides, axis=2)
    whole = np.linalg.norm(pull.force, axis=1)
    of_left = float((whole * left / np.maximum(left + right, 1e-300)).sum())
    return replace(pull, sides=(of_left, pull.newtons - of_left))


def _added(force: Points) -> float:
    return float(np.linalg.norm(force, axis=1).sum())
