"""The girths that tell of a figure: bust, waist and hip, before and after."""

from __future__ import annotations

from collections.abc import Mapping

from core.measurements.lower_trunk import lower_before_after
from core.measurements.table import bust_girths
from core.pipeline.frame import Frame

BELOW = ("waist", "hip")


def figure_girths(frame: Frame) -> Mapping[str, tuple[float, float]]:
    """Return the girths of bust, waist and hip before and after [mm], as far as the scan shows them."""
    bust = bust_girths(frame.stages, frame.control_points)
    found = {} if bust is None else {"bust": bust}
    if frame.lower is not None and frame.stages.lower is not None:
        below = lower_before_after(frame.stages.lower, frame.lower.control_points)
        pairs = {name: below[name] for name in BELOW if name in below}
        found |= {name: (before.tape_mm, after.tape_mm) for name, (before, after) in pairs.items()}
    return found
