"""The worn lines of a design that move anything, linked ones together: what a length can be asked of."""

from __future__ import annotations

from collections.abc import Collection

from core.pipeline.build import Stages

Together = tuple[str, ...]
"""The names of lines that share one length: a line, or a linked pair."""


def worn_lines(stages: Stages) -> tuple[Together, ...]:
    """Return the worn lines that pull at points which can move, in the model's order; linked ones as one."""
    model = stages.model
    pulling = [model.lines[at].name for at in model.pulling]
    groups = (tuple(sorted(set(stages.design.linked(name)).intersection(pulling))) for name in pulling)
    return tuple(dict.fromkeys(groups))


def free_lines(stages: Stages, kept: Collection[str] = ()) -> tuple[Together, ...]:
    """Return those of ``worn_lines`` that may change: none that are locked, and none of ``kept``."""
    stay = {name for name in stages.design.worn() if stages.design.traits_of(name).locked} | set(kept)
    return tuple(group for group in worn_lines(stages) if not stay.intersection(group))
