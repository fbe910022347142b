"""Left and right apart: what moves one side alone, and what has to be split or unlinked for it (ours)."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce

from core.control_mesh.template import Template
from core.document.design import Design
from core.document.split_lines import can_split, split
from core.pipeline.active_lines import free_lines
from core.pipeline.build import Stages

ENOUGH = 0.5
"""Bust points that differ by less count as even: they ride on the nearest vertex of the skin [mm]."""


def moves_one_side(stages: Stages) -> bool:
    """Return whether an active line or its linked lines may change and act on one side alone."""
    return any(_one_sided(stages, group) for group in free_lines(stages))


def _one_sided(stages: Stages, group: tuple[str, ...]) -> bool:
    control = stages.control
    touched = [line.weights.nonzero()[1] for line in stages.model.lines if line.name in group]
    pulled = {int(point) for points in touched for point in points if not control.held[point]}
    sides = {int(control.column[point]) for point in pulled} - {0}
    return bool(sides) and (min(sides) > 0 or max(sides) < 0)


def splittable_lines(design: Design, template: Template) -> tuple[str, ...]:
    """Return the worn lines that can be set apart or split so that left and right change each by itself."""
    free = [name for name in sorted(design.active_lines()) if not design.line_settings(name).locked]
    return tuple(
        name for name in free if len(design.linked_lines(name)) > 1 or can_split(design, template, name)
    )


def split_sides(design: Design, template: Template) -> Design:
    """Return the design with linked pairs set apart and lines across both sides split; locked ones stay."""
    return reduce(
        lambda after, name: _parted(after, template, name), splittable_lines(design, template), design
    )


def _parted(design: Design, template: Template, name: str) -> Design:
    if len(design.linked_lines(name)) > 1:
        return design.with_line_settings(replace(design.line_settings(name), linked=False))
    return split(design, template, name) if can_split(design, template, name) else design
