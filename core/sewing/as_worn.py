"""From lines as they are worn to lines of elastic that reach the same lengths."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np

from core.answer import NoBalanceError, balance_of
from core.design import Design
from core.design_elastics import Elastic
from core.errors import LineError
from core.lines import RATIO_LIMITS, Line
from core.mesh import Floats, Points
from core.pipeline import Stages, build
from core.sewing.tensions import line_tensions
from core.solving.newtons import newtons_per_unit

PRECISION = 1e-5
"""By how much the lengths may differ that are reached before and after, in parts."""

_GOOD = 1e-3  # beyond this they are not the same
_ROUNDS = 12
_ROOM = 0.9  # the part of an elastic's curve in which it is tried first
_LEAST, _MOST = 0.02, 2.0  # how a reached length is thought to follow the natural one, both in logarithms


def made_as_worn(stages: Stages, elastics: Mapping[str, Elastic | None]) -> Design:
    """Return what ``as_worn`` does for the lengths of the exact answer, whatever control is shown.

    Raises LineError where an elastic cannot do it, or nothing balances.
    """
    return as_worn(stages, reached_points(stages), elastics)


def reached_points(stages: Stages) -> Points:
    """Return the control points of the exact answer, (n, 3) [mm]. Raises LineError if nothing balances."""
    balance = balance_of(stages)
    if not balance.found:
        raise NoBalanceError(stages.design)
    return stages.model.tensegric.expand(balance.state.moved)


def as_worn(stages: Stages, control_points: Points, elastics: Mapping[str, Elastic | None]) -> Design:
    """Return the design with worn lines made of ``elastics`` and cut so that they reach what they reach now.

    ``control_points`` (n, 3) [mm] are those of the design as it stands; None is no elastic, a line with the
    stiffness of the model. A line on points that do not move keeps its ratio, and all of them where lengths
    are held. A linked pair stays one: both take the mean of what each side would need. Raises LineError where
    an elastic cannot do it.
    """
    design, lines = stages.design, {line.name: line for line in stages.model.lines}
    made = design
    for name, elastic in elastics.items():
        made = made.with_elastic(name, elastic)
    moving = {name: lines[name] for name in elastics if lines[name].constrains}
    if design.line_hold == "held" or not moving:
        return made
    wanted = np.log([line.length(control_points) / line.rest_length for line in moving.values()])
    tensions = line_tensions(stages, control_points)
    stretch = [_stretch(stages, line, elastics[name], tensions[name].mean) for name, line in moving.items()]
    log_ratio = wanted - np.log1p(stretch)
    slope, before, step = np.full(len(moving), 0.2), wanted, np.zeros(len(moving))
    for _ in range(_ROUNDS):
        tried = _at(made, dict(zip(moving, np.exp(log_ratio).tolist(), strict=True)))
        misfit = _reached(tried, stages, moving) - wanted
        if np.abs(misfit).max() < PRECISION:
            break
        seen = np.abs(step) > 1e-12
        slope = np.where(seen, (misfit - before) / np.where(seen, step, 1.0), slope)
        before, step = misfit, -misfit / np.clip(slope, _LEAST, _MOST)
        log_ratio = log_ratio + step
    if np.abs(misfit).max() > _GOOD:
        raise LineError(
            f"No length of elastic was found with which {', '.join(moving)} would reach the same.",
            "Let the lines be longer, or take stronger or wider elastics.",
        )
    return _at(tried, {name: _shared(tried, design.linked(name), moving) for name in moving})


def _shared(made: Design, pair: tuple[str, ...], moving: Collection[str]) -> float:
    """Return the mean of both sides: set apart by a hair, a linked pair would be none any more."""
    ratios = [made.ratio(name) for name in pair if name in moving]
    return sum(ratios) / len(ratios)


def _stretch(stages: Stages, line: Line, elastic: Elastic | None, tension: float) -> float:
    """Return how far a line is stretched [1] by about the tension [N] that it has now."""
    if elastic is not None:
        return min(elastic.elongation(tension), _ROOM * elastic.reach)
    design, model = stages.design, stages.model
    own = design.traits_of(line.name).stiffness
    per_mm = newtons_per_unit(model, design.tissue_stiffness) * model.tensegric.mean_stiffness
    ea = per_mm * (design.line_stiffness if own is None else own) * line.spacing
    return max(tension, 0.0) / ea


def _at(design: Design, ratios: Mapping[str, float]) -> Design:
    low, high = RATIO_LIMITS
    for name, ratio in ratios.items():
        if not low <= ratio <= high:
            raise LineError(
                f"To reach the same, {name} would have to be cut to {100.0 * ratio:.0f} % of its length.",
                "Let the line be longer, or take a stronger or wider elastic.",
            )
    lines = tuple(
        replace(line, ratio=ratios[line.name]) if line.name in ratios else line for line in design.lines
    )
    return replace(design, lines=lines)


def _reached(design: Design, stages: Stages, lines: Mapping[str, Line]) -> Floats:
    """Return the logarithms of the lengths that lines reach over those at rest, in the exact answer."""
    built = build(design, stages)
    balance = balance_of(built)
    points = built.model.tensegric.expand(balance.state.moved)
    return np.log([line.length(points) / line.rest_length for line in lines.values()])
