"""Collect what the plots of a run show: curves, quantities, axes, and the table of iterations."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from app.i18n.catalog import tr
from app.i18n.lengths import length_unit, shown_value
from app.presenters.bust_shift import mean_lifts, shift_between
from app.presenters.messages import line_title
from app.presenters.zones import zone_title
from core.mechanics.iteration import Observables, Record
from core.pipeline.frame import RegionFrame
from core.pipeline.live_solver import Frame
from core.pipeline.stages import RegionStages

PLOTTED_TURNS = 600
"""Turns that the live plot looks back."""

PLOT_INTERVAL = 100
"""Milliseconds between two pictures of plots and figures: the body is what has to follow the hand."""

_FOLLOWED = attrgetter(
    "iteration", "error", "error_ml", "marks.bust_point_left_z", "marks.bust_point_right_z", "marks.apex_z"
)
"""What is plotted of a record: in one call, because hundreds of them are read at each picture."""


def tracks(frame: Frame) -> dict[str, Track]:
    """Return the runs of a frame as curves; heights are counted from those of the body at rest."""
    rest = frame.stages.rest_marks
    result = {}
    for control, records in frame.tracks.items():
        watched = [row for row in records[-PLOTTED_TURNS:] if row.marks is not None]
        figures = np.array(list(map(_FOLLOWED, watched)), dtype=np.float64).reshape(-1, 6)
        turns, error, error_ml, left, right, apex = figures.T
        result[control] = Track(
            turns, 100.0 * error, error_ml, mean_lifts(rest, left, right), apex - rest.apex_z
        )
    return result


def lower_run(frame: Frame) -> LowerRun | None:
    """Return the runs of the lower trunk of a frame as curves, if there is that region."""
    if frame.lower is None:
        return None
    shown, control = frame.lower, frame.stages.design.volume
    rest_ml = shown.stages.model.volume.rest_volume / 1000.0
    recent = {name: records[-PLOTTED_TURNS:] for name, records in shown.tracks.items()}
    made = {
        name: np.array([row.iteration for row in rows], dtype=np.float64) for name, rows in recent.items()
    }
    whole = {
        name: _error_track(made[name], np.array([row.error for row in rows]), rest_ml)
        for name, rows in recent.items()
    }
    zones = np.array([row.zones for row in recent.get(control, ())]).T
    parts = {
        name: _error_track(made[control], error, rest_ml)
        for name, error in zip(shown.stages.control.zone_names, zones, strict=False)
    }
    return LowerRun(whole, parts)


def _error_track(turns: Numbers, error: Numbers, rest_ml: float) -> ErrorTrack:
    return ErrorTrack(turns, 100.0 * error, rest_ml * error)


def exact_answer(frame: Frame) -> Exact:
    """Return what the exact answer ends at, for the dashed line."""
    return Exact(0.0, 0.0, *_heights(frame.exact_marks, frame.stages.rest_marks))


def table_of(frame: Frame) -> tuple[list[str], list[Sequence[object]]]:
    """Return the heading and the rows of all turns of all runs, as they were made."""
    heading = _heading(frame.stages, (tr("bust points up [mm]"), tr("foremost place up [mm]")))
    rest = frame.stages.rest_marks
    rows: list[Sequence[object]] = [
        (control, row.iteration, *_record_figures(row, row.marks or rest, rest), row.step, *row.lengths)
        for control, records in frame.tracks.items()
        for row in records
    ]
    return heading, rows


def _heading(stages: RegionStages, own: Sequence[str]) -> list[str]:
    """Return the heading of the table of a region, whose ``own`` columns follow the volume errors."""
    lines = (tr("{line} [mm]").format(line=line_title(line.name)) for line in stages.model.lines)
    errors = tr("volume error [%]"), tr("volume error [ml]")
    return [tr("run"), tr("iteration"), *errors, *own, tr("largest move [mm]"), *lines]


def lower_table_of(shown: RegionFrame) -> tuple[list[str], list[Sequence[object]]]:
    """Return the heading and the rows of all turns of all runs of the lower trunk."""
    zones = [tr("{zone}, volume error [ml]").format(zone=zone_title(zone.name)) for zone in shown.zones]
    heading = _heading(shown.stages, zones)
    rest_ml = shown.stages.model.volume.rest_volume / 1000.0
    rows: list[Sequence[object]] = [
        (
            *(control, row.iteration, 100.0 * row.error, row.error_ml),
            *(rest_ml * error for error in row.zones),
            *(row.step, *row.lengths),
        )
        for control, records in shown.tracks.items()
        for row in records
    ]
    return heading, rows


def _record_figures(row: Record, marks: Observables, rest: Observables) -> tuple[float, float, float, float]:
    return 100.0 * row.error, row.error_ml, *_heights(marks, rest)


def _heights(marks: Observables, rest: Observables) -> tuple[float, float]:
    """Return how far the bust points, on an average, and the apex lie above where they are at rest [mm]."""
    return shift_between(rest, marks).mean.up, marks.apex_z - rest.apex_z


TOLERANCE_PERCENT = 0.1
"""Volume error that the paper calls kept [%]."""


@dataclass(frozen=True, eq=False)
class ErrorTrack:
    """A run over its ``turns``: volume error [%] and [ml]; all (n,)."""

    turns: Numbers
    error_percent: Numbers
    error_ml: Numbers


@dataclass(frozen=True, eq=False)
class LowerRun:
    """Runs of the lower trunk: ``tracks`` by control, and ``zones`` of the one on the body.

    With the exact solution on the body there are no ``zones``.
    """

    tracks: Mapping[str, ErrorTrack]
    zones: Mapping[str, ErrorTrack]


@dataclass(frozen=True, eq=False)
class Track(ErrorTrack):
    """A run over its ``turns``, with the heights of bust point and apex [mm]; all (n,)."""

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


def zone_quantities() -> tuple[Quantity, ...]:
    """Return how the volume errors of zones can be plotted: in % of the whole lower trunk."""
    title = tr("Volume error by zone")
    return Quantity("error_percent", title, "%", 0.4), Quantity("error_ml", title, "ml", 2.0)


def height_quantities() -> tuple[Quantity, ...]:
    """Return which height can be plotted: it is counted from that of the body at rest."""
    return (
        Quantity("bust_mm", tr("Bust point height"), length_unit(), shown_value(2.0)),
        Quantity("apex_mm", tr("Apex height"), length_unit(), shown_value(2.0)),
    )


def tolerance_of(quantity: str, track: ErrorTrack | None) -> float:
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


Numbers = NDArray[np.float64]

_FLIP_WINDOW = 24


@dataclass(frozen=True, eq=False)
class Curve:
    """A run: ``turns`` (n,), ``values`` (n,).

    Its role is main, warning (main, but vibrating), ghost, or the zone of the lower trunk that it is of.
    """

    turns: Numbers
    values: Numbers
    role: str
    name: str = ""


@dataclass(frozen=True)
class Event:
    """A change at a ``turn``, in words."""

    turn: float
    words: str


@dataclass(frozen=True, eq=False)
class Plotted:
    """All that one plot shows: ``exact`` is the answer that turns aim at, ``tolerance`` a band about zero."""

    curves: tuple[Curve, ...] = ()
    exact: float | None = None
    exact_is_main: bool = False
    tolerance: float = 0.0
    events: tuple[Event, ...] = ()

    def turns(self) -> tuple[float, float]:
        """Return the first and the last turn, at least ten apart."""
        ends = [(float(curve.turns[0]), float(curve.turns[-1])) for curve in self.curves if len(curve.turns)]
        first = min((end[0] for end in ends), default=0.0)
        return first, max(max((end[1] for end in ends), default=0.0), first + 10.0)

    def values(self, first: float, last: float) -> tuple[float, float]:
        """Return the lowest and the highest of what is drawn between two turns."""
        seen = [
            curve.values[(curve.turns >= first) & (curve.turns <= last) & np.isfinite(curve.values)]
            for curve in self.curves
        ]
        levels = [] if self.exact is None else [self.exact]
        if self.tolerance:
            levels += [-self.tolerance, self.tolerance]
        together = np.concatenate([*seen, np.array(levels, dtype=np.float64)])
        return (float(together.min()), float(together.max())) if len(together) else (0.0, 0.0)

    def strong(self) -> Curve | None:
        """Return the curve of the run that is on the body."""
        return next((curve for curve in self.curves if curve.role != "ghost" and len(curve.turns)), None)

    def nearest(self, turn: float) -> float | None:
        """Return the turn that was made nearest to ``turn``, if there is one."""
        curve = self.strong() or next((each for each in self.curves if len(each.turns)), None)
        return None if curve is None else float(curve.turns[int(np.abs(curve.turns - turn).argmin())])

    def at(self, turn: float) -> list[tuple[Curve, float]]:
        """Return each curve's value at a turn; a run that rests stays where it came to."""
        found = []
        for curve in sorted(self.curves, key=lambda each: each.role == "ghost"):
            made = int(np.searchsorted(curve.turns, turn, side="right")) - 1
            if made >= 0:
                found.append((curve, float(curve.values[made])))
        return found


