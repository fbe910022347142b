"""Exact answers of a design at other lengths of its lines, each with how it moves with them (ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.analysis.inverse_design.quantities import ReadMany
from core.geometry.mesh import Floats, Points
from core.mechanics.exact_solution import NEWTON_LIMIT
from core.mechanics.mesh_quality import STRAINED_RANGE
from core.mechanics.newton import Equilibrium
from core.mechanics.sensitivity import Rates, Sensitivities
from core.mechanics.solver_comparison import shape_of
from core.pipeline.build import Stages
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import NoEquilibriumError, body_volume_rates, exact_solution

PERCENT = 0.01
"""Lengths are sought in percent of those at rest: figures then change by about a millimetre [1]."""

_SHARP = 2000.0  # of the smooth least margin: where ten edges strain alike it is 0.001 too careful

_KEPT = 200  # answers, so that a hand may drag for as long as it likes

_ALIKE = 1e-3  # two answers that are the same [mm]


@dataclass(frozen=True, eq=False)
class LinearizedSolution:
    """One exact answer: ``points`` (n, 3) [mm], and figures with their slopes by the p lengths [1 / %].

    ``values`` (m,) [mm] are what is asked for, ``tensions`` (lines,) the tension of each line in the model's
    unit, ``margins`` (e,) [1] how far edges are from straining beyond CALM_RANGE, negative where they do.
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

    ``read`` reads the figures that are looked at. Each answer begins near the one before, which is quicker,
    until ``is_reachable_from_original`` finds that rest leads elsewhere.
    """

    def __init__(self, stages: Stages, groups: Sequence[tuple[str, ...]], read: ReadMany) -> None:
        self._stages, self._read = stages, read
        names = [line.name for line in stages.model.lines]
        self._groups = [[names.index(name) for name in group] for group in groups]
        self._ratios = np.array(line_targets(stages.design, stages).ratios)
        rest = stages.model.sums(stages.model.tapes_at_rest)
        self._natural = np.zeros((len(names), len(groups)))
        for column, group in enumerate(self._groups):
            self._natural[group, column] = PERCENT * rest[group]
        self._edges = shape_of(stages.model)
        self._known: list[tuple[Floats, Equilibrium]] = []
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
            self._looks[key] = self._look(lengths, self._nearest(lengths), limit)
        return self._looks[key]

    def is_reachable_from_original(self, lengths: Floats) -> bool:
        """Return whether the original leads to ``lengths`` (p,) [%]; else all start at the solution.

        Under sliding lines there may be several equilibria; what a design is solved to is that from rest.
        """
        if not self._from_rest:
            before = self(lengths)
            try:
                there = self._look(lengths, None)
                self._from_rest = bool(np.abs(there.points - before.points).max() > _ALIKE)
            except NoEquilibriumError:
                self._from_rest = True
            if self._from_rest:
                self._looks.clear()
                self._known.clear()
                return False
        return True

    def _nearest(self, lengths: Floats) -> Equilibrium | None:
        if self._from_rest or not self._known:
            return None
        return min(self._known, key=lambda known: float(np.abs(known[0] - lengths).max()))[1]

    def _look(
        self, lengths: Floats, near: Equilibrium | None, limit: int = NEWTON_LIMIT
    ) -> LinearizedSolution:
        self._count += 1
        ratios = self._ratios.copy()
        for group, length in zip(self._groups, lengths, strict=True):
            ratios[group] = PERCENT * length
        answer = exact_solution(
            self._stages, tuple(ratios.tolist()), near, NEWTON_LIMIT if near is None else limit
        )
        self._known = [*self._known[-_KEPT:], (np.array(lengths), answer.balance)]
        points = answer.place.points
        rates = self._rates(answer)
        values, slopes = self._read(points)
        return LinearizedSolution(
            points,
            values,
            rates.of(slopes[:, self._stages.model.tensegric.free].reshape(len(values), -1)),
            *answer.tensions(rates, self._natural),
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
    """Return the control points, (n, 3) [mm], that a design is solved to. Raises NoEquilibriumError."""
    return exact_solution(stages).place.points
