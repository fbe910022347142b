"""What the strip plots of a run, and of the exact answer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.i18n.catalog import tr
from app.i18n.lengths import length_unit, shown_value
from app.presenters.curves import Numbers

TOLERANCE_PERCENT = 0.1
"""Volume error that the paper calls kept [%]."""


@dataclass(frozen=True, eq=False)
class Track:
    """A run over its ``turns``: volume error [%] and [ml], heights of bust point and apex [mm]; all (n,)."""

    turns: Numbers
    error_percent: Numbers
    error_ml: Numbers
    bust_mm: Numbers
    apex_mm: Numbers


@dataclass(frozen=True)
class Exact:
    """The exact answer: volume error [%] and [ml], heights of bust point and apex [mm]."""

    error_percent: float
    error_ml: float
    bust_mm: float
    apex_mm: float


def error_quantities() -> tuple[Quantity, ...]:
    """Return how the volume error can be plotted."""
    title = tr("Volume error")
    return Quantity("error_percent", title, "%", 0.4), Quantity("error_ml", title, "ml", 2.0)


def height_quantities() -> tuple[Quantity, ...]:
    """Return which height can be plotted: it is counted from that of the body at rest."""
    return (
        Quantity("bust_mm", tr("Bust point height"), length_unit(), shown_value(2.0)),
        Quantity("apex_mm", tr("Foremost place, height"), length_unit(), shown_value(2.0)),
    )


def tolerance_of(quantity: str, track: Track | None) -> float:
    """Return the volume error that counts as kept, in the unit of a quantity; 0 for a height."""
    if quantity == "error_percent":
        return TOLERANCE_PERCENT
    if quantity != "error_ml" or track is None:
        return 0.0
    percent = np.abs(track.error_percent)
    known = np.isfinite(percent) & (percent > 0.0)
    if not known.any():
        return 0.0
    furthest = int(np.where(known, percent, 0.0).argmax())
    return TOLERANCE_PERCENT * float(abs(track.error_ml[furthest]) / percent[furthest])


@dataclass(frozen=True)
class Quantity:
    """What can be plotted: ``name`` of the values, title, unit, the least span worth seeing."""

    name: str
    title: str
    unit: str
    least_span: float
