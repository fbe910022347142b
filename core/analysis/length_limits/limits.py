"""Limits of a line length: strain, folding, oscillation, pressure and slack (ours).

The exact answer follows the line's length from rest to either end, each balance from the ones before it, and
what begins or ends between two of them is closed in on.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from core.analysis.length_limits.bracketing import bracket_spans
from core.analysis.length_limits.criteria import Criterion, elastic_criteria, model_criteria
from core.analysis.length_limits.line_search import PRECISION, RED, LineSearch
from core.analysis.length_limits.path_solutions import PathSolver
from core.analysis.length_limits.samples import Length, Span
from core.mechanics.constraint_lines import Line
from core.mechanics.force_units import newtons_per_unit
from core.mechanics.model import ConstrainedModel
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets
from core.progress import Progress, quiet

__all__ = ["PRECISION", "RED", "SIGNS", "Length", "Limits", "Span", "all_limits", "limits_from", "limits_of"]

SIGNS = ("strained", "overstrained", "folded", "inverted")
"""What the shape can show, as ``MeshQuality`` names it: from amber to nonsense."""


@dataclass(frozen=True, eq=False)
class Limits:
    """How far a line can go while all others stay as they are set.

    ``present`` is the line as it is set, None if it is off; ``beyond`` names those of SIGNS that this setting
    already shows. ``shows`` tells for each sign the lengths that show it, ascending, as far as was
    ``evaluated``: beside SIGNS there are "vibrating" (turns of the conventional control would), "restless"
    (those of any control would, where lines act one turn late), "slack" (the
    line pushes, which no band can), "pressing" (more than the red light begins with, if what it is made of
    tells the newtons) and "stretched" (an elastic would be stretched beyond its curve). ``rest`` is its
    length at rest, with the others as they are. ``last`` is the shortest and ``longest`` the longest length
    with a balance, None where there was one as far as was looked. ``found`` is False if there is none
    anywhere: the other lines ask for what cannot be. ``pressure_known`` tells whether pressure was looked at.
    """

    line: Line
    present: Length | None
    beyond: tuple[str, ...]
    shows: Mapping[str, tuple[Span, ...]]
    rest: Length | None
    evaluated: Span | None = None
    last: Length | None = None
    longest: Length | None = None
    found: bool = True
    pressure_known: bool = False

    @cached_property
    def onsets(self) -> dict[str, Length | None]:
        """Return the longest length that shows each of SIGNS, up to that at rest; None where none does.

        A beginning at the rest length is the other lines' doing.
        """
        return {sign: self.below(sign) for sign in SIGNS}

    @property
    def stretched(self) -> Length | None:
        """Return the length at which the elastic reaches the end of its curve, if it does."""
        return self.below("stretched")

    def below(self, sign: str) -> Length | None:
        """Return the longest length that shows ``sign``, up to that at rest, None if none does."""
        if self.rest is None:
            return None
        spans = [span for span in self.shows.get(sign, ()) if span.short.ratio <= self.rest.ratio]
        return min(spans[-1].long, self.rest, key=lambda length: length.ratio) if spans else None


def limits_from(
    model: ConstrainedModel,
    ratios: tuple[float, ...],
    name: str,
    partners: Collection[str] = (),
    progress: Progress = quiet,
) -> Limits:
    """Return the limits of the worn line ``name``, with ``ratios`` as set, one per line.

    ``partners`` are lines that share its length. ``progress`` hears each balance; raises Cancelled.
    """
    lines = [line.name for line in model.lines]
    together = {lines.index(name), *(lines.index(each) for each in partners)}
    ground = PathSolver(model, ratios, together, {}, 1.0, {}, progress)
    return _limits(ground, lines.index(name), model_criteria(model, together, None), through=True)


def limits_of(stages: Stages, name: str, progress: Progress = quiet, *, through: bool = True) -> Limits:
    """Return the limits of a line in its region, worn or not, the others being as they are set.

    A linked partner goes with it. Lines made of elastics pull as these do at each length. ``through``: go on
    where it is red, to tell all of SIGNS, and look at the line as it is set too. Raises Cancelled.
    """
    design = stages.design
    region, linked = design.region_of(name), design.linked_lines(name)
    both = tuple(each for each in linked if design.region_of(each) is region)
    worn = name in region.active_lines()
    tried = build(design.wearing(both), stages).region_of(name)
    design, model = tried.design, tried.model
    lines = [line.name for line in model.lines]
    together = {lines.index(each) for each in both}
    made = {} if design.line_hold == "held" else design.active_elastics()
    moving = {line.name: made[line.name] for line in model.lines if line.constrains and line.name in made}
    newtons = newtons_per_unit(model, design.tissue_stiffness)
    ratios = line_targets(design, tried).ratios
    keeps = tried.body_change if design.dense_volume else None
    ground = PathSolver(model, ratios, together, made, newtons, design.line_stiffnesses(), progress, keeps)
    looks = {**model_criteria(model, together, design.gain), **elastic_criteria(tried, both, moving)}
    limits = _limits(ground, lines.index(name), looks, through)
    return limits if worn else replace(limits, present=None, beyond=())


def all_limits(stages: Stages) -> Iterator[Limits]:
    """Yield the limits of each line that moves anything, worn or not, of the lower trunk of those worn.

    See ``limits_of``.
    """
    return (limits_of(stages, line.name) for line in stages.drawn_lines if line.constrains)


def _limits(ground: PathSolver, index: int, looks: Mapping[str, Criterion], through: bool) -> Limits:
    line, set_ = ground.model.lines[index], ground.set_[index]
    walk = LineSearch(ground, line, looks)
    present = walk.solve_at(set_) if through else None
    length = None if present is None else present.length
    beyond = tuple(sign for sign in SIGNS if present is not None and present.shows(sign))
    if not line.constrains:
        return Limits(line, length, beyond, {}, None)
    walk.run(set_, through)
    if not walk.stops:
        return Limits(line, length, beyond, {}, None, found=False)
    rest = min(walk.stops, key=lambda stop: abs(stop.length.ratio - 1.0)).length
    looked = Span(walk.stops[0].length, walk.stops[-1].length)
    shows = _within_curves({sign: bracket_spans(walk, sign) for sign in looks}, rest, looked)
    ends = looked, walk.last, walk.longest
    return Limits(line, length, beyond, shows, rest, *ends, pressure_known="pressing" in looks)


def _within_curves(
    shows: Mapping[str, tuple[Span, ...]], rest: Length, looked: Span
) -> Mapping[str, tuple[Span, ...]]:
    """Return what shows without what begins only at lengths that are refused: no curve tells of them."""
    ends = [span.long for span in shows.get("stretched", ()) if span.short is looked.short]
    if not ends or ends[0].ratio >= rest.ratio:
        return shows
    return {
        sign: tuple(span for span in spans if sign == "stretched" or span.long.ratio > ends[0].ratio)
        for sign, spans in shows.items()
    }
