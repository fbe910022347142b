"""Criteria of a line length: margins to strain, oscillation and pressure limits."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import partial
from types import MappingProxyType

import numpy as np

from core.analysis.length_limits.path_solutions import PathPoint
from core.document.elastic import Elastic
from core.document.lines import ActiveLine
from core.garment.band_path import band_paths
from core.garment.cut_list import is_strap
from core.garment.pressure import band_pressure, pressure_limits
from core.garment.tension import line_tensions
from core.mechanics.gain_limit import OscillationLimit, gain_limit
from core.mechanics.iteration import initial_state
from core.mechanics.mesh_quality import FOLD_LIMIT, STRAIN_RANGE, STRAINED_RANGE, MeshQuality
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import equilibrium_at
from core.mechanics.potential import Potential
from core.mechanics.solver_comparison import shape_of
from core.pipeline.stages import GAIN_SHARE, RegionStages

Criterion = Callable[[PathPoint], float]
"""How far an answer is from showing a sign; 0 or less where it does [1]."""

OF_SHAPE = ("strained", "overstrained", "folded", "inverted")
"""Signs of the shape alone, which are quick to look at."""

COSTLY = ("vibrating", "restless", "pressing")
"""Signs that take as long to look at as a balance takes to find."""

_CALM = 1.0  # of the margin where nothing can vibrate


def model_criteria(
    model: ConstrainedModel, together: Collection[int], gain: float | None
) -> dict[str, Criterion]:
    """Return what can be looked at on any model, by the sign that it is for.

    ``together`` are the lines that are tried; ``gain`` is the conventional one, None for the usual share of
    the limit at rest.
    """
    seen = _Last(shape_of(model).quality)
    looks: dict[str, Criterion] = {
        "strained": lambda found: _within(seen(found), STRAINED_RANGE),
        "overstrained": lambda found: _within(seen(found), STRAIN_RANGE),
        "folded": lambda found: seen(found).least_cosine - FOLD_LIMIT,
        "inverted": lambda found: seen(found).least_cosine,
        "vibrating": _Vibrating(gain).margin,
        "slack": partial(_pull, together=tuple(together)),
    }
    if model.options.line_force == "explicit":
        looks["restless"] = _rest
    return looks


def elastic_criteria(
    stages: RegionStages, names: Collection[str], elastics: Mapping[str, Elastic]
) -> dict[str, Criterion]:
    """Return what can be looked at because worn lines of a design are made of ``elastics``, by sign.

    ``names`` are the lines that are tried. Straps are not looked at for pressure, for which no limit is set,
    nor are lines of no elastic, whose newtons are estimates.
    """
    looks: dict[str, Criterion] = {}
    if elastics:
        looks["stretched"] = partial(_room_in_curves, elastics=elastics)
    known = [line.name for line in stages.model.lines if line.name in names and line.name in elastics]
    seen = [line.name for line in stages.model.lines if line.name in known and not is_strap(stages, line)]
    if seen:
        looks["pressing"] = partial(_pressing, stages=stages, names=tuple(seen))
    return looks


def _within(seen: MeshQuality, bounds: tuple[float, float]) -> float:
    return min(seen.shortest - bounds[0], bounds[1] - seen.longest)


@dataclass(eq=False)
class _Last:
    """The condition of the answer that was looked at last: four looks ask for it in a row."""

    condition: Callable[..., MeshQuality]
    found: PathPoint | None = None
    value: MeshQuality | None = None

    def __call__(self, found: PathPoint) -> MeshQuality:
        if self.value is None or found is not self.found:
            self.found, self.value = found, self.condition(found.points)
        return self.value


class _Vibrating:
    """Whether turns of the conventional control would swing where they come to."""

    def __init__(self, gain: float | None) -> None:
        self._gain = gain
        self._swing: tuple[ConstrainedModel, OscillationLimit, float] | None = None

    def margin(self, found: PathPoint) -> float:
        """Return by how much the gain limit there is above the gain, over the gain [1]."""
        if self._swing is None or found.model is not self._swing[0]:
            swing = OscillationLimit(found.model)
            gain = GAIN_SHARE * _limit_at_rest(found.model, swing) if self._gain is None else self._gain
            self._swing = found.model, swing, gain
        _, swing, gain = self._swing
        if gain <= 0.0:
            return _CALM
        potential = Potential(found.model, found.ratios)
        # A way of balances may turn back within a hair of one: the exact one is near enough then.
        there = swing.equilibrium(potential, found.balance, gain) or found.balance
        return min(swing.limit(potential, there) / gain - 1.0, _CALM)


def _rest(found: PathPoint) -> float:
    """Return how far turns are from a swing that no volume control ends; see ``OscillationLimit.overshoot``
    [1].
    """
    return 1.0 - 0.5 * OscillationLimit(found.model).overshoot(
        Potential(found.model, found.ratios), found.balance
    )


def _limit_at_rest(model: ConstrainedModel, swing: OscillationLimit) -> float:
    """Return what ``gain_limit`` does, six times quicker where there are no held lines."""
    if model.options.line_hold == "held":
        return gain_limit(model)  # which leaves out how their tensions change
    potential = Potential(model, (1.0,) * len(model.lines))
    return swing.limit(potential, equilibrium_at(potential, initial_state(model).moved))


def _pull(found: PathPoint, together: tuple[int, ...]) -> float:
    """Return how far the slackest tried line is stretched, over its rest length; negative: it pushes.

    Of a line on a solid, which pulls piece by piece, the piece that is stretched furthest tells.
    """
    model = found.model
    rest = [line.rest_length for line in model.lines]
    if model.options.line_hold == "held":
        held = found.balance.tensions
        return min(float(held[at] / model.tapes[at] / rest[at]) for at in together if model.tapes[at] > 0.0)
    if model.options.tissue == "solid":
        longer = model.segments.lengths(found.points) - model.natural_lengths(found.ratios)
        longer = longer / model.tapes_at_rest
        return min(float(longer[model.owner == at].max(initial=-np.inf)) for at in together)
    lengths = model.line_lengths(found.points)
    return min(lengths[at] / rest[at] - found.ratio for at in together)


def _room_in_curves(found: PathPoint, elastics: Mapping[str, Elastic]) -> float:
    """Return how much further the elastic can be stretched that is nearest to the end of its curve [1]."""
    return min(elastic.max_elongation - found.elongations[name] for name, elastic in elastics.items())


def _pressing(found: PathPoint, stages: RegionStages, names: tuple[str, ...]) -> float:
    """Return by how much the lines ``names`` press less than the red light begins with, over that [1]."""
    design = stages.design
    tried = {line.name: ratio for line, ratio in zip(found.model.lines, found.ratios, strict=True)}
    lines = tuple(ActiveLine(line.name, tried[line.name]) for line in design.lines)
    there = replace(stages, design=replace(design, lines=lines), model=found.model)
    tensions = line_tensions(there, found.points)
    of_these = MappingProxyType({name: tensions[name] for name in names})
    bands = [band_pressure(course, width) for _, course, width in band_paths(there, found.points, of_these)]
    return 1.0 - max(band.largest for band in bands) / pressure_limits().red_kpa
