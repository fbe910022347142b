"""Tension of active lines in newtons."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.document.elastic import Elastic
from core.geometry.mesh import Floats, Points
from core.mechanics.force_units import newtons_per_unit
from core.mechanics.newton import SlidingSurface
from core.mechanics.potential import Potential
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import divergence_error
from core.pipeline.stages import RegionStages

SLACK = 0.05
"""Up to this push of the model a line counts as without tension [N]: less is not shown."""


@dataclass(frozen=True, eq=False)
class LineTension:
    """The pull along a worn line: ``segments`` (k - 1,) [N] from its right end to the left.

    ``mean`` [N] is that over its natural length, so that of a spring it belongs to the line's whole stretch;
    where the line is too long for the body it is negative in the model: see ``tension`` for what a band does.
    ``estimate`` is always True where the newtons come from the assumed stiffness of tissue alone and not from
    an elastic.
    """

    segments: Floats
    mean: float
    estimate: bool

    @property
    def tension(self) -> float:
        """Return the mean tension of a band in place of the line [N]: none where it would have to push."""
        return max(self.mean, 0.0)

    @property
    def compression(self) -> float:
        """Return how far the model pushes where a band would be slack [N]; 0 for a line that pulls."""
        return -self.mean if self.mean < -SLACK else 0.0


def mean_elongation(
    stages: RegionStages, elastic: Elastic, tension: LineTension | None, whole: float
) -> float:
    """Return how far a line's elastic is stretched on the mean [1].

    It is that of the ``whole`` line, below 0 if it is slack; on solid tissue, where single pieces may be
    slack, it follows from the ``tension``.
    """
    if stages.tissue is None or tension is None or tension.mean <= 0.0:
        return whole
    return elastic.elongation(tension.mean)


def line_tensions(stages: RegionStages, control_points: Points) -> Mapping[str, LineTension]:
    """Return what each worn line pulls with at ``control_points``, shape (n, 3) [mm], by line.

    A line on points that do not move pulls as its elastic says, and has no answer without one, or when its
    length is held. The tension of held lines is read from the balance of the points around them. Raises
    LineError for points that are no shape: not finite, or with a line of no length.
    """
    worn = [line for line in stages.model.lines if line.name in stages.design.active_lines()]
    if not np.isfinite(control_points).all() or not all(line.length(control_points) for line in worn):
        raise divergence_error()
    held = stages.design.line_hold == "held"
    pulling = _held(stages, control_points) if held else _springs(stages, control_points)
    return pulling if held else {**pulling, **_on_ribs(stages)}


def _springs(stages: RegionStages, points: Points) -> dict[str, LineTension]:
    model = stages.model
    unit = newtons_per_unit(model, stages.design.tissue_stiffness)
    potential = Potential(model, line_targets(stages.design, stages).ratios)
    force = unit * potential.tape * potential.stretch(model.segments.lengths(points))
    made = stages.design.active_elastics()
    tensions = {}
    for index in model.acting_lines:
        here, name = model.owner == index, model.lines[index].name
        mean = float(np.average(force[here], weights=(potential.natural + model.beyond)[here]))
        tensions[name] = LineTension(force[here], mean, name not in made)
    return tensions


def _on_ribs(stages: RegionStages) -> dict[str, LineTension]:
    """Return the tensions of lines made of elastic that cannot move: their length is that at rest."""
    tensions = {}
    lines = {line.name: line for line in stages.model.lines}
    for name, elastic in stages.design.active_elastics().items():
        if not lines[name].constrains:
            force = elastic.force(1.0 / stages.design.ratio(name) - 1.0)
            tensions[name] = LineTension(np.full(len(lines[name].rest_lengths), force), force, estimate=False)
    return tensions


def _held(stages: RegionStages, points: Points) -> dict[str, LineTension]:
    """Return the tensions of held lines: what, with the pressures, balances the free points best."""
    model, design = stages.model, stages.design
    potential = Potential(model, line_targets(design, stages).ratios)
    place = potential.at(points[model.tensegric.free] - model.tensegric.rest[model.tensegric.free])
    forces, slopes = place.gradient, place.slopes
    if design.line_contact == "sliding" and len(model.owner):
        forces, slopes = SlidingSurface(model).projected(place)
    # First the pressures, which come out as nothing where the volume is not held.
    multipliers = np.linalg.lstsq(slopes.T, forces, rcond=1e-12)[0]
    unit = newtons_per_unit(model, design.tissue_stiffness)
    tensions = {}
    for index, multiplier in zip(model.acting_lines, multipliers[len(potential.groups) :], strict=True):
        line = model.lines[index]
        force = -unit * float(multiplier)
        tensions[line.name] = LineTension(np.full(len(line.rest_lengths), force), force, estimate=True)
    return tensions
