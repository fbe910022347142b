"""Frame: what is shown of a design, and how it is read off the runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.errors import UserError
from core.geometry.mesh import Points
from core.mechanics.convergence import Convergence, combined
from core.mechanics.iteration import Observables, Record
from core.mechanics.solver_comparison import SolverComparison
from core.pipeline.build import Stages
from core.pipeline.region_solvers import RegionSolvers
from core.pipeline.stages import RegionStages
from core.pipeline.zone_volumes import ZoneVolume, zone_volumes


@dataclass(frozen=True, eq=False)
class RegionFrame:
    """What is shown of one region.

    ``control_points`` (n, 3) [mm]; ``lengths`` [mm] of the lines' front parts, of closed lines all round;
    ``tracks`` the records of each run so far, and ``changed_at`` the turn at which the design last changed;
    ``zones`` the volumes of zones that are held separately.
    """

    stages: RegionStages
    control_points: Points
    lengths: Mapping[str, float]
    tracks: Mapping[str, tuple[Record, ...]]
    verdict: Convergence
    error_ml: float
    changed_at: int
    zones: tuple[ZoneVolume, ...]


@dataclass(frozen=True, eq=False)
class Frame:
    """What is shown: the moved part of the body and everything that is read off it.

    ``points`` and ``normals`` (r, 3) belong to the body's vertices ``stages.skin.vertices``;
    ``verdict`` and ``is_running``, whether turns are still being made, are those of all regions, and
    ``bust_verdict`` that of the bust.
    ``control_points``, ``lengths``, ``tracks``, ``error_ml`` and ``changed_at`` are those of the bust, see
    ``RegionFrame``, as are ``marks``, and ``exact_marks`` that the exact answer ends at. ``seconds`` were
    spent since the design last changed. ``lower`` is shown of the lower trunk, if there is that region.
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
    bust_verdict: Convergence
    error_ml: float
    marks: Observables
    is_running: bool
    seconds: float
    changed_at: int
    lower: RegionFrame | None = None

    @cached_property
    def vertices(self) -> Points:
        """Return the vertices of the whole body as it is shown, (n, 3) [mm]."""
        whole = np.array(self.stages.body.mesh.vertices)
        whole[self.stages.skin.vertices] = self.points
        return whole

    @property
    def line_lengths(self) -> Mapping[str, float]:
        """Return the lengths of the lines of all regions [mm]."""
        return self.lengths if self.lower is None else {**self.lengths, **self.lower.lengths}

    @property
    def region_points(self) -> tuple[Points, ...]:
        """Return the control points of each region, the bust's first, each (n, 3) [mm]."""
        return (self.control_points, *(each.control_points for each in [self.lower] if each))

    @property
    def all_points(self) -> Points:
        """Return the control points of all regions in one array, (n, 3) [mm]; see ``Stages.region_rows``."""
        return np.concatenate(self.region_points)


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


def make_frame(revision: int, stages: Stages, solvers: RegionSolvers, seconds: float = 0.0) -> Frame:
    """Reshape the body to the shown state of all regions and read everything off it."""
    shown = [
        _region(region, comparison)
        for region, comparison in zip(stages.regions, solvers.comparisons, strict=True)
    ]
    bust, lower = shown[0], shown[1] if len(shown) > 1 else None
    exact = stages.model.tensegric.expand(solvers.bust.exact.state.moved)
    return Frame(
        revision,
        stages,
        *stages.skin.shape([each.control_points for each in shown]),
        bust.control_points,
        bust.lengths,
        bust.tracks,
        stages.watch(exact),
        combined([each.verdict for each in shown]),
        bust.verdict,
        bust.error_ml,
        stages.watch(bust.control_points),
        not solvers.is_finished,
        seconds,
        bust.changed_at,
        lower,
    )


def _region(stages: RegionStages, comparison: SolverComparison) -> RegionFrame:
    control_points = stages.model.tensegric.expand(comparison.shown.moved)
    change = stages.model.volume.volume(control_points) - stages.model.volume.rest_volume
    run = comparison.main or max(comparison.runs.values(), key=lambda run: run.changed_at)
    return RegionFrame(
        stages,
        control_points,
        {line.name: line.length(control_points) for line in stages.model.lines},
        {control: tuple(run.records) for control, run in comparison.runs.items()},
        comparison.verdict,
        change / 1000.0,
        run.changed_at,
        zone_volumes(stages, comparison.shown),
    )
