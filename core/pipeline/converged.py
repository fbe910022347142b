"""A design solved to its rest as the window solves it, for views beside the one that is worked on."""

from __future__ import annotations

from core.blas_threads import one_blas_thread
from core.document.design import Design
from core.mechanics.solver_comparison import MOST_TURNS, SolverComparison
from core.pipeline.build import Stages, build
from core.pipeline.frame import Frame, make_frame
from core.pipeline.model_stages import line_targets
from core.progress import Progress, quiet


def converged_frame(design: Design, near: Stages, progress: Progress = quiet) -> Frame:
    """Return the frame at which the runs of a design rest; what it shares with ``near`` is not built again.

    Raises the UserError of the stage that fails, or Cancelled.
    """
    with one_blas_thread():
        stages = build(design, near, progress)
        change = stages.body_change if design.dense_volume else None
        comparison = SolverComparison(
            stages.model, line_targets(design, stages), stages.watch, change, stages.balance
        )
        turns = 0
        while not comparison.is_finished:
            progress("turns", min(turns / MOST_TURNS, 1.0))
            comparison.advance()
            turns += 1
        return make_frame(0, stages, comparison)
