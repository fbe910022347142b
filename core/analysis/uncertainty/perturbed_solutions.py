"""A design solved anew with knobs turned: what is sampled, and what landmarks are propagated with."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

from core.analysis.uncertainty.outputs import (
    Figures,
    Rested,
    Steps,
    figures_of,
    line_figures,
    measured_figures,
    rested,
    rested_figures,
    steps_of,
)
from core.analysis.uncertainty.parameters import Turned
from core.analysis.uncertainty.resting_solution import Resting, push_of, resting_answer
from core.deformation.tffd import deform
from core.garment.tension import line_tensions
from core.geometry.mesh import Points
from core.landmarks.manual import PlacedMark
from core.measurements.subject import subject_of
from core.measurements.table import reshaped, subject_at_rest
from core.pipeline.build import Stages, build, find

_KEPT = ("read scan", "find landmarks", "read template", "fit control mesh")
"""The stages that are slow to make and small to keep."""


@dataclass(frozen=True, eq=False)
class Tried:
    """A design solved: its ``stages``, control ``points`` (n, 3) and body ``places`` (m, 3) [mm]."""

    stages: Stages
    points: Points
    places: Points
    figures: Figures


class Trials:
    """Tries variations of the design of ``base``. What hangs on landmarks alone is kept for another design.

    ``former`` are the trials of one: of the same scan and landmarks they know what is needed here too.
    """

    def __init__(self, base: Stages, former: Trials | None = None) -> None:
        self.base = base
        self._known: dict[tuple[PlacedMark, ...], tuple[Stages, Rested]] = {}
        if former is not None and _alike(base, former.base) and self.steps == former.steps:
            self._known = former._known

    def __call__(self, turned: Turned, *, keep: bool = True) -> Tried:
        """Solve a variation and read it; ``keep`` for the next time what hangs on its landmarks alone.

        Raises the UserError of a stage that fails.
        """
        if self.bare:
            return self._unworn(turned)
        placed = turned.design.placed
        near, rest = self._known.get(placed, (self.base, None))
        stages = build(turned.design, near)
        rest = rest or rested(stages, self.steps)
        if keep and placed not in self._known:
            slim = {name: known for name, known in stages.memo.items() if name in _KEPT}
            self._known[placed] = replace(self.base, design=stages.design, memo=slim), rest
        if turned.skin:
            rest = rested(stages, self.steps, rest.subject, turned.skin)
        points = resting_answer(stages, self._push).answer.place.points
        ratios = {line.name: self.base.design.ratio(line.name) for line in stages.model.lines}
        figures = {
            **measured_figures(stages, self.steps, rest, points, turned.skin),
            **line_figures(stages, points, line_tensions(stages, points), ratios),
        }
        return Tried(stages, points, deform(stages.binding, points), figures)

    def _unworn(self, turned: Turned) -> Tried:
        """Read a body that wears nothing: the skin stays, so nothing is fitted and nothing solved."""
        marks = find(self.base.body, turned.design.placed)
        subject = replace(subject_of(self.base.body.calm, marks), down=self.steps.before)
        rest = rested(self.base, self.steps, subject, turned.skin)
        return Tried(self.base, self.points, self.base.body.mesh.vertices, rested_figures(rest))

    @property
    def bare(self) -> bool:
        """Whether no line is worn, so that the body stays as it is."""
        return not self.base.design.worn()

    @cached_property
    def figures(self) -> Figures:
        """The figures of lines and bust points where the run rests. Raises NoBalanceError."""
        return {} if self.bare else figures_of(self.base, self.points)

    @cached_property
    def rest(self) -> Rested:
        """The body at rest with its landmarks where they are."""
        return rested(self.base, self.steps)

    @cached_property
    def points(self) -> Points:
        """The control points where the run rests, shape (n, 3) [mm]. Raises NoBalanceError."""
        return self.resting.answer.place.points

    @cached_property
    def resting(self) -> Resting:
        """The balance that the run of the design comes to. Raises NoBalanceError."""
        return resting_answer(self.base, self._push)

    @cached_property
    def _push(self) -> float:
        """How the control answers missing volume: alike whatever is turned."""
        return push_of(self.base)

    @cached_property
    def steps(self) -> Steps:
        """How far under the breasts the under-bust is measured."""
        rest = subject_at_rest(self.base.body.calm, self.base.landmarks)
        return steps_of(rest, reshaped(rest, self.base, self.points))


def _alike(one: Stages, other: Stages) -> bool:
    return (
        one.body is other.body
        and one.control is other.control
        and one.design.placed == other.design.placed
        and one.design.own_measures == other.design.own_measures
    )
