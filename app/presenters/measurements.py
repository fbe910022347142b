"""Format measurements before and after: values, table, and custom measurements."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from app.i18n.catalog import colon, number, tr
from app.i18n.lengths import decimal_length, length, length_number, shown_digits, shown_unit, shown_value
from app.presenters.messages import line_title, render
from app.presenters.zones import giving_zones, taken_up_tip, zone_title
from core.document.custom_measures import LONGEST_NAME, CustomMeasurement
from core.errors import UserError
from core.landmarks.types import CERTAIN
from core.measurements.definitions import Measure, definition_of
from core.measurements.table import OWN, Measures, measure_rows
from core.measurements.uncertain_value import LIFT, OUT, round_uncertainty, uncertainty_digits
from core.mechanics.iteration import Observables
from core.messages import Message
from core.pipeline.live_solver import Frame


def measure_views(frame: Frame) -> list[MeasureView]:
    """Return the values that the model gives with every frame, the bust points first."""
    group = tr("Solver values")
    rows = (*_bust_rows(frame), *_volume_rows(frame), *_line_rows(frame))
    return [replace(row, group=group) for row in rows]


def measured_views(before: Measures, after: Measures | None) -> list[MeasureView]:
    """Return what was measured on the body at rest and reshaped, group by group."""
    views = [_measured(row) for row in measure_rows(before, after)]
    groups = list(dict.fromkeys(view.group for view in views))
    return sorted(views, key=lambda view: groups.index(view.group))


def _measured(row: dict[str, Any]) -> MeasureView:
    own, key = row["key"].startswith(OWN), row["key"]
    return MeasureView(
        measure_title(row),
        row["unit"].replace("2", "\N{SUPERSCRIPT TWO}"),
        row["before"],
        row["after"],
        key=key,
        group=tr("Custom") if own else render(definition_of(key)[0].group),
        note=render(row["note"]),
        plus_minus=row["plus_minus"],
        estimate=row["estimate"],
        tip=render(row["definition"]),
        iso=row["iso"],
        sure=row["confidence"],
        own=own,
    )


def as_table(views: Sequence[MeasureView], doubt: str = "") -> list[list[str]]:
    """Return the table as plain cells, with a heading; each row notes the ``doubt`` why it is no result."""
    heading = [
        tr("Measurement"),
        tr("Reference"),
        tr("Unit"),
        tr("Before"),
        tr("After"),
        tr("Change"),
        tr("Notes"),
    ]
    rows = [
        [
            view.label,
            view.reference or view.tip,
            view.unit,
            *_plain_values(view),
            "; ".join(filter(None, ("" if view.caption == view.reference else view.caption, doubt))),
        ]
        for view in views
    ]
    return [heading, *rows]


def _plain_values(view: MeasureView) -> Iterator[str]:
    """Yield the values before and after and the change as a file has them, with one decimal at least."""
    digits = max(digits_of(view.unit), 1)
    for value in (view.before, view.after, view.change_at(digits)):
        yield "" if value is None else f"{value:.{digits}f}"


def _bust_rows(frame: Frame) -> Iterator[MeasureView]:
    """Rows of the bust points, both and each, and of the foremost place of the breasts."""
    rest, now = frame.stages.rest_marks, frame.marks
    low = float(frame.stages.body.mesh.vertices[:, 2].min())
    above, before = (
        tr("above the lowest point of the scan"),
        tr("in front of the edge of the reshaped region"),
    )
    both, left, right = tr("Bust point"), tr("Bust point left"), tr("Bust point right")
    height, forward = tr("{what}, height"), tr("{what}, forward")
    up, was_up = _up(now) - low, _up(rest) - low
    yield MeasureView(height.format(what=both), "mm", was_up, up, above, exact=True, moves=LIFT)
    for side, was, then, moves in (
        (left, rest.bust_point_left_z, now.bust_point_left_z, f"{LIFT} left"),
        (right, rest.bust_point_right_z, now.bust_point_right_z, f"{LIFT} right"),
    ):
        yield MeasureView(height.format(what=side), "mm", was - low, then - low, above, moves=moves)
    yield MeasureView(forward.format(what=both), "mm", _out(rest), _out(now), before, exact=True, moves=OUT)
    foremost = tr("Apex")
    was, then = rest.apex_z - low, now.apex_z - low
    yield MeasureView(height.format(what=foremost), "mm", was, then, above)
    was, then = rest.apex_protrusion, now.apex_protrusion
    yield MeasureView(forward.format(what=foremost), "mm", was, then, before)


def _volume_rows(frame: Frame) -> Iterator[MeasureView]:
    volume = frame.stages.model.volume.rest_volume / 1000.0
    # The body has no volume of its own there: what its skin gains is counted from the same rest volume.
    (places,) = frame.stages.skin.of_bust(frame.points)
    skin = frame.stages.moving.volume_change(places) / 1000.0
    part = tr("inside the reshaped region, closed at the back")
    yield MeasureView(tr("Volume of the model"), "ml", volume, volume + frame.error_ml, part)
    yield MeasureView(tr("Volume under skin"), "ml", volume, volume + skin, part)
    for zone in giving_zones(frame):
        title = tr("Taken up inside, {zone}").format(zone=zone_title(zone.name).lower())
        yield MeasureView(title, "ml", 0.0, zone.taken_up_ml, tr("assumed, not measured"), tip=taken_up_tip())


def _line_rows(frame: Frame) -> Iterator[MeasureView]:
    for line, reached in zip(frame.stages.model.lines, frame.lengths.values(), strict=True):
        title = line_title(line.name, frame.stages.design)
        if not line.back_length:
            yield MeasureView(title, "mm", line.rest_length, reached, tr("along the line, end to end"))
            continue
        front = tr("{line}, front length").format(line=title)
        yield MeasureView(front, "mm", line.rest_length, reached, tr("along the line, side to side"))
        whole = tr("{line}, full length").format(line=title)
        back = line.back_length
        yield MeasureView(
            whole, "mm", line.rest_length + back, reached + back, tr("full length, back included")
        )


def _up(marks: Observables) -> float:
    return 0.5 * (marks.bust_point_left_z + marks.bust_point_right_z)


def _out(marks: Observables) -> float:
    return 0.5 * (marks.bust_point_left_out + marks.bust_point_right_out)


@dataclass(frozen=True)
class MeasureView:
    """One measure before and after, in ``unit``; what is not known is None, and ``note`` may say why.

    ``reference`` says from where it is counted, ``tip`` how it is taken, ``iso`` what the standard calls it.
    An ``estimate`` may be off by ``plus_minus``; what it was taken from is ``sure`` to that share [1], if
    that is known. ``key`` is that of a measure of the body, ``own`` if it is the designer's; ``group`` is
    its heading. The change of an ``exact`` one is told elsewhere too: it is the same figure everywhere.
    ``off`` is how far before, after and change may be off, ``off_faint`` if that is of a former shape;
    ``off_told`` says from what, or that it is not known. ``moves`` names how bust points moved, where that
    is the change.
    """

    label: str
    unit: str
    before: float | None
    after: float | None
    reference: str = ""
    key: str = ""
    group: str = ""
    note: str = ""
    plus_minus: float = 0.0
    estimate: bool = False
    tip: str = ""
    iso: str = ""
    sure: float | None = None
    own: bool = False
    exact: bool = False
    off: tuple[float | None, ...] = ()
    off_faint: bool = False
    off_told: tuple[str, ...] = ()
    moves: str = ""

    @property
    def change(self) -> float | None:
        """Return the change, if known, rounded as shown so that the columns of a table agree."""
        if self.after is None or self.before is None or self.exact:
            return self.change_at(digits_of(self.unit))
        shown = [round(shown_value(each, self.unit), self._digits) for each in (self.after, self.before)]
        return (shown[0] - shown[1]) / shown_value(1.0, self.unit)

    def change_at(self, digits: int) -> float | None:
        """Return by how much it grew where so many decimals are written."""
        if self.after is None or self.before is None:
            return None
        if self.exact:
            return self.after - self.before
        return round(self.after, digits) - round(self.before, digits)

    @property
    def known(self) -> bool:
        """Return whether it was measured at all."""
        return self.before is not None or self.after is not None

    @property
    def caption(self) -> str:
        """Return the caption: reference level, confidence, or why the value is missing."""
        if not self.known:
            return self.note
        if not self.estimate:
            return self.reference
        if not self.plus_minus or self.off:  # what is off stands beside it, with all sources
            return tr("estimate")
        off = self.written(self.plus_minus)
        return tr("estimate, ± {off} {unit}").format(off=off, unit=self.unit_shown)

    @property
    def details(self) -> tuple[str, ...]:
        """Return the details: its definition, its name in the standard, its confidence."""
        if not self.key:
            return self.off_told
        named = tr("ISO 8559-1: {name}").format(name=self.iso) if self.iso else tr("Not in ISO 8559-1")
        sure = tr("Confidence of the landmarks used: {percent} %")
        texts = (
            self.tip,
            "" if self.own else named,
            "" if self.sure is None or not self.known else sure.format(percent=number(100 * self.sure, 0)),
            "" if self.note == self.caption else self.note,
        )
        return (*(each for each in texts if each), *self.off_told)

    def written(self, value: float | None, signed: bool = False) -> str:
        """Return a value as it stands in the table."""
        return "" if value is None else number(shown_value(value, self.unit), self._digits, signed)

    def written_off(self, off: float) -> str:
        """Return how far a value may be off as it stands in the table."""
        return length_uncertainty(off) if self.unit == "mm" else plus_minus(off)

    @property
    def unit_shown(self) -> str:
        """Return the unit in which values are written."""
        return shown_unit(self.unit)

    @property
    def _digits(self) -> int:
        return shown_digits(digits_of(self.unit), self.unit)

    def told(self) -> str:
        """Return the tooltip."""
        return "\n".join((self.label, *self.details))

    def spoken(self) -> str:
        """Return it as it is read out."""
        values = [
            f"{self.written(each)} {self.unit_shown}"
            for each in (self.before, self.after)
            if each is not None
        ]
        return f"{self.label}{colon()}{' → '.join(values)} {self.caption}".rstrip()


def plus_minus(off: float) -> str:
    """Return how far a figure may be off as it is written."""
    return f"± {number(round_uncertainty(off), uncertainty_digits(off))}"


def length_uncertainty(off: float) -> str:
    """Return how far a length [mm] may be off as it is written, in the unit in use; never as nothing."""
    told, least = round_uncertainty(off), 10.0 ** -shown_digits(uncertainty_digits(off)) / shown_value(1.0)
    return f"± {decimal_length(max(told, least), uncertainty_digits(off))}"


def digits_of(unit: str) -> int:
    """Return how many decimals are written in a unit; a ratio has none."""
    return {"ml": 0, "": 2}.get(unit, 1)


def measure_title(row: Mapping[str, Any]) -> str:
    """Return what a row of ``measure_rows`` is called; names of one's own as they are."""
    sides = {"left": tr("{what}, left"), "right": tr("{what}, right")}
    title = render(row["title"])
    return sides.get(row["side"], "{what}").format(what=title)


