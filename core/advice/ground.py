"""What a line is tried on: answers of a model at other lengths of one line, from rest or near others."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from core.exact import solve_exact
from core.mesh import Floats, Points
from core.model import ConstrainedModel
from core.progress import Progress, quiet
from core.solving.elastic_lines import ElasticLines, Fitted, Stretchy, fit_elastics
from core.solving.newton import Balance, energy_steps
from core.solving.potential import Potential
from core.solving.sliding import sliding_steps

_NEAR_ENOUGH = (
    1e-5  # largest unbalanced force over the mean stiffness [mm]: far less than lengths are told to
)
_ALIKE = 1e-5  # by how much the force of an elastic may be off its curve, in parts
_FEW_STEPS = 10  # three are the rule; where it takes more a shorter stride does better


@dataclass(frozen=True, eq=False)
class Found:
    """An answer with the line at ``ratio`` [1]: the ``model`` and its exact ``balance``.

    Lines made of elastics pull as their curves say at ``elongations`` [1], by line; ``log_ea`` (e,) are the
    logarithms of their EA [N].
    """

    ratio: float
    ratios: tuple[float, ...]
    model: ConstrainedModel
    balance: Balance
    log_ea: Floats
    elongations: Mapping[str, float]

    @property
    def points(self) -> Points:
        """The control points, shape (n, 3) [mm]."""
        return self.model.tensegric.expand(self.balance.state.moved)

    def mixed(self, other: Found, share: float) -> Found:
        """Return the place between two answers, or beyond, ``share`` of the way to the other."""

        def mix(a: Floats, b: Floats) -> Floats:
            return np.asarray(a + share * (b - a))

        one, two = self.balance, other.balance
        state = replace(one.state, moved=mix(one.state.moved, two.state.moved))
        balance = replace(one, state=state, multipliers=mix(one.multipliers, two.multipliers))
        return replace(self, balance=balance, log_ea=mix(self.log_ea, other.log_ea))


@dataclass(frozen=True, eq=False)
class Ground:
    """A ``model`` with ``set_`` ratios, one per line, of which those of the lines ``together`` are tried.

    ``elastics`` are those that worn lines are made of, by line: such a line has another stiffness at another
    length; ``newtons`` [N/mm] is one unit of the model's stiffness. ``progress`` hears each answer.
    """

    model: ConstrainedModel
    set_: tuple[float, ...]
    together: Collection[int]
    elastics: Mapping[str, Stretchy]
    newtons: float
    own_stiffness: Mapping[str, float]
    progress: Progress = quiet

    def from_rest(self, ratio: float) -> Found | None:
        """Return the answer that rest leads to, or None if there is none."""
        ratios = self._with(ratio)
        if self.elastics:
            return self._found(ratio, fit_elastics(self._wish(ratios), partial(solve_exact, ratios=ratios)))
        balance = solve_exact(self.model, ratios)
        return Found(ratio, ratios, self.model, balance, np.zeros(0), {}) if balance.found else None

    def near(self, ratio: float, start: Found) -> Found | None:
        """Return the answer if a few steps lead there from ``start``."""
        ratios, here = self._with(ratio), start.balance
        if not self.elastics:
            balance = self._steps(self.model, ratios, here, _NEAR_ENOUGH)
            if balance is None:
                return None
            return Found(ratio, ratios, self.model, balance, start.log_ea, {})

        def solve(model: ConstrainedModel) -> Balance:
            nonlocal here
            balance = self._steps(model, ratios, here)
            here = balance or replace(here, residual=np.inf)
            return here

        fitted = fit_elastics(self._wish(ratios), solve, start.log_ea, _ALIKE)
        return self._found(ratio, fitted)

    def _found(self, ratio: float, fitted: Fitted) -> Found | None:
        if not fitted.agreed:
            return None
        found = fitted.model, fitted.balance, fitted.log_ea, fitted.elongations
        return Found(ratio, self._with(ratio), *found)

    def _steps(
        self, model: ConstrainedModel, ratios: tuple[float, ...], start: Balance, enough: float = 0.0
    ) -> Balance | None:
        slides = model.mechanics.line_contact == "sliding" and len(model.owner) > 0
        steps = (sliding_steps if slides else energy_steps)(Potential(model, ratios), start, _FEW_STEPS)
        return next((step for step in steps if step.found or step.residual < enough), None)

    def _wish(self, ratios: tuple[float, ...]) -> ElasticLines:
        named = {line.name: ratio for line, ratio in zip(self.model.lines, ratios, strict=True)}
        return ElasticLines(self.model, named, self.elastics, self.newtons, self.own_stiffness)

    def _with(self, ratio: float) -> tuple[float, ...]:
        self.progress("finding limits", 0.0)
        return tuple(ratio if at in self.together else set_ for at, set_ in enumerate(self.set_))
