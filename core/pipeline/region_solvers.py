"""Solvers of the regions of one design, side by side."""

from __future__ import annotations

from core.mechanics.solver_comparison import SolverComparison
from core.pipeline.build import Stages
from core.pipeline.model_stages import line_targets
from core.pipeline.stages import RegionStages


class RegionSolvers:
    """The runs and the exact answer of each region: regions do not feel each other.

    ``bust`` is the comparison of the bust, ``lower`` that of the lower trunk, if there is one.
    """

    def __init__(self, stages: Stages) -> None:
        self._stages = stages
        self.bust = _comparison(stages)
        self.lower = None if stages.lower is None else _comparison(stages.lower)

    def retarget(self, stages: Stages, fresh: bool = False) -> None:
        """Take another design: a region on the same control mesh goes on from where it is, any other begins.

        ``fresh`` begins new records. Where there are two regions, one that nothing changes for is left alone.
        """
        old, self._stages = self._stages, stages
        self.bust = _retargeted(self.bust, old, stages, fresh, beside=stages.lower is not None)
        if stages.lower is None:
            self.lower = None
        elif self.lower is None or old.lower is None:
            self.lower = _comparison(stages.lower)
        else:
            self.lower = _retargeted(self.lower, old.lower, stages.lower, fresh, beside=True)

    @property
    def comparisons(self) -> tuple[SolverComparison, ...]:
        """Return those of the regions, as ``Stages.regions`` are."""
        return (self.bust,) if self.lower is None else (self.bust, self.lower)

    @property
    def is_finished(self) -> bool:
        """Return whether all rest."""
        return all(each.is_finished for each in self.comparisons)

    def advance(self) -> None:
        """Make one turn in each region that does not rest."""
        for each in self.comparisons:
            if not each.is_finished:
                each.advance()


def _comparison(stages: RegionStages) -> SolverComparison:
    change = stages.body_change if stages.design.dense_volume else None
    return SolverComparison(
        stages.model, line_targets(stages.design, stages), stages.watch, change, stages.balance
    )


def _retargeted(
    comparison: SolverComparison, old: RegionStages, stages: RegionStages, fresh: bool, *, beside: bool
) -> SolverComparison:
    same_body = old.control is stages.control and old.binding is stages.binding
    if not same_body or old.design.dense_volume != stages.design.dense_volume:
        return _comparison(stages)
    targets = line_targets(stages.design, stages)
    untouched = stages.model is comparison.model and targets == comparison.targets
    if fresh or not (beside and untouched):
        comparison.retarget(stages.model, targets, fresh, stages.balance)
    return comparison