def to_draft(own: CustomMeasurement) -> Draft:
    """Return a measure as the form shows it."""
    if own.kind != "girth":
        return Draft(own.name, own.kind, (own.marks[0], own.marks[1]))
    at = own.marks[0] if own.marks else ""
    return Draft(own.name, own.kind, at=at, level=own.level)


def from_draft(draft: Draft, suggested: str, taken: Collection[str]) -> CustomMeasurement | None:
    """Return the measure of a draft, None while a place is missing.

    Without a name it gets the ``suggested`` one. Raises UserError if its name is ``taken``.
    """
    if draft.kind != "girth" and not all(draft.ends):
        return None
    if draft.kind == "girth" and not draft.at and not draft.level:
        return None
    name = draft.name or _free(suggested, taken)
    if name in taken:
        raise UserError(
            Message("A measurement named {name} already exists.", name=name), Message("Choose a unique name.")
        )
    return CustomMeasurement(name, draft.kind, draft.marks, draft.level if draft.kind == "girth" else 0.0)


def suggested_name(draft: Draft, titles: Mapping[str, str]) -> str:
    """Return what a measure may be called if no name is typed, as far as it is known where it is taken."""
    if draft.kind != "girth":
        ends = [titles.get(mark, "") for mark in draft.ends]
        return f"{ends[0]} → {ends[1]}"[:LONGEST_NAME] if all(ends) else ""
    level = length(draft.level, 0, signed=bool(draft.at))
    if not draft.at:
        return tr("Girth at {height}").format(height=level) if draft.level else ""
    place = titles.get(draft.at, draft.at)
    if draft.level:
        place = f"{place} {level}"
    return tr("Girth, {place}").format(place=place)[:LONGEST_NAME]


