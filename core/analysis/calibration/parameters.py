"""The numbers of tissue and lines that a second scan may tell, and where a design keeps them (ours)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from core.document.design import Design
from core.document.elastic import TISSUE_LIMITS
from core.document.lines import ActiveLine
from core.document.lower_trunk import LOWER_RANGES
from core.geometry.mesh import Floats
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.mechanics.options import RANGES
from core.mechanics.sensitivity import Sensitivities
from core.mechanics.stiffness_sensitivity import (
    Changes,
    d_ground,
    d_prestress,
    d_sag,
    d_tissue,
    stiffness_rates,
)
from core.mechanics.tensegrity import TensegrityModel, firm_ground
from core.pipeline.active_lines import active_line_groups
from core.pipeline.build import Stages
from core.pipeline.solve import body_volume_rates
from core.pipeline.stages import RegionStages

T = TypeVar("T")

LINE_STIFFNESS, FIRM_CHEST, PRESTRESS, TISSUE, SAG = (
    "line_stiffness",
    "firm_chest",
    "prestress",
    "tissue_stiffness",
    "sag",
)
"""Numbers that are settings of the whole design."""

LOWER_TISSUE, LOWER_FIRMNESS = "lower_stiffness", "lower_firmness"
"""Numbers that are settings of the lower trunk."""

_IN_LOWER = {LOWER_TISSUE: "stiffness", LOWER_FIRMNESS: "firmness"}
"""What they are called there."""

STIFFNESS, LENGTH = "stiffness", "length"
"""Numbers of a line, or of linked ones: its own stiffness, its length as ratio."""

MOST = 6
"""No more numbers than this are sought at once."""

_BEFORE = {
    LINE_STIFFNESS: 1.0,
    STIFFNESS: 1.0,
    TISSUE: 0.5,
    LOWER_TISSUE: 0.5,
    LOWER_FIRMNESS: 0.1,
    SAG: math.log(1.5),
    FIRM_CHEST: 0.1,
    PRESTRESS: 0.25,
    LENGTH: 0.02,
}
"""How far off a number may be before any scan tells it: a standard deviation, as it is sought."""

_END = 1.0 - 1e-6  # of the largest number, where one counts as at the end
_OWN = 0.5
"""And how far the stiffness of one line from that of the others, its logarithm [1]."""


@dataclass(frozen=True)
class Parameter:
    """One number that may be found: its ``kind`` and the ``lines`` it is of, where it is a line's."""

    kind: str
    lines: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Return the kind, and the first line for a parameter of a line."""
        return f"{self.kind} of {self.lines[0]}" if self.kind in (STIFFNESS, LENGTH) else self.kind

    @property
    def logarithmic(self) -> bool:
        """Return whether it is sought by its logarithm, which is what matters of a stiffness."""
        return self.kind in (LINE_STIFFNESS, STIFFNESS, TISSUE, LOWER_TISSUE, SAG)

    @property
    def prior_deviation(self) -> float:
        """Return how far off it may be before any scan tells it: a standard deviation, as it is sought."""
        return _BEFORE[self.kind]

    @property
    def range(self) -> tuple[float, float]:
        """Return the least and the largest that a design allows."""
        if self.kind == LENGTH:
            return RATIO_LIMITS
        if self.kind == TISSUE:
            return TISSUE_LIMITS
        if self.kind in _IN_LOWER:
            return LOWER_RANGES[_IN_LOWER[self.kind]]
        return RANGES[LINE_STIFFNESS if self.kind == STIFFNESS else self.kind]

    def value_in(self, design: Design) -> float:
        """Return it as the design has it."""
        if self.kind == LENGTH:
            return design.ratio(self.lines[0])
        if self.kind == STIFFNESS:
            own = design.line_settings(self.lines[0]).stiffness
            return design.line_stiffness if own is None else own
        if self.kind in _IN_LOWER:
            return float(getattr(design.lower, _IN_LOWER[self.kind]))
        return float(getattr(design, self.kind))

    def is_at_limit(self, design: Design) -> bool:
        """Return whether the value is at its lower or upper limit; a chest without support may be correct."""
        low, high = self.range
        value = self.value_in(design)
        return value > _END * high or (value < low / _END and self.kind not in (FIRM_CHEST, LOWER_FIRMNESS))

    def with_value(self, design: Design, value: float) -> Design:
        """Return the design with another one."""
        if self.kind == LENGTH:
            lower = design.lower and replace(design.lower, lines=self._at(design.lower.lines, value))
            return replace(design, lines=self._at(design.lines, value), lower=lower)
        if self.kind == STIFFNESS:
            for line in self.lines:
                design = design.with_line_settings(replace(design.line_settings(line), stiffness=value))
            return design
        setting: dict[str, Any] = {_IN_LOWER.get(self.kind, self.kind): value}
        if self.kind in _IN_LOWER and design.lower is not None:
            return replace(design, lower=replace(design.lower, **setting))
        return replace(design, **setting)

    def _at(self, lines: tuple[ActiveLine, ...], ratio: float) -> tuple[ActiveLine, ...]:
        return tuple(replace(each, ratio=ratio) if each.name in self.lines else each for each in lines)

    def to_unknown(self, design: Design) -> float:
        """Return it as it is sought: its logarithm if it is ``logarithmic``."""
        return math.log(self.value_in(design)) if self.logarithmic else self.value_in(design)

    def from_unknown(self, design: Design, sought: float) -> Design:
        """Return the design with what was ``to_unknown``, within what is allowed."""
        low, high = self.range
        return self.with_value(design, min(max(math.exp(sought) if self.logarithmic else sought, low), high))


def candidate_parameters(stages: Stages, *, lengths: bool, each: bool = True) -> tuple[Parameter, ...]:
    """Return the numbers that a second scan may tell of a design, at most ``MOST``, the likeliest first.

    ``each`` line has a stiffness of its own unless these are too many, or one does for all that have none of
    their own; ``lengths`` tells that lines may have been cut to another length than was designed.
    """
    several = tuple(_candidates(stages, lengths, each))
    return several if len(several) <= MOST else tuple(_candidates(stages, lengths, False))[:MOST]


def _candidates(stages: Stages, lengths: bool, each: bool) -> Iterator[Parameter]:
    design = stages.design
    groups = tuple(group for region in stages.regions for group in active_line_groups(region))
    elastic, own = _in_all(stages, Design.active_elastics), _in_all(stages, Design.line_stiffnesses)
    springy = [group for group in groups if group[0] not in elastic]
    if design.line_hold == "spring":
        usual = tuple(group for group in springy if group[0] not in own)
        if usual and (not each or (springy == [*usual] and len(usual) == 1)):
            yield Parameter(LINE_STIFFNESS, tuple(name for group in usual for name in group))
        for group in springy:
            if group[0] in own or (each and len(springy) > 1):
                yield Parameter(STIFFNESS, group)
    below = {line.name for line in stages.lower.model.lines} if stages.lower else set()
    moving = [name for group in groups for name in group if name not in below]
    made = tuple(name for name in moving if name in elastic)
    measured = bool(made) and design.line_hold == "spring"
    if design.tissue == "net" and measured:
        yield Parameter(TISSUE, made)
    if design.tissue == "solid" and (measured or design.posture != "standing"):
        # Beside weight and elastics all is as stiff as the tissue, and its stiffness moves nothing.
        yield Parameter(SAG, tuple(name for name in moving if name not in elastic))
    if design.tissue == "net" and (moving or not below):
        yield Parameter(FIRM_CHEST)
    if (design.tissue == "net" or below) and design.member_law == "prestressed":
        yield Parameter(PRESTRESS)
    worn_below = [name for group in groups for name in group if name in below]
    if worn_below:
        made = tuple(name for name in worn_below if name in elastic)
        if made and design.line_hold == "spring":
            yield Parameter(LOWER_TISSUE, made)
        yield Parameter(LOWER_FIRMNESS)
    if lengths:
        yield from (Parameter(LENGTH, group) for group in groups)


def _in_all(stages: Stages, read: Callable[[Design], Mapping[str, T]]) -> dict[str, T]:
    """Return what ``read`` returns of the designs of all regions, by line."""
    return {name: each for region in stages.regions for name, each in read(region.design).items()}


def prior_precision(numbers: tuple[Parameter, ...]) -> Floats:
    """Return the precision (p, p) of ``numbers`` as they are sought, before any scan tells them."""
    size = np.array([number.prior_deviation for number in numbers])
    lines = np.array([number.kind in (LINE_STIFFNESS, STIFFNESS) for number in numbers])
    together = np.outer(size * lines, size * lines)
    alone = np.diag(np.where(lines, _OWN, size) ** 2)
    return np.asarray(np.linalg.inv(together + alone)) if len(numbers) else np.zeros((0, 0))


def point_sensitivities(
    stages: RegionStages, answer: Sensitivities, numbers: tuple[Parameter, ...]
) -> Floats:
    """Return how the free points of an ``answer`` move with ``numbers`` as they are sought, (3 f, p) [mm].

    How much a zone takes up inside counts as what it is at the present firmness.
    """
    model, design = stages.model, stages.design
    names = [line.name for line in model.lines]
    ratios = np.array([design.ratio(name) for name in names])
    elastics = {names.index(name): elastic for name, elastic in design.active_elastics().items()}
    if design.line_hold == "held":
        elastics = {}
    stiffer, shares = np.zeros((len(names), len(numbers))), np.zeros((len(names), len(numbers)))
    for column, number in enumerate(numbers):
        rows = [names.index(name) for name in number.lines if name in names]
        if number.kind in (LINE_STIFFNESS, STIFFNESS):
            stiffer[rows, column] = 1.0
        elif number.kind in (TISSUE, LOWER_TISSUE, SAG):
            stiffer[rows, column] = -1.0
        elif number.kind == LENGTH:
            shares[rows, column] = 1.0
        elif number.kind == PRESTRESS:
            stiffer[list(elastics), column] = d_tissue(design.prestress)

    kept = body_volume_rates(stages, answer)
    beside = np.zeros((answer.place.gradient.size, len(numbers)))
    for column, number in enumerate(numbers):
        if number.kind == (LOWER_FIRMNESS if stages.control.depth is not None else FIRM_CHEST):
            beside[:, column] = kept(d_ground(answer, _ground(stages))).moved[:, 0]
        elif number.kind == PRESTRESS:
            beside[:, column] = kept(d_prestress(answer)).moved[:, 0]
        elif number.kind == SAG and design.tissue == "solid":
            beside[:, column] = kept(d_sag(answer)).moved[:, 0]
    return stiffness_rates(answer, Changes(stiffer, shares), elastics, ratios, kept, beside).moved


def _ground(stages: RegionStages) -> Floats:
    net = stages.model.tensegric
    assert isinstance(net, TensegrityModel)
    return firm_ground(net, stages.control.mesh)
