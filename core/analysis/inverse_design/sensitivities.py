"""Exact answers of a design at other lengths of its lines, each with how it moves with them (ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.analysis.inverse_design.quantity import ReadMany
from core.geometry.mesh import Floats, Indices, Points
from core.mechanics.exact_solution import NEWTON_LIMIT
from core.mechanics.force_units import newtons_per_unit
from core.mechanics.mesh_quality import STRAINED_RANGE
from core.mechanics.newton import Equilibrium
from core.mechanics.sensitivity import Rates, Sensitivities
from core.mechanics.solver_comparison import shape_of
from core.pipeline.build import Stages
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import NoEquilibriumError, body_volume_rates, exact_solution
from core.pipeline.stages import RegionStages

PERCENT = 0.01
"""Lengths are sought in percent of those at rest: figures then change by about a millimetre [1]."""

_SHARP = 2000.0  # of the smooth least margin: where ten edges strain alike it is 0.001 too careful

_KEPT = 200  # answers, so that a hand may drag for as long as it likes

_ALIKE = 1e-3  # two answers that are the same [mm]


@dataclass(frozen=True, eq=False)
class LinearizedSolution:
    """One exact answer: ``points`` (n, 3) [mm], and figures with their slopes by the p lengths [1 / %].

    ``points`` are the control points of all regions, the bust's first. ``values`` (m,) [mm] are what is asked
    for, ``tensions`` (lines,) [N] those of the lines of all regions, ``margins`` (e,) [1] how far edges are
    from straining beyond CALM_RANGE, negative where they do.
    """

    points: Points
    values: Floats
    by_values: Floats
    tensions: Floats
    by_tensions: Floats
    margins: Floats
    by_margins: Floats

    def least_margin(self) -> tuple[float, Floats]:
        """Return about the least of the margins, so that it is smooth, and its slopes, shape (p,)."""
        least = self.margins.min()
        share = np.exp(_SHARP * (least - self.margins))
        return float(least - np.log(share.sum()) / _SHARP), share @ self.by_margins / share.sum()


class LinearizedSolutions:
    """Worked out on demand and kept: those of a design whose ``groups`` of lines change together.

    ``read`` reads the figures that are looked at, off the control points of all regions. Each answer begins
    near the one before, which is quicker, until ``is_reachable_from_original`` finds that rest leads
    elsewhere.
    """

    def __init__(self, stages: Stages, groups: Sequence[tuple[str, ...]], read: ReadMany) -> None:
        self._read = read
        self._regions = [_RegionAnswers(region, groups) for region in stages.regions]
        self._from_rest = False
        self._looks: dict[bytes, LinearizedSolution] = {}
        self._count = 0

    def __len__(self) -> int:
        """Return the number of answers that were worked out."""
        return self._count

    def __call__(self, lengths: Floats, limit: int = NEWTON_LIMIT) -> LinearizedSolution:
        """Return the exact answer at ``lengths``, one a group, shape (p,) [%]. Raises NoEquilibriumError."""
        key = np.asarray(lengths, dtype=np.float64).tobytes()
        if key not in self._looks:
            while len(self._looks) >= _KEPT:
                del self._looks[next(iter(self._looks))]
            self._looks[key] = self._look(lengths, limit, from_rest=self._from_rest)
        return self._looks[key]

    def is_reachable_from_original(self, lengths: Floats) -> bool:
        """Return whether the original leads to ``lengths`` (p,) [%]; else all start at the solution.

        Under sliding lines there may be several equilibria; what a design is solved to is that from rest.
        """
        if not self._from_rest:
            before = self(lengths)
            try:
                there = self._look(lengths, NEWTON_LIMIT, from_rest=True)
                self._from_rest = bool(np.abs(there.points - before.points).max() > _ALIKE)
            except NoEquilibriumError:
                self._from_rest = True
            if self._from_rest:
                self._looks.clear()
                for region in self._regions:
                    region.forget()
                return False
        return True

    def _look(self, lengths: Floats, limit: int, *, from_rest: bool) -> LinearizedSolution:
        self._count += 1
        found = [region.answer(lengths, limit, from_rest=from_rest) for region in self._regions]
        points = np.concatenate([each.points for each in found])
        values, slopes = self._read(points)
        at = np.cumsum([0, *(len(each.points) for each in found)])
        of_points = zip(found, at, at[1:], strict=False)
        by_values = sum(
            each.rates.of(slopes[:, begin:end][:, each.free].reshape(len(values), -1))
            for each, begin, end in of_points
        )
        return LinearizedSolution(
            points,
            values,
            np.asarray(by_values),
            np.concatenate([each.tensions for each in found]),
            np.concatenate([each.by_tensions for each in found]),
            np.concatenate([each.margins for each in found]),
            np.concatenate([each.by_margins for each in found]),
        )


@dataclass(frozen=True, eq=False)
class _RegionAnswer:
    """What one region answers: see ``LinearizedSolution``; ``rates`` are those of its ``free`` points."""

    points: Points
    free: Indices
    rates: Rates
    tensions: Floats
    by_tensions: Floats
    margins: Floats
    by_margins: Floats


class _RegionAnswers:
    """The exact answers of one region at lengths of ``groups`` of lines, of which other regions have some."""

    def __init__(self, stages: RegionStages, groups: Sequence[tuple[str, ...]]) -> None:
        self._stages = stages
        names = [line.name for line in stages.model.lines]
        self._groups = [[names.index(name) for name in group if name in names] for group in groups]
        self._ratios = np.array(line_targets(stages.design, stages).ratios)
        rest = stages.model.sums(stages.model.tapes_at_rest)
        self._natural = np.zeros((len(names), len(groups)))
        for column, group in enumerate(self._groups):
            self._natural[group, column] = PERCENT * rest[group]
        self._edges = shape_of(stages.model)
        self._newtons = newtons_per_unit(stages.model, stages.design.tissue_stiffness)
        self._known: list[tuple[Floats, Equilibrium]] = []
        self._last: tuple[Floats, _RegionAnswer] | None = None

    def forget(self) -> None:
        """Begin no answer near one of before."""
        self._known.clear()
        self._last = None

    def answer(self, lengths: Floats, limit: int, *, from_rest: bool) -> _RegionAnswer:
        """Return the exact answer at ``lengths`` (p,) [%]. Raises NoEquilibriumError."""
        own = np.array([length for group, length in zip(self._groups, lengths, strict=True) if group])
        if self._last is not None and not from_rest and np.array_equal(self._last[0], own):
            return self._last[1]  # nothing but another region changes
        near = None if from_rest else self._nearest(own)
        found = self._solved(own, near, NEWTON_LIMIT if near is None else limit)
        self._last = own, found
        return found

    def _nearest(self, own: Floats) -> Equilibrium | None:
        if not self._known:
            return None
        return min(self._known, key=lambda known: float(np.abs(known[0] - own).max(initial=0.0)))[1]

    def _solved(self, own: Floats, near: Equilibrium | None, limit: int) -> _RegionAnswer:
        ratios = self._ratios.copy()
        for group, length in zip(filter(None, self._groups), own, strict=True):
            ratios[group] = PERCENT * length
        answer = exact_solution(self._stages, tuple(ratios.tolist()), near, limit)
        self._known = [*self._known[-_KEPT:], (own, answer.balance)]
        points, rates = answer.place.points, self._rates(answer)
        tensions, by_tensions = answer.tensions(rates, self._natural)
        return _RegionAnswer(
            points,
            self._stages.model.tensegric.free,
            rates,
            self._newtons * tensions,
            self._newtons * by_tensions,
            *self._margins(points, rates),
        )

    def _rates(self, answer: Sensitivities) -> Rates:
        """Return the rates by the lengths of the groups, in percent. Raises NoEquilibriumError."""
        stages = self._stages
        try:
            rates = answer.by_ratio(np.arange(len(stages.model.lines))).summed(self._groups, PERCENT)
        except ValueError as unbounded:
            raise NoEquilibriumError(stages.design) from unbounded
        return body_volume_rates(stages, answer)(rates)

    def _margins(self, points: Points, rates: Rates) -> tuple[Floats, Floats]:
        """Return how far the edges are from straining, long or short, and the slopes by the lengths."""
        shape, free = self._edges, self._stages.model.tensegric.free
        moved = np.zeros((*points.shape, rates.moved.shape[1]))
        moved[free] = rates.moved.reshape(len(free), 3, -1)
        spans, rest, by = (
            at[shape.edges[:, 0]] - at[shape.edges[:, 1]] for at in (points, shape.rest, moved)
        )
        long, at_rest = np.linalg.norm(spans, axis=1), np.linalg.norm(rest, axis=1)
        ratios, by_ratios = long / at_rest, np.einsum("ei,eip->ep", spans / (long * at_rest)[:, None], by)
        low, high = STRAINED_RANGE
        return np.concatenate([ratios - low, high - ratios]), np.concatenate([by_ratios, -by_ratios])


def exact_points(stages: Stages) -> Points:
    """Return the control points of all regions, (n, 3) [mm], that a design is solved to.

    Raises NoEquilibriumError.
    """
    return np.concatenate([exact_solution(region).place.points for region in stages.regions])