def value_texts(before: Measure, after: Measure) -> tuple[str, str, str]:
    """Return the values of a measurement, their change, and doubts or why it is missing."""
    if before.value is None or after.value is None:
        return "", "", render(before.note or after.note)
    values = f"{length_number(before.value)} → {length(after.value)}"
    text = tr("before → after, {change}").format(
        change=length(round(after.value, 1) - round(before.value, 1), signed=True)
    )
    sure = min(before.confidence, after.confidence)
    unsure = tr("Confidence of the landmarks used: {percent} %").format(percent=number(100 * sure, 0))
    doubts = (unsure if sure < CERTAIN else "", render(after.note))
    return values, text, "\n".join(each for each in doubts if each)


def _free(name: str, taken: Collection[str]) -> str:
    """Return a name that is not taken, with a number if need be."""
    numbered = (f"{name[: LONGEST_NAME - 4]} {count}" for count in range(2, 1000))
    return name if name not in taken else next(each for each in numbered if each not in taken)


@dataclass(frozen=True)
class Draft:
    """A measure that is being made: as long as no place is chosen for an end, that is empty.

    A girth lies ``level`` [mm] above the landmark ``at``, or above the lowest point of the scan if that is
    empty. An empty ``name`` leaves it to Busk.
    """

    name: str = ""
    kind: str = "straight"
    ends: tuple[str, str] = ("", "")
    at: str = ""
    level: float = 0.0

    def picked(self, mark: str) -> Draft:
        """Return it with a landmark that was clicked: the next end, or given up if it was one already."""
        if self.kind == "girth":
            return replace(self, at=mark, level=self.level if self.at else 0.0)
        start, end = self.ends
        if mark in self.ends:
            return replace(self, ends=("" if start == mark else start, "" if end == mark else end))
        return replace(self, ends=(mark, end) if not start else (start, mark))

    def stepped_back(self) -> Draft:
        """Return it without the landmark that was chosen last."""
        if self.kind == "girth":
            return replace(self, at="", level=0.0)
        start, end = self.ends
        return replace(self, ends=(start, "") if end else ("", ""))

    @property
    def marks(self) -> tuple[str, ...]:
        """Return the landmarks it is taken at so far."""
        return tuple(mark for mark in ((self.at,) if self.kind == "girth" else self.ends) if mark)
