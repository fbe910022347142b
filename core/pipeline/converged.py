"""A design solved to its rest as the window solves it, for views beside the one that is worked on."""

from __future__ import annotations

from core.blas_threads import one_blas_thread
from core.document.design import Design
from core.mechanics.solver_comparison import most_turns
from core.pipeline.build import Stages, build
from core.pipeline.frame import Frame, make_frame
from core.pipeline.region_solvers import RegionSolvers
from core.progress import Progress, quiet


def converged_frame(design: Design, near: Stages, progress: Progress = quiet) -> Frame:
    """Return the frame at which the runs of a design rest; what it shares with ``near`` is not built again.

    Raises the UserError of the stage that fails, or Cancelled.
    """
    with one_blas_thread():
        stages = build(design, near, progress)
        solvers, turns = RegionSolvers(stages), 0
        most = max(most_turns(region.model) for region in stages.regions)
        while not solvers.is_finished:
            progress("turns", min(turns / most, 1.0))
            solvers.advance()
            turns += 1
        return make_frame(0, stages, solvers)
