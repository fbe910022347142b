"""Response of one region to what its lines are made of, by the linear system of its equilibrium."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from core.analysis.uncertainty.parameters import UncertainParameter, turned_cup, turned_design
from core.document.cup import Cup
from core.garment.tension import LineTension, line_tensions
from core.geometry.mesh import Floats, Points
from core.measurements.uncertain_value import ELASTIC, LINE, TAPE, TISSUE
from core.mechanics.cup_parts import CupPart
from core.mechanics.force_units import newtons_per_unit
from core.mechanics.sensitivity import Rates, Sensitivities
from core.mechanics.stiffness_sensitivity import Changes, Kept, d_sag, stiffness_rates
from core.pipeline.model_stages import line_targets
from core.pipeline.stages import RegionStages

_SMALL = 1e-3  # of a standard deviation, to either side, for what a setting of the cups adds

CupParts = Callable[[Cup], tuple[CupPart, ...]]
"""Returns the parts of cups on a body."""


@dataclass(frozen=True, eq=False)
class PerturbedLines:
    """A region with a parameter off: its ``stages``, control ``points`` (n, 3) [mm] and ``tensions``."""

    stages: RegionStages
    points: Points
    tensions: Mapping[str, LineTension]


class LineResponse:
    """What parameters of lines, tissue and cups do to the ``answer`` of a region.

    ``kept`` makes of rates at held volumes those under the control of the design; ``cup_parts`` are asked for
    cups.
    """

    def __init__(
        self,
        stages: RegionStages,
        answer: Sensitivities,
        kept: Kept = lambda rates: rates,
        cup_parts: CupParts | None = None,
    ) -> None:
        self.stages, self.answer, self._kept, self._cup_parts = stages, answer, kept, cup_parts
        self.ratios = np.array(line_targets(stages.design, stages).ratios)
        both = zip(stages.model.lines, self.ratios.tolist(), strict=True)
        self.meant: dict[str, float] = {line.name: ratio for line, ratio in both}
        self.points = answer.place.points
        self.tensions = line_tensions(stages, self.points)
        self._long = {line.name: line.rest_lengths for line in stages.model.lines}
        for at in stages.model.acting_lines:
            name = stages.model.lines[at].name
            self._long[name] = stages.model.tapes_at_rest[stages.model.owner == at]

    def sides(self, knob: UncertainParameter) -> Iterator[PerturbedLines]:
        """Yield the region with a parameter one standard deviation too small, and too large."""
        moved, pulls = self._answered(knob)
        for turn in (-1.0, 1.0):
            tensions = {
                name: _pulled(each, turn * pulls[name], self._long[name])
                for name, each in self.tensions.items()
            }
            design = turned_design(self.stages.design, self.stages, knob, turn)
            yield PerturbedLines(replace(self.stages, design=design), self.points + turn * moved, tensions)

    def _answered(self, knob: UncertainParameter) -> tuple[Points, dict[str, Floats]]:
        """Return how control points move, (n, 3) [mm], and tensions change [N], by line, for one sd."""
        model, design = self.stages.model, self.stages.design
        elastics = design.active_elastics()
        names = [line.name for line in model.lines]
        stiffer, ratios = np.zeros((len(names), 1)), np.zeros((len(names), 1))
        solid = design.tissue == "solid"
        newtons = knob.sd if knob.source == TISSUE and not solid else 0.0
        for at, name in enumerate(names):
            elastic = elastics.get(name)
            if knob.source == TISSUE:
                # Elastics have newtons of their own on a net, whose unit changes; on a solid other lines do.
                stiffer[at] = -knob.sd if solid != (elastic is not None) else 0.0
            elif (knob.source == LINE and not elastic) or (
                knob.source == ELASTIC and elastic and elastic.name == knob.name and not knob.cup
            ):
                stiffer[at] = knob.sd
            elif knob.source == TAPE and name == knob.name and not knob.cup:
                ratios[at] = knob.sd / model.lines[at].whole_length
        made = {names.index(name): elastic for name, elastic in elastics.items()}
        beside = self._beside(knob)
        answers = stiffness_rates(
            self.answer, Changes(stiffer, ratios), made, self.ratios, self._kept, beside.moved
        )
        moved = np.zeros_like(self.points)
        moved[model.tensegric.free] = answers.moved[:, 0].reshape(-1, 3)
        return moved, self._pulls(knob, answers.pulls[:, 0], newtons, ratios, beside)

    def _beside(self, knob: UncertainParameter) -> Rates:
        """Return what a knob does to other things than lines: to a solid, and to cups."""
        if knob.source == TISSUE and self.stages.design.tissue == "solid":
            return self._kept(d_sag(self.answer)).summed([[0]], knob.sd)
        if knob.cup:
            return self._kept(self.answer.by_forces(self._of_cups(knob)))
        return Rates(
            np.zeros((self.answer.place.gradient.size, 1)), np.zeros((len(self.answer.place.held), 1))
        )

    def _of_cups(self, knob: UncertainParameter) -> Floats:
        """Return the forces on the free points that one sd of a setting of the cups adds, (3 f, 1)."""
        moved, found = self.answer.place.moved, []
        for turn in (-_SMALL, _SMALL):
            assert self._cup_parts is not None
            parts = self._cup_parts(turned_cup(self.stages.design.cup, knob, turn))
            found.append(sum((part.gradient(moved) for part in parts), np.zeros_like(moved)))
        return ((found[1] - found[0]) / (2.0 * _SMALL)).reshape(-1, 1)

    def _pulls(
        self, knob: UncertainParameter, pulls: Floats, newtons: float, ratios: Floats, beside: Rates
    ) -> dict[str, Floats]:
        stages, model = self.stages, self.stages.model
        unit = newtons_per_unit(model, stages.design.tissue_stiffness)
        held = stages.design.line_hold == "held"
        found = {}
        for at, line in enumerate(model.lines):
            if line.name not in self.tensions:
                continue
            segments = self.tensions[line.name].segments
            if held:
                found[line.name] = newtons * segments + unit * self._held(at, ratios, beside)
            elif (model.owner == at).any():
                found[line.name] = newtons * segments + unit * pulls[model.owner == at]
            else:
                gained = self._on_ribs(knob, line.name, float(ratios[at, 0]))
                found[line.name] = np.full(len(segments), gained)
        return found

    def _held(self, line: int, ratios: Floats, beside: Rates) -> float:
        """Return what the tension of a held line gains, in the model's unit."""
        every = np.arange(len(ratios))
        rates = self._kept(self.answer.by_ratio(every))
        rest = np.array([each.rest_length for each in self.stages.model.lines])
        by_line = self.answer.tensions(rates, np.diag(rest))[1]
        by_beside = self.answer.tensions(beside, np.zeros((len(rest), 1)))[1]
        return float(by_line[line] @ ratios[:, 0] + by_beside[line, 0])

    def _on_ribs(self, knob: UncertainParameter, name: str, longer: float) -> float:
        """Return what the tension of an elastic that cannot move gains [N]."""
        elastic, ratio = self.stages.design.active_elastics()[name], self.stages.design.ratio(name)
        force = elastic.force(1.0 / ratio - 1.0)
        if knob.source == ELASTIC and knob.name == elastic.name:
            return knob.sd * force
        ends = [elastic.force(1.0 / (ratio + turn * longer) - 1.0) for turn in (-1.0, 1.0)]
        return (ends[1] - ends[0]) / 2.0


def _pulled(tension: LineTension, more: Floats, lengths: Floats) -> LineTension:
    mean = tension.mean + float(np.average(more, weights=lengths))
    return replace(tension, segments=tension.segments + more, mean=mean)
