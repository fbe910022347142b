"""The table of measures before and after: those of the body, those of the model, and all as plain cells."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from app.i18n.catalog import say, tr
from app.presenters.custom_measures import own_words
from app.presenters.lines import line_title
from app.presenters.measurement_names import measure_title
from app.presenters.measurement_views import MeasureView
from core.document.custom_measures import OwnMeasure
from core.measurements.custom import OWN
from core.measurements.definitions import definition_of
from core.measurements.table import Measures, measure_rows
from core.measurements.uncertain_value import LIFT, OUT
from core.mechanics.iteration import Marks
from core.pipeline.live_solver import Frame


def measure_views(frame: Frame) -> list[MeasureView]:
    """Return what the model says of itself with every frame, the bust points first."""
    group = tr("Followed while it solves")
    rows = (*_bust_rows(frame), *_volume_rows(frame), *_line_rows(frame))
    return [replace(row, group=group) for row in rows]


def measured_views(before: Measures, after: Measures, own: Sequence[OwnMeasure] = ()) -> list[MeasureView]:
    """Return what was measured on the body at rest and reshaped, group by group.

    ``own`` are the measures of the designer's own.
    """
    told = {f"{OWN}{each.name}": own_words(each) for each in own}
    views = [_measured(row, told) for row in measure_rows(before, after)]
    groups = list(dict.fromkeys(view.group for view in views))
    return sorted(views, key=lambda view: groups.index(view.group))


def _measured(row: dict[str, Any], told: Mapping[str, str]) -> MeasureView:
    own, key = row["key"].startswith(OWN), row["key"]
    return MeasureView(
        measure_title(row),
        row["unit"].replace("2", "\N{SUPERSCRIPT TWO}"),
        row["before"],
        row["after"],
        key=key,
        group=tr("Your own") if own else say(definition_of(key)[0].group),
        note=say(row["note"]),
        plus_minus=row["plus_minus"],
        estimate=row["estimate"],
        tip=told.get(key, "") if own else say(row["definition"]),
        iso=row["iso"],
        sure=row["confidence"],
        own=own,
    )


def as_table(views: Sequence[MeasureView], doubt: str = "") -> list[list[str]]:
    """Return the table as plain cells, with a heading; each row notes the ``doubt`` why it is no result."""
    heading = [
        tr("Measure"),
        tr("Counted from"),
        tr("Unit"),
        tr("Before"),
        tr("After"),
        tr("Change"),
        tr("Note"),
    ]
    rows = [
        [
            view.label,
            view.reference or view.tip,
            view.unit,
            *("" if each is None else f"{each:.1f}" for each in (view.before, view.after, view.change_at(1))),
            "; ".join(filter(None, ("" if view.caption == view.reference else view.caption, doubt))),
        ]
        for view in views
    ]
    return [heading, *rows]


def _bust_rows(frame: Frame) -> Iterator[MeasureView]:
    """Rows of the bust points, both and each, and of the foremost place of the breasts."""
    rest, now = frame.stages.rest_marks, frame.marks
    low = float(frame.stages.body.mesh.vertices[:, 2].min())
    above, before = tr("above the lowest point of the scan"), tr("in front of the edge of the reshaped part")
    both, left, right = tr("Bust point"), tr("Bust point left"), tr("Bust point right")
    height, forward = tr("{what}, height"), tr("{what}, forward")
    up, was_up = _up(now) - low, _up(rest) - low
    yield MeasureView(height.format(what=both), "mm", was_up, up, above, exact=True, moves=LIFT)
    for side, was, then, moves in (
        (left, rest.nipple_left_z, now.nipple_left_z, f"{LIFT} left"),
        (right, rest.nipple_right_z, now.nipple_right_z, f"{LIFT} right"),
    ):
        yield MeasureView(height.format(what=side), "mm", was - low, then - low, above, moves=moves)
    yield MeasureView(forward.format(what=both), "mm", _out(rest), _out(now), before, exact=True, moves=OUT)
    foremost = tr("Foremost place of the skin")
    was, then = rest.apex_z - low, now.apex_z - low
    yield MeasureView(height.format(what=foremost), "mm", was, then, above)
    was, then = rest.apex_protrusion, now.apex_protrusion
    yield MeasureView(forward.format(what=foremost), "mm", was, then, before)


def _volume_rows(frame: Frame) -> Iterator[MeasureView]:
    volume = frame.stages.model.volume.rest_volume / 1000.0
    # The body has no volume of its own there: what its skin gains is counted from the same rest volume.
    skin = frame.stages.moving.volume_change(frame.points) / 1000.0
    part = tr("inside the reshaped part, closed behind")
    yield MeasureView(tr("Volume of the model"), "ml", volume, volume + frame.error_ml, part)
    yield MeasureView(tr("Volume under the skin"), "ml", volume, volume + skin, part)


def _line_rows(frame: Frame) -> Iterator[MeasureView]:
    for line, reached in zip(frame.stages.model.lines, frame.lengths.values(), strict=True):
        title = line_title(line.name, frame.stages.design)
        if not line.back_length:
            yield MeasureView(title, "mm", line.rest_length, reached, tr("along the line, end to end"))
            continue
        front = tr("{line}, front part").format(line=title)
        yield MeasureView(front, "mm", line.rest_length, reached, tr("along the line, side to side"))
        whole = tr("{line}, whole band").format(line=title)
        back = line.back_length
        yield MeasureView(
            whole, "mm", line.rest_length + back, reached + back, tr("all round, back included")
        )


def _up(marks: Marks) -> float:
    return 0.5 * (marks.nipple_left_z + marks.nipple_right_z)


def _out(marks: Marks) -> float:
    return 0.5 * (marks.nipple_left_out + marks.nipple_right_out)
