"""Solutions of a model at other lengths of one line, from the original or from near ones."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from core.geometry.mesh import Floats, Points
from core.mechanics.elastic_lines import ElasticCurve, ElasticLines, FittedModel, fit_elastics
from core.mechanics.exact_solution import BodyChange, solve_body_exact, solve_exact, volume_gain
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium, energy_steps, sliding_steps
from core.mechanics.potential import Potential
from core.progress import Progress, quiet

_NEAR_ENOUGH = (
    1e-5  # largest unbalanced force over the mean stiffness [mm]: far less than lengths are told to
)
_ALIKE = 1e-5  # by how much the force of an elastic may be off its curve, in parts
_FEW_STEPS = 10  # three are the rule; where it takes more a shorter stride does better
_MORE = (
    1e-5  # volume that a body may gain or lose, in parts of the control mesh's: lengths are not told to less
)
_ROUNDS = 4  # two are the rule


@dataclass(frozen=True, eq=False)
class PathPoint:
    """An answer with the line at ``ratio`` [1]: the ``model`` and its exact ``balance``.

    Lines made of elastics pull as their curves say at ``elongations`` [1], by line; ``log_ea`` (e,) are the
    logarithms of their EA [N]. ``excess`` (k,) [mm^3] is what the control mesh has there beyond its volume.
    """

    ratio: float
    ratios: tuple[float, ...]
    model: ConstrainedModel
    balance: Equilibrium
    log_ea: Floats
    elongations: Mapping[str, float]
    excess: Floats

    @property
    def points(self) -> Points:
        """Return the control points, shape (n, 3) [mm]."""
        return self.model.tensegric.expand(self.balance.state.moved)

    def interpolate(self, other: PathPoint, share: float) -> PathPoint:
        """Return the place between two answers, or beyond, ``share`` of the way to the other."""

        def mix(a: Floats, b: Floats) -> Floats:
            return np.asarray(a + share * (b - a))

        one, two = self.balance, other.balance
        state = replace(one.state, moved=mix(one.state.moved, two.state.moved))
        balance = replace(one, state=state, multipliers=mix(one.multipliers, two.multipliers))
        log_ea, excess = mix(self.log_ea, other.log_ea), mix(self.excess, other.excess)
        return replace(self, balance=balance, log_ea=log_ea, excess=excess)


@dataclass(frozen=True, eq=False)
class PathSolver:
    """A ``model`` with ``set_`` ratios, one per line, of which those of the lines ``together`` are tried.

    ``elastics`` are those that worn lines are made of, by line: such a line has another stiffness at another
    length; ``newtons`` [N/mm] is one unit of the model's stiffness. ``body_change`` is told where the body
    itself keeps its volume. ``progress`` hears each answer.
    """

    model: ConstrainedModel
    set_: tuple[float, ...]
    together: Collection[int]
    elastics: Mapping[str, ElasticCurve]
    newtons: float
    own_stiffness: Mapping[str, float]
    progress: Progress = quiet
    body_change: BodyChange | None = None

    def solve_from_original(self, ratio: float) -> PathPoint | None:
        """Return the answer that rest leads to, or None if there is none."""
        ratios = self._with(ratio)
        solve = partial(self._solved, ratios=ratios)
        if self.elastics:
            return self._fitted(ratio, fit_elastics(self._wish(ratios), solve))
        balance = solve(self.model)
        return self._found(ratio, self.model, balance, np.zeros(0), {}) if balance.is_converged else None

    def solve_near(self, ratio: float, start: PathPoint) -> PathPoint | None:
        """Return the answer if a few steps lead there from ``start``."""
        ratios, here, excess = self._with(ratio), start.balance, start.excess
        enough = 0.0 if self.elastics else _NEAR_ENOUGH

        def solve(model: ConstrainedModel) -> Equilibrium:
            nonlocal here, excess
            here, excess = self._kept(model, ratios, here, excess, enough)
            return here

        if self.elastics:
            return self._fitted(ratio, fit_elastics(self._wish(ratios), solve, start.log_ea, _ALIKE))
        balance = solve(self.model)
        lost = balance.residual >= _NEAR_ENOUGH
        return None if lost else self._found(ratio, self.model, balance, start.log_ea, {})

    def _solved(self, model: ConstrainedModel, ratios: tuple[float, ...]) -> Equilibrium:
        if self.body_change is not None:
            return solve_body_exact(model, ratios, self.body_change)
        return solve_exact(model, ratios)

    def _kept(
        self,
        model: ConstrainedModel,
        ratios: tuple[float, ...],
        start: Equilibrium,
        excess: Floats,
        enough: float,
    ) -> tuple[Equilibrium, Floats]:
        """Return the balance that a few steps lead to with all volumes kept, and the excess that it needs.

        Where they lead to none its residual is infinite.
        """
        last = start
        for _ in range(_ROUNDS):
            found = self._steps(Potential(model, ratios, excess), last, enough)
            if found is None:
                break
            if self.body_change is None:
                return found, excess
            last, more = found, volume_gain(model, self.body_change, found)
            if np.abs(more).max() < _MORE * abs(model.volume.rest_volume):
                return found, excess
            excess = excess - more
        return replace(start, residual=np.inf), excess

    def _steps(self, potential: Potential, start: Equilibrium, enough: float) -> Equilibrium | None:
        model = potential.model
        slides = model.options.line_contact == "sliding" and len(model.owner) > 0
        steps = (sliding_steps if slides else energy_steps)(potential, start, _FEW_STEPS)
        return next((step for step in steps if step.is_converged or step.residual < enough), None)

    def _fitted(self, ratio: float, fitted: FittedModel) -> PathPoint | None:
        if not fitted.agreed:
            return None
        return self._found(ratio, fitted.model, fitted.balance, fitted.log_ea, fitted.elongations)

    def _found(
        self,
        ratio: float,
        model: ConstrainedModel,
        balance: Equilibrium,
        log_ea: Floats,
        elongations: Mapping[str, float],
    ) -> PathPoint:
        excess = np.zeros(model.volume.zones)
        if self.body_change is not None:
            excess = model.volume.zone_volumes(model.tensegric.expand(balance.state.moved)) - model.rest_zones
        return PathPoint(ratio, self._with(ratio), model, balance, log_ea, elongations, excess)

    def _wish(self, ratios: tuple[float, ...]) -> ElasticLines:
        named = {line.name: ratio for line, ratio in zip(self.model.lines, ratios, strict=True)}
        return ElasticLines(self.model, named, self.elastics, self.newtons, self.own_stiffness)

    def _with(self, ratio: float) -> tuple[float, ...]:
        self.progress("finding limits", 0.0)
        return tuple(ratio if at in self.together else set_ for at, set_ in enumerate(self.set_))
