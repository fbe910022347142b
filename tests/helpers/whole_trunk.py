"""The sample of a whole trunk: its design with the lower trunk on a net, and its stages, built once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

from app.presenters.samples import sample_path
from core.document.design import Design, ScanSource
from core.document.lower_trunk import LowerTrunk
from core.pipeline.build import Stages, build

TRUNK = str(sample_path("trunk"))


@cache
def trunk_stages() -> Stages:
    """Return the stages of the whole trunk without any line, solved exactly."""
    told = {"unit": "mm", "up": "+z", "front": "-y"}
    return build(Design(ScanSource(TRUNK, **told), tissue="net", volume="exact", lower=LowerTrunk()))


def wearing(lines: Mapping[str, float], *, waist_kept: float = 0.5, **settings: object) -> Stages:
    """Return the stages of the whole trunk with lines at ratios [1], both sides by one name."""
    base = trunk_stages()
    design = replace(base.design, lower=LowerTrunk(waist_kept=waist_kept), **settings)  # type: ignore[arg-type]
    for name, ratio in lines.items():
        design = design.with_line(name, ratio)
    return build(design, base)
