"""The girth at the bust points: a figure that can be asked for (ours)."""

from __future__ import annotations

from core.analysis.inverse_design.bust_quantity import AXES, LIFT, BustPoints
from core.analysis.inverse_design.quantities import SIDES, Family, Reading
from core.geometry.mesh import Points
from core.pipeline.build import Stages
from core.pipeline.observables import Tapes

STEP = 5.0
"""Heights at which a tape is laid, to be read between them [mm]."""


class _Girth:
    """A tape laid level round the body at the mean height of the bust points, which it follows.

    It is laid at heights that are ``STEP`` apart and read between the two next to the bust points.
    """

    def __init__(self, stages: Stages) -> None:
        self._stages = stages
        self._rise = BustPoints(stages, SIDES[""][:, None] * AXES[LIFT])
        marks = stages.rest_marks
        self._rest_height = (marks.nipple_left_z + marks.nipple_right_z) / 2.0
        self._levels: dict[float, Tapes] = {}

    def __call__(self, control_points: Points) -> Reading:
        """Return the figure at control points, shape (n, 3) [mm]."""
        binding, moving = self._stages.binding, self._stages.moving
        places = binding.operator.added(binding.change(control_points), moving.rest)
        rise = self._rise(control_points)
        low, part = divmod((self._rest_height + rise.value) / STEP, 1.0)
        tapes = [self._tape(STEP * level) for level in (low, low + 1.0)]
        (below,), (above,) = (tape(places) for tape in tapes)
        (by_below,), (by_above,) = (tape.slopes(places) for tape in tapes)
        by_places = (1.0 - part) * by_below + part * by_above
        slopes = binding.pulled(control_points, by_places[: moving.count])
        steep = float(above - below) / STEP
        return Reading(float((1.0 - part) * below + part * above), slopes + steep * rise.slopes)

    def _tape(self, height: float) -> Tapes:
        if height not in self._levels:
            self._levels[height] = Tapes(self._stages.moving, [height])
        return self._levels[height]


GIRTH = "girth"
_TOLERANCE = 5.0  # a girth grows by 2 pi times what its outline moves by [mm]
GIRTHS = Family((GIRTH,), lambda stages, _: _Girth(stages), tolerance=_TOLERANCE)
"""The girth at the level of the bust points, as they are then [mm]."""
