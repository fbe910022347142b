"""Uncertainties of a solved design: a standard deviation for each value, and a range for its skin.

What is not known exactly is a number in ``resources/spread.json``; it is propagated to all figures by
derivatives (``linear_propagation``), or sampled by solving designs anew (``monte_carlo``).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from types import MappingProxyType

import numpy as np

from core.analysis.uncertainty.input_uncertainty import InputUncertainty, default_uncertainty
from core.analysis.uncertainty.linear_propagation import Effect, Propagation, effects
from core.analysis.uncertainty.lower_trunk import LowerPropagation, lower_effects
from core.analysis.uncertainty.model_error import model_errors
from core.analysis.uncertainty.parameters import (
    PLACING,
    Perturbed,
    UncertainParameter,
    uncertain_parameters,
    unmodelled_measurements,
)
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.blas_threads import one_blas_thread
from core.document.design import Design
from core.errors import UserError
from core.measurements.lower_measures import REPLACED
from core.measurements.uncertain_value import (
    AFTER,
    BEFORE,
    CHANGE,
    LANDMARKS,
    ROOT,
    SCAN,
    SOURCES,
    OutputUncertainties,
    Uncertainty,
)
from core.mechanics.options import CONTACTS
from core.messages import Message
from core.pipeline.build import Stages
from core.progress import Progress, quiet

SLIDING = Message(
    "Sliding lines respond less smoothly than ± assumes: on two bodies, only nine of ten samples of the "
    "lift were within ±, not 95 %, and some samples were far outside."
)

_REPLACED = frozenset(f"{kind}:{key}" for kind in (BEFORE, AFTER, CHANGE) for key in REPLACED)
"""Figures of the bust's own table that those of the lower trunk stand in for."""

LOWER_TRUNK = Message(
    "For waist, hips and seat ± does not include the error of the model itself: no reference was computed."
)

WAIST = Message(
    "The waist girth is measured at the narrowest level of the trunk. The girth of the anatomical waist "
    "may differ by several centimetres, which ± does not include."
)


class UncertaintyEstimator:
    """Finds how far the figures of a design may be off, the ``estimate_partial`` part, then the ``estimate``.

    Raises NoEquilibriumError where the design has no exact answer, and Cancelled.
    """

    def __init__(self, trials: PerturbedSolutions, sizes: InputUncertainty | None = None) -> None:
        self.trials, self.sizes = trials, sizes or default_uncertainty()
        self._found: list[Effect] = []
        self._failed = 0
        self._propagation: Propagation | None = None
        self._below: LowerPropagation | None = None

    def estimate_partial(self, progress: Progress = quiet) -> OutputUncertainties:
        """Return the spread by all sources but the landmarks, which are slow."""
        return self._by([knob for knob in self._knobs if knob.source != LANDMARKS], progress, marks=False)

    def estimate(self, progress: Progress = quiet) -> OutputUncertainties:
        """Return the spread by all sources, and the figures with the other skin contact."""
        if self._propagation is None:
            self.estimate_partial(progress)
        marks = [knob for knob in self._knobs if knob.source == LANDMARKS]
        whole = self._by([*marks, *([PLACING] if marks else [])], progress, marks=True)
        design = self.trials.base.design
        if self.trials.is_bare or design.tissue == "solid":  # there is but one contact
            return replace(whole, sources=SOURCES)
        progress("the other contact", 1.0)
        with one_blas_thread():
            contact, figures = _other_contact(self.trials)
        return replace(whole, sources=SOURCES, other=figures, contact=contact)

    @cached_property
    def _knobs(self) -> tuple[UncertainParameter, ...]:
        with one_blas_thread():
            return *uncertain_parameters(self.trials.base, self.sizes), *model_errors(self.trials, self.sizes)

    def _by(
        self, turning: Sequence[UncertainParameter], progress: Progress, *, marks: bool
    ) -> OutputUncertainties:
        with one_blas_thread():
            progress("propagating", 0.0)
            self._propagation = self._propagation or Propagation(self.trials)
            for at, effect in enumerate(effects(self._propagation, turning)):
                self._keep(effect, () if self.trials.whole.lower is None else _REPLACED)
                progress("propagating", (at + 1.0) / (len(turning) + 1.0))
            if self.trials.whole.lower is not None:
                self._below = self._below or LowerPropagation(self.trials.whole, self.sizes)
                for effect in lower_effects(self._below, landmarks=marks):
                    self._keep(effect)
                    progress("propagating", 1.0)
            found = _spread(self._propagation, self._found, self.sizes, self._failed)
            return found if self._below is None else _with_lower(found, self._below, self.trials.whole.design)

    def _keep(self, effect: Effect | None, replaced: Collection[str] = ()) -> None:
        """Keep the effect of a parameter, except on values that are ``replaced`` by others."""
        self._failed += effect is None
        if effect is not None:
            own = {key: step for key, step in effect.values.items() if key not in replaced}
            self._found.append(replace(effect, values=own))


