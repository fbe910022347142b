"""The worn lines of a design that move anything, linked ones together: what a length can be asked of."""

from __future__ import annotations

from collections.abc import Collection

from core.pipeline.build import Stages
from core.pipeline.stages import RegionStages

LineGroup = tuple[str, ...]
"""The names of lines that share one length: a line, or a linked pair."""


def active_line_groups(stages: RegionStages) -> tuple[LineGroup, ...]:
    """Return the worn lines of a region that pull at points which can move, in the model's order.

    Linked ones are one group.
    """
    model = stages.model
    pulling = [model.lines[at].name for at in model.acting_lines]
    groups = (tuple(sorted(set(stages.design.linked_lines(name)).intersection(pulling))) for name in pulling)
    return tuple(dict.fromkeys(groups))


def free_lines(stages: RegionStages, kept: Collection[str] = ()) -> tuple[LineGroup, ...]:
    """Return those of ``active_line_groups`` that may change: none that are locked, and none of ``kept``."""
    stay = {name for name in stages.design.active_lines() if stages.design.line_settings(name).locked} | set(
        kept
    )
    return tuple(group for group in active_line_groups(stages) if not stay.intersection(group))


def all_free_lines(stages: Stages, kept: Collection[str] = ()) -> tuple[LineGroup, ...]:
    """Return the ``free_lines`` of all regions; those of a band that runs over both are one group."""
    design, found = stages.design, [group for region in stages.regions for group in free_lines(region, kept)]
    stay = {other for name in kept for other in design.band_of(name)}
    bands: dict[tuple[str, ...], LineGroup] = {}
    for group in found:
        band = design.linked_lines(group[0])
        if not stay.intersection(band):
            bands[band] = (*bands.get(band, ()), *group)
    return tuple(bands.values())
