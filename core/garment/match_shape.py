"""From lines as they are worn to lines of elastic that reach the same lengths, or come near to them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

import numpy as np

from core.document.design import Design
from core.document.elastic import Elastic, ElasticError, OverstretchedError
from core.errors import LineError
from core.garment.tension import line_tensions
from core.geometry.mesh import Floats, Points
from core.mechanics.constraint_lines import RATIO_LIMITS, Line
from core.mechanics.force_units import newtons_per_unit
from core.messages import ElasticName, Length, LineName, Message
from core.pipeline.build import Stages, build
from core.pipeline.solve import NoEquilibriumError, exact_equilibrium

PRECISION = 1e-5
"""By how much the lengths may differ that are reached before and after, in parts."""

FULL = 0.99
"""The part of its curve up to which an elastic is stretched at most: the body gives way a little later on."""

SHORT = 1e-3
"""A line that misses its length by more than this cannot reach it, in parts."""

_ROUNDS = 24
_ROOM = 0.9  # the part of an elastic's curve in which it is tried first
_LEAST, _MOST = 0.02, 2.0  # how a reached length is thought to follow the natural one, both in logarithms


@dataclass(frozen=True)
class MatchedDesign:
    """A ``design`` whose lines of elastic come as near as they can to the lengths that they shall reach.

    ``excess`` are those that stay too long, with by how much [mm].
    """

    design: Design
    excess: Mapping[str, float]


def reached_points(stages: Stages) -> Points:
    """Return the control points of the exact answer, (n, 3) [mm]. Raises LineError if nothing balances."""
    balance = exact_equilibrium(stages)
    if not balance.is_converged:
        raise NoEquilibriumError(stages.design)
    return stages.model.tensegric.expand(balance.state.moved)


def match_lengths(stages: Stages, control_points: Points, elastics: Mapping[str, Elastic | None]) -> Design:
    """Find the unstretched lengths at which lines of ``elastics`` keep their length on the body.

    ``control_points`` have the shape (n, 3) [mm]. Raises LineError if an elastic cannot reach a length.
    """
    found = match_reached_lengths(stages, control_points, elastics)
    for name, excess in found.excess.items():
        elastic = elastics[name]
        assert elastic is not None
        raise too_weak_error(elastic, found.design.ratio(name), excess, name)
    return found.design


def too_weak_error(elastic: Elastic, ratio: float, excess: float, line: str) -> ElasticError:
    """Return what to say of an elastic with which a line stays too long by ``excess`` [mm].

    ``ratio`` [1] is the shortest to which it can be cut.
    """
    limit = Message("at the maximum elongation, {reach} %", reach=f"{100.0 * elastic.max_elongation:g}")
    if ratio <= RATIO_LIMITS[0] + PRECISION:
        limit = Message("at the shortest cut length, {ratio} %", ratio=f"{100.0 * RATIO_LIMITS[0]:g}")
    return ElasticError(
        Message(
            "{name} is too weak for {line}: the line is {excess} too long {limit}.",
            name=ElasticName(elastic.name),
            line=LineName(line),
            excess=Length(excess, 1),
            limit=limit,
        ),
        Message("Make the line longer, or choose a stronger or wider elastic."),
        Message("Too weak: band {excess} too long {limit}.", excess=Length(excess, 1), limit=limit),
        LineName(line),
    )


def match_reached_lengths(
    stages: Stages, control_points: Points, elastics: Mapping[str, Elastic | None]
) -> MatchedDesign:
    """Return the design with worn lines made of ``elastics`` and cut so that they reach what they reach now.

    ``control_points`` (n, 3) [mm] are those of the design as it stands; None is no elastic, a line with the
    stiffness of the model. Where an elastic ends before, it is cut as short as it can be. A line on points
    that do not move keeps its ratio, and all of them where lengths are held. A linked pair stays one: both
    take the mean of what each side would need. Raises LineError where nothing balances.
    """
    design, lines = stages.design, {line.name: line for line in stages.model.lines}
    made = design
    for name, elastic in elastics.items():
        made = made.with_elastic(name, elastic)
    moving = {name: lines[name] for name in elastics if lines[name].constrains}
    if design.line_hold == "held" or not moving:
        return MatchedDesign(made, {})
    wanted = np.log([line.length(control_points) / line.rest_length for line in moving.values()])
    tensions = line_tensions(stages, control_points)
    stretch = [_stretch(stages, line, elastics[name], tensions[name].mean) for name, line in moving.items()]
    search = _Search(made, stages, moving, wanted)
    log_ratio, reached = search.run(wanted - np.log1p(stretch))
    found = search.at(log_ratio)
    rest = [line.rest_length for line in moving.values()]
    excess = rest * (np.exp(reached) - np.exp(wanted))
    short = np.exp(reached - wanted) - 1.0 > SHORT
    if np.any(reached - wanted < -SHORT) or any(short & [elastics[name] is None for name in moving]):
        raise LineError(
            Message(
                "No elastic length found at which {lines} reach the same lengths.",
                lines=", ".join(moving),
            ),
            Message("Make the lines longer, or choose stronger or wider elastics."),
        )
    pairs = {name: _shared(found, design.linked_lines(name), moving) for name in moving}
    missed = {name: float(each) for name, each, far in zip(moving, excess, short, strict=True) if far}
    return MatchedDesign(with_line_ratios(found, pairs), missed)


@dataclass
class _Search:
    """The search for the ratios at which ``lines`` of a ``made`` design reach what is ``wanted``.

    All are logarithms of parts of the length at rest, in the order of ``lines``.
    """

    made: Design
    stages: Stages
    lines: Mapping[str, Line]
    wanted: Floats

    def run(self, log_ratio: Floats) -> tuple[Floats, Floats]:
        """Return ratios and what is reached with them, beginning at some."""
        slope, before, step = np.full(len(log_ratio), 0.2), self.wanted, np.zeros(len(log_ratio))
        for _ in range(_ROUNDS):
            log_ratio, reached = self._tried(np.clip(log_ratio, *np.log(RATIO_LIMITS)))
            misfit = reached - self.wanted
            seen = np.abs(step) > 1e-12
            slope = np.where(seen, (misfit - before) / np.where(seen, step, 1.0), slope)
            slope = np.clip(slope, _LEAST, _MOST)
            shortest = np.maximum(reached - self._most(), np.log(RATIO_LIMITS[0]))
            following = np.clip(log_ratio - misfit / slope, shortest, np.log(RATIO_LIMITS[1]))
            before, step = misfit, following - log_ratio
            stays = (np.abs(step) < PRECISION) | (np.abs(misfit) < PRECISION)
            if stays.all():
                break
            log_ratio = following
        return log_ratio, reached

    def at(self, log_ratio: Floats) -> Design:
        """Return the design at these ratios."""
        return with_line_ratios(self.made, dict(zip(self.lines, np.exp(log_ratio).tolist(), strict=True)))

    def _most(self) -> Floats:
        """Return how far the lines may be stretched, in logarithms."""
        made = self.made.active_elastics()
        return np.log1p([FULL * made[name].max_elongation if name in made else np.inf for name in self.lines])

    def _tried(self, log_ratio: Floats) -> tuple[Floats, Floats]:
        """Return the ratios, longer where an elastic would be overstretched, and what is reached."""
        names = list(self.lines)
        for _ in range(_ROUNDS):
            try:
                return log_ratio, self._reached(log_ratio)
            except OverstretchedError as problem:
                if problem.line not in names:
                    raise
                at = names.index(problem.line)
                log_ratio = log_ratio.copy()
                log_ratio[at] += np.log1p(problem.elongation) - self._most()[at] + PRECISION
        return log_ratio, self._reached(log_ratio)

    def _reached(self, log_ratio: Floats) -> Floats:
        design = self.at(log_ratio)
        points = reached_points(build(design, self.stages))
        return np.log([line.length(points) / line.rest_length for line in self.lines.values()])


def _shared(made: Design, pair: tuple[str, ...], moving: Collection[str]) -> float:
    """Return the mean of both sides: set apart by a hair, a linked pair would be none any more."""
    ratios = [made.ratio(name) for name in pair if name in moving]
    return sum(ratios) / len(ratios)


def _stretch(stages: Stages, line: Line, elastic: Elastic | None, tension: float) -> float:
    """Return how far a line is stretched [1] by about the tension [N] that it has now."""
    if elastic is not None:
        return min(elastic.elongation(tension), _ROOM * elastic.max_elongation)
    design, model = stages.design, stages.model
    own = design.line_settings(line.name).stiffness
    per_mm = newtons_per_unit(model, design.tissue_stiffness) * model.tensegric.mean_stiffness
    ea = per_mm * (design.line_stiffness if own is None else own) * line.spacing
    return max(tension, 0.0) / ea


def with_line_ratios(design: Design, ratios: Mapping[str, float]) -> Design:
    """Return the design with worn lines at ``ratios`` [1], locked ones too."""
    lines = tuple(
        replace(line, ratio=ratios[line.name]) if line.name in ratios else line for line in design.lines
    )
    return replace(design, lines=lines)