def flips_every_turn(values: Numbers) -> bool:
    """Return whether the last values go up and down in turn, by more than a trifle."""
    recent = values[-_FLIP_WINDOW:]
    if len(recent) < 8 or not np.isfinite(recent).all():
        return False
    steps = np.diff(recent)
    flips = np.count_nonzero(steps[1:] * steps[:-1] < 0.0)
    span = float(np.ptp(values[np.isfinite(values)]))
    return bool(flips >= 0.8 * (len(steps) - 1) and np.abs(steps).mean() > 0.02 * span > 0.0)


def envelope(values: Numbers) -> tuple[Numbers, Numbers]:
    """Return lower and upper edge, each (n,), of values that flip: their own or their neighbours' mean."""
    padded = np.concatenate([values[1:2], values, values[-2:-1]])
    across = (padded[:-2] + padded[2:]) / 2.0
    return np.minimum(values, across), np.maximum(values, across)


def round_ticks(low: float, high: float, count: int = 4) -> list[float]:
    """Return about ``count`` round numbers from ``low`` to ``high``."""
    span = high - low
    if not (math.isfinite(span) and span > 0.0):
        return [low]
    rough = span / count
    unit = 10.0 ** math.floor(math.log10(rough))
    step = min((m * unit for m in (1, 2, 2.5, 5, 10)), key=lambda s: abs(span / s - count))
    first = math.ceil(low / step - 1e-9)
    return [i * step for i in range(first, math.floor(high / step + 1e-9) + 1)]


def digits_of(levels: list[float]) -> int:
    """Return the number of digits that distinguishes these levels."""
    return next((d for d in (0, 1, 2) if all(abs(v - round(v, d)) < 1e-9 for v in levels)), 3)
