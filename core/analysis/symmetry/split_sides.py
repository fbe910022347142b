"""Left and right apart: what moves one side alone, and what has to be split or unlinked for it (ours)."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from functools import reduce

from core.analysis.inverse_design.bust_quantities import EVEN, LIFT, OUT
from core.analysis.inverse_design.lower_quantities import LOWER_GIRTHS, SEAT_EVEN
from core.analysis.symmetry.compare import SideDifference
from core.control_mesh.template import Template
from core.document.design import Design
from core.document.split_lines import can_split, split
from core.pipeline.active_lines import free_lines
from core.pipeline.build import Stages
from core.pipeline.stages import RegionStages

ENOUGH = 0.5
"""Bust points that differ by less count as even: they ride on the nearest vertex of the skin [mm]."""


@dataclass(frozen=True)
class SidePair:
    """What of a ``region``, by its number, is to be alike left and right.

    ``even`` are the differences as quantities, which ``differences`` [mm] reads off a comparison, and
    ``kept`` the quantities of both sides together that are to stay; those ``held`` are never let go of.
    """

    region: int
    even: tuple[str, ...]
    kept: tuple[str, ...]
    differences: Callable[[SideDifference], tuple[float, ...]]
    held: tuple[str, ...] = ()


def _of_seat(told: SideDifference) -> tuple[float, ...]:
    return (0.0, 0.0) if told.seat is None else (told.seat.higher, told.seat.fold_higher)


BUST_PAIR = SidePair(0, EVEN.names, (LIFT, OUT), lambda told: (told.higher, told.further_out))
"""The bust points."""

SEAT_PAIR = SidePair(1, SEAT_EVEN.names, ("buttock lift", "fold lift"), _of_seat, held=LOWER_GIRTHS.names)
"""The heights of buttock points and gluteal folds; a band round the waist is no way to level them."""


def worn_pairs(stages: Stages) -> tuple[SidePair, ...]:
    """Return what active lines may balance: that of each region which has any, else the bust points."""
    pairs = (BUST_PAIR, SEAT_PAIR)[: len(stages.regions)]
    return tuple(each for each in pairs if _active(stages.design, each)) or (BUST_PAIR,)


def uneven_pairs(stages: Stages, told: SideDifference) -> tuple[SidePair, ...]:
    """Return those of ``worn_pairs`` that do not count as even."""
    return tuple(each for each in worn_pairs(stages) if max(map(abs, each.differences(told))) >= ENOUGH)


def _active(design: Design, pair: SidePair) -> Collection[str]:
    return design.regions[pair.region].active_lines()


def moves_one_side(stages: RegionStages) -> bool:
    """Return whether an active line or its linked lines may change and act on one side alone."""
    return any(_one_sided(stages, group) for group in free_lines(stages))


def _one_sided(stages: RegionStages, group: tuple[str, ...]) -> bool:
    control = stages.control
    touched = [line.weights.nonzero()[1] for line in stages.model.lines if line.name in group]
    pulled = {int(point) for points in touched for point in points if not control.held[point]}
    columns = set(control.column.tolist())
    # The middle of front and back has no other side.
    sides = {int(side) for side in control.column[list(pulled)] if side and -side in columns}
    return bool(sides) and (min(sides) > 0 or max(sides) < 0)


def splittable_lines(design: Design, template: Template, pair: SidePair | None = None) -> tuple[str, ...]:
    """Return the worn lines that can be set apart or split so that left and right change each by itself.

    With a ``pair`` they are those of its region.
    """
    worn = design.all_active_lines() if pair is None else _active(design, pair)
    free = [name for name in sorted(worn) if not design.line_settings(name).locked]
    return tuple(
        name for name in free if len(design.linked_lines(name)) > 1 or can_split(design, template, name)
    )


def split_sides(design: Design, template: Template, names: Collection[str] | None = None) -> Design:
    """Return the design with linked pairs set apart and lines across both sides split; locked ones stay.

    With ``names`` other lines stay as well.
    """
    lines = (name for name in splittable_lines(design, template) if names is None or name in names)
    return reduce(lambda after, name: _parted(after, template, name), lines, design)


def _parted(design: Design, template: Template, name: str) -> Design:
    if len(design.linked_lines(name)) > 1:
        return design.with_line_settings(replace(design.line_settings(name), linked=False))
    return split(design, template, name) if can_split(design, template, name) else design
