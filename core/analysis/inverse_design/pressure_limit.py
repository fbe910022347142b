"""The limit of contact pressure in a search for lengths: how hard each line may pull for it (ours)."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from core.analysis.inverse_design.sensitivities import LinearizedSolution
from core.document.design import Design
from core.garment.cut_list import is_strap
from core.garment.pressure import pressure_limits, pressures
from core.garment.tension import line_tensions
from core.geometry.mesh import Points
from core.pipeline.build import Stages

_AIM, _KEPT = (
    1.03,
    1.015,
)  # so far below the limit: one that is reached is the next light, and a run ends beside

_SAME, _LEAST = 1e-3, 0.3  # a change of tension that tells nothing, and the least part that is kept at once


class PressureLimit:
    """Bounds tensions, as a pressure follows from the shape that a band lies on.

    ``kpa`` is the limit; where ``most_kpa`` is None that is where the red light begins, for lines made of
    elastic that are no straps. One that is given holds for all lines, estimated pressures included.
    ``pressure`` [kPa] is the largest of each line that was computed, ``hardest`` what lines may pull with
    [N].
    """

    def __init__(self, design: Design, most_kpa: float | None) -> None:
        self.kpa = pressure_limits().red_kpa if most_kpa is None else most_kpa
        self._elastics = () if design.line_hold == "held" else tuple(design.active_elastics())
        self._every = most_kpa is not None
        self.hardest: dict[str, float] = {}
        self._seen: dict[str, tuple[float, float]] = {}
        self.pressure: dict[str, float] = {}

    def clear(self) -> None:
        """Forget what was computed for another question."""
        self.hardest, self._seen, self.pressure = {}, {}, {}

    @property
    def applies(self) -> bool:
        """Return whether any line has to keep to the limit."""
        return self._every or bool(self._elastics)

    def is_satisfied(
        self, stages: Stages, look: LinearizedSolution, free: Collection[str], *, firm: bool = False
    ) -> bool:
        """Compute what lines press with; limit what those of the ``free`` ones may pull that press too much.

        Tell whether none of them does. Unless ``firm``, a limit of before may turn out to have been too low.
        """
        self.pressure = self._limited(stages, look.points)
        pulls = {line.name: float(pull) for line, pull in zip(stages.lines, look.tensions, strict=True)}
        for name in self.pressure.keys() & set(free):
            kpa, before = self.pressure[name], self.hardest.get(name, np.inf)
            if pulls[name] > 0.0 and (kpa >= self.kpa / _KEPT or name in self.hardest):
                most = self._tension(name, pulls[name], kpa)
                self.hardest[name] = min(most, before) if firm else most
            self._seen[name] = pulls[name], kpa
        return all(kpa < self.kpa / _KEPT for name, kpa in self.pressure.items() if name in free)

    def _tension(self, name: str, pull: float, kpa: float) -> float:
        """Return the tension at which a line presses as much as is aimed at, by its last two looks.

        The largest pressure is that of one place, whose share of the tension may hardly fall with the rest.
        """
        aim = self.kpa / _AIM
        even = pull * aim / kpa
        before, pressed = self._seen.get(name, (pull, kpa))
        slope = (kpa - pressed) / (pull - before) if abs(pull - before) > _SAME * pull else 0.0
        if kpa <= aim or slope <= 0.0:
            return even
        return max(min(pull - (kpa - aim) / slope, even), _LEAST * pull)

    def lines_at_limit(self, pulled: Collection[str]) -> tuple[str, ...]:
        """Return the lines that press as hard as they may; ``pulled`` are those with the most tension."""
        most = self.kpa / _AIM**1.5
        return tuple(name for name, kpa in self.pressure.items() if kpa > most or name in pulled)

    def _limited(self, stages: Stages, points: Points) -> dict[str, float]:
        if self._every:
            return largest_pressures(stages, points)
        if not self._elastics:
            return {}
        straps = {line.name for line in stages.model.lines if is_strap(stages, line)}
        tensions = {
            name: tension
            for region, rows in zip(stages.regions, stages.region_rows, strict=True)
            for name, tension in line_tensions(region, points[rows]).items()
        }
        return {
            name: kpa
            for name, kpa in largest_pressures(stages, points).items()
            if name in self._elastics and name not in straps and not tensions[name].estimate
        }


def largest_pressures(stages: Stages, points: Points) -> dict[str, float]:
    """Return the largest pressure [kPa] of each active line of all regions, where it is known.

    ``points`` (n, 3) [mm] are the control points of all regions.
    """
    regions = zip(stages.regions, stages.region_rows, strict=True)
    found = [pressures(region, points[rows]) for region, rows in regions]
    return {name: worn.largest for each in found for name, worn in sorted(each.items())}