def _with_lower(found: OutputUncertainties, below: LowerPropagation, design: Design) -> OutputUncertainties:
    """Return what may be off with the values of the lower trunk."""
    return replace(
        found,
        values=MappingProxyType({**found.values, **below.values}),
        bare=design.is_bare,
        cautions=(*(each for each in found.cautions if each is not WAIST), LOWER_TRUNK),
    )


def estimate_uncertainty(
    stages: Stages, sizes: InputUncertainty | None = None, progress: Progress = quiet
) -> OutputUncertainties:
    """Return how far the figures of a design may be off; see ``UncertaintyEstimator``."""
    return UncertaintyEstimator(PerturbedSolutions(stages), sizes).estimate(progress)


def cautions(design: Design, doubts: Mapping[str, object]) -> Iterator[Message]:
    """Yield where the ± of a design says less than it seems to, of the figures that have ``doubts``."""
    if f"{BEFORE}:waist_girth" in doubts:
        yield WAIST
    if design.active_lines() and design.line_contact == "sliding":
        yield SLIDING


def _other_contact(trials: PerturbedSolutions) -> tuple[str, Mapping[str, float]]:
    """Return the skin contact that a design has not, and its figures with that; none without an answer."""
    design = trials.base.design
    other = next(each for each in CONTACTS if each != design.line_contact)
    try:
        tried = trials(Perturbed(replace(design, line_contact=other)))
    except UserError:
        return other, MappingProxyType({})
    return other, MappingProxyType(tried.values)


def _spread(
    propagation: Propagation, found: list[Effect], sizes: InputUncertainty, failed: int
) -> OutputUncertainties:
    doubts: dict[str, dict[str, float]] = {}
    for effect in found:
        for key, step in effect.values.items():
            of_figure = doubts.setdefault(key, {})
            of_figure[effect.parameter.source] = np.hypot(of_figure.get(effect.parameter.source, 0.0), step)
    unsure = [
        f"{kind}:{key}"
        for kind in (BEFORE, AFTER)
        for key in unmodelled_measurements(propagation.stages.design)
    ]
    for key in unsure:
        doubts.pop(key, None)
    for key, sd in _of_roots(propagation, sizes).items():
        doubts.setdefault(key, {})[ROOT] = sd
    skin = sum((effect.skin**2 for effect in found), np.zeros(len(propagation.places)))
    sources = tuple(
        dict.fromkeys(effect.parameter.source for effect in found if effect.parameter.source != LANDMARKS)
    )
    told = {
        key: Uncertainty({name: float(sd) for name, sd in parts.items()}) for key, parts in doubts.items()
    }
    rest = next((effect.parameter.sd for effect in found if effect.parameter.source == SCAN), 0.0)
    return OutputUncertainties(
        by_output=MappingProxyType(told),
        skin=np.sqrt(skin),
        rest=rest,
        sds=sizes.sds,
        sources=sources,
        other=MappingProxyType({}),
        contact="",
        failed=failed,
        values=MappingProxyType(propagation.trials.values),
        bare=propagation.trials.is_bare,
        cautions=tuple(cautions(propagation.stages.design, doubts)),
    )


def _of_roots(propagation: Propagation, sizes: InputUncertainty) -> dict[str, float]:
    """Return what the top of the root, which no skin shows, makes of volumes, the same before and after."""
    before = propagation.trials.original.before
    return {
        f"{kind}:{key}": measure.plus_minus / 2.0
        for kind in (BEFORE, AFTER)
        for key, measure in before.items()
        if measure.plus_minus and measure.value is not None
    }
