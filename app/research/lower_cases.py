"""Solve the cases of the lower trunk: the waist line of the sample of a whole trunk, each case once."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.presenters.samples import WHOLE_TRUNK, sample_design
from app.rendering.ambient_occlusion import bake_occlusion
from app.research.case_memo import CaseMemo
from core.control_mesh.lower_template import HIP_ROW
from core.document.lower_trunk import LowerTrunk
from core.geometry.mesh import Flags, Floats
from core.mechanics.convergence import assess_convergence
from core.mechanics.exact_solution import solve_exact
from core.mechanics.gain_limit import OscillationLimit
from core.mechanics.iteration import Record, iterate
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium
from core.mechanics.potential import Potential
from core.mechanics.volume import volume_measure
from core.pipeline.build import Stages, build
from core.pipeline.lower_region import LowerStages
from core.pipeline.model_stages import line_targets

WAIST = "waist"
"""The line of the lower trunk that the figures and statements are about."""

RATIOS = (0.97, 0.9, 0.8)
"""Lengths at which its courses are shown, in parts of its rest length."""

TURNS = 200
"""Iterations shown: a swing just beyond the gain limit takes long to grow."""

LAST = 20
"""Iterations at the end over which a swing is measured."""


@dataclass(frozen=True, eq=False)
class Course:
    """What the iterations of one volume control come to, from rest on.

    ``zones`` (turns + 1, k) are the volume errors of the zones, each in % of the zone's own volume; ``away``
    (turns + 1,) [mm] is the largest distance of a control point from the exact solution; ``motion`` is one of
    ``convergence.MOTIONS``.
    """

    zones: Floats
    away: Floats
    motion: str

    @property
    def swings(self) -> Floats:
        """Return how far the zone that swings most flips about its mean at each iteration, (turns - 1,) [%].

        A quarter of the second difference: it shows a flip-flop in full, and a slow approach hardly at all.
        """
        return np.asarray(np.abs(np.diff(self.zones, 2, axis=0)).max(axis=1) / 4.0)


@dataclass(frozen=True, eq=False)
class LowerStudy(CaseMemo):
    """Keeps what has been built and solved of the lower trunk, by what was asked."""

    def _bare(self, kept: float) -> Stages:
        former = next((self.memo[key] for key in self.memo if key[0] == "bare"), None)
        design = replace(sample_design(WHOLE_TRUNK), lines=(), lower=LowerTrunk(waist_kept=kept))
        return self._once(("bare", kept), lambda: build(design, former))

    def stages(self, ratio: float, kept: float = LowerTrunk.waist_kept) -> LowerStages:
        """Return the stages with the waist line at a length ratio [1] and a share of volume kept [1]."""

        def make() -> LowerStages:
            bare = self._bare(kept)
            lower = build(bare.design.with_line(WAIST, ratio), bare).lower
            assert lower is not None, "the sample shows a whole trunk"
            return lower

        return self._once(("stages", ratio, kept), make)

    def occlusion(self) -> Floats:
        """Return how open the sky is above each vertex of the sample, for its pictures."""
        return self._once(("occlusion",), lambda: bake_occlusion(self.stages(RATIOS[0]).body.mesh))

    def exact(self, ratio: float) -> Equilibrium:
        """Return the exact solution with the waist line at a length ratio [1]."""
        stages = self.stages(ratio)
        return self._once(
            ("exact", ratio),
            lambda: solve_exact(stages.model, line_targets(stages.design, stages).ratios),
        )

    def gain_limit(self, ratio: float) -> float:
        """Return the conventional gain above which a run begins to swing where it comes to rest [1]."""

        def make() -> float:
            stages = self.stages(ratio)
            potential = Potential(stages.model, line_targets(stages.design, stages).ratios)
            oscillation, gain = OscillationLimit(stages.model), stages.gain_limit
            for _ in range(4):  # where it rests depends on the gain, but little
                resting = oscillation.equilibrium(potential, self.exact(ratio), gain)
                assert resting is not None, "the waist line has a balance under the conventional force"
                gain = oscillation.limit(potential, resting)
            return gain

        return self._once(("gain limit", ratio), make)

    def course(self, ratio: float, control: str, part: float = 1.0, turns: int = TURNS) -> Course:
        """Return a run from rest; the gain of the conventional control is ``part`` of ``gain_limit``."""

        def make() -> Course:
            stages, goal = self.stages(ratio), self.exact(ratio).state.moved
            asked = line_targets(stages.design, stages)
            targets = replace(asked, control=control, gain=part * self.gain_limit(ratio))
            away = [float(np.linalg.norm(goal, axis=1).max())]
            records: list[Record] = []
            for state, measured in iterate(stages.model, lambda: targets, turns=turns):
                away.append(float(np.linalg.norm(state.moved - goal, axis=1).max()))
                records.append(measured)
            shares = stages.model.volume.rest_volume / stages.model.rest_zones
            zones = 100.0 * shares * np.array([record.zones for record in records])
            at_rest = np.zeros((1, zones.shape[1]))
            motion = assess_convergence(records).motion
            return Course(np.concatenate([at_rest, zones]), np.array(away), motion)

        return self._once(("course", ratio, control, part, turns), make)

    def outward(self, ratio: float, *, together: bool) -> Floats:
        """Return how far each control point moves outward in the exact solution, (n,) [mm].

        All volume is kept: that of the whole trunk ``together``, else that of each zone.
        """

        def make() -> Floats:
            stages = self.stages(ratio, kept=1.0)
            model = _as_one_zone(stages) if together else stages.model
            balance = solve_exact(model, line_targets(stages.design, stages).ratios)
            moves = model.tensegric.expand(balance.state.moved) - stages.control.mesh.vertices
            return np.asarray((moves * stages.control.mesh.vertex_normals).sum(axis=1))

        return self._once(("outward", ratio, together), make)

    def at_seat(self) -> Flags:
        """Return which control points lie at the hip and below, (n,): some 25 cm below the waist."""
        return np.asarray(self.stages(RATIOS[0]).control.row >= HIP_ROW)


def _as_one_zone(stages: LowerStages) -> ConstrainedModel:
    """Return the model of the lower trunk with a single volume."""
    mesh = stages.control.mesh
    zone = np.zeros(len(mesh.faces), dtype=np.int64)
    return replace(stages.model, volume=volume_measure(mesh, stages.model.tensegric.free, zone, (1.0,)))
