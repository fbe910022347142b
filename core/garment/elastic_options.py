"""Elastic options: the effect of each elastic on a line, why one cannot be used, and the nearest that can."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np

from core.document.design import Design
from core.document.elastic import Elastic, ElasticError, OverstretchedError
from core.errors import LineError
from core.garment.cut_list import CutRow, cut_list
from core.garment.match_shape import (
    FULL,
    match_reached_lengths,
    reached_points,
    too_weak_error,
    with_line_ratios,
)
from core.garment.pressure import pressures
from core.garment.tension import line_tensions
from core.geometry.mesh import Points
from core.messages import EMPTY, LineName, Message
from core.pipeline.build import Stages, build

KEEP_FIT, KEEP_CUT = MODES = ("fit", "cut")
"""Keep the length on the body, for which the cut length is searched, or the cut length that is set."""

FIRST_STRETCH = 0.2
"""How far a band on points that do not move is stretched at first [1]: a start to go on from, no advice."""


@dataclass(frozen=True)
class Outcome:
    """A solved ``design`` with lines of elastic: its pieces to cut, by line.

    ``lift`` is how far the bust points are above those of the original body, mean of both [mm]. ``kpa`` are
    the largest contact pressures of the lines whose tension is known [kPa].
    """

    design: Design
    rows: Mapping[str, CutRow]
    lift: float
    kpa: Mapping[str, float]


@dataclass(frozen=True)
class ElasticOption:
    """An elastic, or none, for some lines, with its ``outcome`` where it can be used.

    Otherwise ``problem`` states why not, and ``closest`` is the outcome at the limit of this elastic, if it
    has one.
    """

    elastic: Elastic | None
    outcome: Outcome | None
    problem: LineError | None = None
    closest: Outcome | None = None

    @property
    def reason(self) -> Message:
        """Return why the elastic cannot be used, in one short sentence, or nothing."""
        problem = self.problem
        return problem.reason if isinstance(problem, ElasticError) else problem.text if problem else EMPTY


def elastic_option(stages: Stages, names: Sequence[str], elastic: Elastic | None, mode: str) -> ElasticOption:
    """Return what an elastic does for the lines ``names`` of a design, in the exact answer.

    ``mode`` is one of MODES; lines that are held keep their length in both. Lines on points that do not move
    become active with an elastic. Raises LineError if the design itself has no balance.
    """
    points = reached_points(stages)
    lines = {line.name: line for line in stages.model.lines}
    still = [name for name in names if not lines[name].constrains]
    moving = [name for name in names if name in stages.design.active_lines() and name not in still]
    made = _put_on(stages.design, names, elastic, still)
    held = stages.design.line_hold == "held"
    if elastic is not None and (held or mode == KEEP_FIT):
        refused = _refused(stages, points, moving, elastic)
        if refused is not None:
            return ElasticOption(elastic, None, refused)
    try:
        if moving and mode == KEEP_FIT and not held:
            found = match_reached_lengths(stages, points, dict.fromkeys(moving, elastic))
            # Through the door that a locked line keeps shut.
            made = reduce(lambda d, name: d.with_line(name, found.design.ratio(name)), moving, made)
            if found.excess and elastic is not None:
                name = max(found.excess, key=lambda each: found.excess[each])
                problem = too_weak_error(elastic, made.ratio(name), found.excess[name], name)
                return ElasticOption(elastic, None, problem, outcome_of(build(made, stages)))
        outcome = outcome_of(build(made, stages))
    except OverstretchedError as problem:
        return ElasticOption(elastic, None, problem, _at_limit(stages, made, names, elastic))
    except LineError as problem:
        return ElasticOption(elastic, None, problem)
    return _unless_slack(stages, outcome, elastic, names)


def outcome_of(stages: Stages) -> Outcome:
    """Return the outcome of a design, in its exact answer. Raises LineError if nothing balances."""
    points = reached_points(stages)
    rows = {row.line: row for row in cut_list(stages, points).rows}
    original, lifted = (
        float(np.mean(stages.watch.bust_points(each)[:, 2]))
        for each in (stages.control.mesh.vertices, points)
    )
    pressed = {name: band.largest for name, band in pressures(stages, points).items()}
    return Outcome(stages.design, rows, lifted - original, pressed)


def nearest(options: Iterable[ElasticOption], elastic: Elastic) -> ElasticOption | None:
    """Return the option that can be used whose elastic is most alike in strength and width, if any."""
    usable = [each for each in options if each.outcome is not None and each.elastic is not None]
    return min(usable, key=lambda each: _unlike(each.elastic or elastic, elastic), default=None)


def strongest(options: Iterable[ElasticOption], names: Collection[str]) -> ElasticOption | None:
    """Return the option that comes nearest at its limit, for lines for which none can be used."""
    limited = [(each.closest, each) for each in options if each.closest is not None]
    ranked = [
        (sum(closest.rows[name].reached_front_mm for name in names if name in closest.rows), each)
        for closest, each in limited
    ]
    return min(ranked, key=lambda each: each[0])[1] if ranked else None


def _unlike(one: Elastic, other: Elastic) -> float:
    strength = abs(math.log(one.max_force / other.max_force))
    return strength + abs(math.log(one.width_mm / other.width_mm))


def _put_on(design: Design, names: Iterable[str], elastic: Elastic | None, still: Collection[str]) -> Design:
    """Return the design with lines made of an elastic; with one bands on ``still`` points are active."""
    design = reduce(lambda made, name: made.with_elastic(name, elastic), names, design)
    for name in still:
        if bool(elastic) != (name in design.active_lines()):
            design = design.with_line(name, 1.0 / (1.0 + FIRST_STRETCH) if elastic else None)
    return design


def _refused(
    stages: Stages, points: Points, moving: Collection[str], elastic: Elastic
) -> ElasticError | None:
    """Return why an elastic cannot pull as lines do at ``points``, (n, 3) [mm], if that is seen there."""
    tensions = line_tensions(stages, points)
    held = stages.design.line_hold == "held"
    for name in moving:
        if tensions[name].compression:
            return _slack(stages, name)
        if held and tensions[name].tension > elastic.max_force:
            return elastic.overload_error(tensions[name].tension, LineName(name))
    return None


def _at_limit(
    stages: Stages, made: Design, names: Collection[str], elastic: Elastic | None
) -> Outcome | None:
    """Return the outcome with lines as little longer as an elastic needs that would be overstretched."""
    for _ in range(2 * len(names) + 2):
        try:
            return outcome_of(build(made, stages))
        except OverstretchedError as problem:
            if problem.line not in names or elastic is None:
                return None
            longer = (1.0 + problem.elongation) / (1.0 + FULL * elastic.max_elongation)
            made = with_line_ratios(made, {problem.line: made.ratio(problem.line) * longer})
    return None


def _unless_slack(
    stages: Stages, outcome: Outcome, elastic: Elastic | None, names: Collection[str]
) -> ElasticOption:
    slack = [name for name in names if name in outcome.rows and outcome.rows[name].slack]
    if slack and elastic is not None:
        return ElasticOption(elastic, None, _slack(stages, slack[0]))
    return ElasticOption(elastic, outcome)


def _slack(stages: Stages, name: str) -> ElasticError:
    """Return what to say of a line that is no shorter than the body there, with the length at which it is."""
    line = next(each for each in stages.model.lines if each.name == name)
    off = (
        reached_points(build(with_line_ratios(stages.design, {name: 1.0}), stages))
        if line.constrains
        else None
    )
    length = line.rest_length if off is None else line.length(off)
    percent = math.floor(100.0 * length / line.rest_length - 0.1)
    return ElasticError(
        Message("{line} is slack at this length (no tension).", line=LineName(name)),
        Message("Set {line} to {percent} % or less.", line=LineName(name), percent=f"{percent:.0f}"),
        Message("Slack at this length: set the line to {percent} % or less.", percent=f"{percent:.0f}"),
        LineName(name),
    )
