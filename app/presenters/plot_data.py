"""What is plotted of a frame's runs, and what a table of them says."""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter

import numpy as np

from app.i18n.catalog import tr
from app.presenters.bust_shift import move_between, ups
from app.presenters.lines import line_title
from app.presenters.plot_series import Exact, Track
from core.mechanics.iteration import Marks, Record
from core.pipeline.live_solver import Frame

PLOTTED_TURNS = 600
"""Turns that the live plot looks back."""

PLOT_INTERVAL = 100
"""Milliseconds between two pictures of plots and figures: the body is what has to follow the hand."""

_FOLLOWED = attrgetter(
    "turn", "error", "error_ml", "marks.nipple_left_z", "marks.nipple_right_z", "marks.apex_z"
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
        result[control] = Track(turns, 100.0 * error, error_ml, ups(rest, left, right), apex - rest.apex_z)
    return result


def exact_answer(frame: Frame) -> Exact:
    """Return what the exact answer ends at, for the dashed line."""
    return Exact(0.0, 0.0, *_heights(frame.exact_marks, frame.stages.rest_marks))


def table_of(frame: Frame) -> tuple[list[str], list[Sequence[object]]]:
    """Return the heading and the rows of all turns of all runs, as they were made."""
    names = [line_title(line.name) for line in frame.stages.model.lines]
    heading = [
        tr("run"),
        tr("turn"),
        tr("volume error [%]"),
        tr("volume error [ml]"),
        tr("bust points up [mm]"),
        tr("foremost place up [mm]"),
        tr("largest move [mm]"),
        *(tr("{line} [mm]").format(line=name) for name in names),
    ]
    rest = frame.stages.rest_marks
    rows: list[Sequence[object]] = [
        (control, row.turn, *_figures(row, row.marks or rest, rest), row.step, *row.lengths)
        for control, records in frame.tracks.items()
        for row in records
    ]
    return heading, rows


def _figures(row: Record, marks: Marks, rest: Marks) -> tuple[float, float, float, float]:
    return 100.0 * row.error, row.error_ml, *_heights(marks, rest)


def _heights(marks: Marks, rest: Marks) -> tuple[float, float]:
    """Return how far the bust points, on an average, and the apex lie above where they are at rest [mm]."""
    return move_between(rest, marks).mean.up, marks.apex_z - rest.apex_z
