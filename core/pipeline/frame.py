"""Frame: what is shown of a design, and how it is read off the runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from core.errors import UserError
from core.geometry.mesh import Points
from core.mechanics.convergence import Convergence
from core.mechanics.iteration import Observables, Record
from core.mechanics.solver_comparison import SolverComparison
from core.pipeline.build import Stages


@dataclass(frozen=True, eq=False)
class Frame:
    """What is shown: the moved part of the body and everything that is read off it.

    ``points`` and ``normals`` (r, 3) belong to the body's vertices ``stages.moving.vertices``;
    ``control_points`` (n, 3) [mm]; ``lengths`` [mm] of the lines' front parts; ``tracks`` the records of each
    run so far; ``exact_marks`` what the exact answer ends at; ``is_running`` whether turns are still being
    made; ``seconds`` spent on them since the design last changed, at turn ``changed_at``.
    """

    revision: int
    stages: Stages
    points: Points
    normals: Points
    control_points: Points
    lengths: Mapping[str, float]
    tracks: Mapping[str, tuple[Record, ...]]
    exact_marks: Observables
    verdict: Convergence
    error_ml: float
    marks: Observables
    is_running: bool
    seconds: float
    changed_at: int


@dataclass(frozen=True)
class Failure:
    """Why a design could not be turned into a frame; the last good frame still stands."""

    revision: int
    error: Exception

    @property
    def is_rejection(self) -> bool:
        """Whether the design itself cannot be solved, for a reason that the user can change; else the fault
        is in the program or the machine.
        """
        return isinstance(self.error, UserError)


def make_frame(revision: int, stages: Stages, comparison: SolverComparison, seconds: float = 0.0) -> Frame:
    """Reshape the body to the comparison's shown state and read everything off it."""
    control_points = stages.model.tensegric.expand(comparison.shown.moved)
    change = stages.model.volume.volume(control_points) - stages.model.volume.rest_volume
    shown = comparison.main or max(comparison.runs.values(), key=lambda run: run.changed_at)
    return Frame(
        revision,
        stages,
        *stages.shape(control_points),
        control_points,
        {line.name: line.length(control_points) for line in stages.model.lines},
        {control: tuple(run.records) for control, run in comparison.runs.items()},
        stages.watch(stages.model.tensegric.expand(comparison.exact.state.moved)),
        comparison.verdict,
        change / 1000.0,
        stages.watch(control_points),
        not comparison.is_finished,
        seconds,
        shown.changed_at,
    )
