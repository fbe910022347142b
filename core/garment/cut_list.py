"""The cut list: from the lengths that lines reach on the body to lengths of elastic to cut."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from core.control_mesh.path_snapping import max_deviation
from core.document.design import Design
from core.document.elastic import Elastic
from core.garment.tension import LineTension, line_tensions, mean_elongation
from core.geometry.mesh import Points
from core.geometry.plane_sections import arc_length
from core.mechanics.constraint_lines import Line
from core.mechanics.force_units import newtons_per_unit
from core.messages import EMPTY, ElasticName, Length, LineName, Message, join, length_of, plain
from core.pipeline.stages import RegionStages
from core.pipeline.warnings import ShownState

FAR = 0.8
"""The part of its table beyond which an elastic is stretched further than usual [1]: an estimate."""

UNEVEN = 0.1
"""A tension that differs by more than this along a line is told [1]."""

SLACK = join(
    (
        Message("Slack: the band is longer than its path on the body and has no tension."),
        Message("Shorten or deactivate the line."),
    )
)
"""What is said of a line without tension that the model would have push."""

UNCHOSEN = Message("No elastic selected: choose one to compute the cut length.")
"""What is said of a line that is made of nothing in particular."""

SEWN_ON = 3.0
"""A line that ends nearer than this to a band is sewn to it [mm]."""

FRONT_ONLY = Message(
    "Front part only, up to the edge of the control mesh: the part over shoulder or back is not included."
)
"""What is said of a line that ends where the control mesh does."""


@dataclass(frozen=True)
class CutRow:
    """One piece to cut, or why there is none yet.

    ``reached_front_mm`` is the front part as it is worn, ``reached_whole_mm`` the whole closed band, or the
    same for an open line. ``cut_mm`` is the front as it is set, the back / (1 + ``elongation``), and
    ``allowance_mm``; a slack piece is not stretched, and is cut to the length that is set. None stands for
    what is not known, an empty ``elastic`` for a line that is made of nothing in particular. ``notes`` are
    sentences. ``front_only`` tells of an open
    line that ends where the control mesh does, as straps do: its lengths are those of the part that is
    modelled, and no whole piece can be cut to them. ``far`` tells of an elastic that is stretched nearly to
    the end of its table, ``refused`` why none can be cut to this length. A ``slack`` line has no tension;
    ``push_n`` is what it would have to push with to hold the shape. ``height_mm`` is how high the middle of
    its front part is over the bust points. ``parts`` are the lines below the bust that are of the same band.
    """

    line: str
    title: str
    elastic: str
    width_mm: float | None
    closed: bool
    reached_front_mm: float
    reached_whole_mm: float
    elongation: float | None = None
    tension_n: float | None = None
    allowance_mm: float | None = None
    cut_mm: float | None = None
    estimate: bool = True
    notes: tuple[Message, ...] = ()
    front_only: bool = False
    far: bool = False
    slack: bool = False
    push_n: float = 0.0
    refused: Message = EMPTY
    height_mm: float | None = None
    parts: tuple[str, ...] = ()


@dataclass(frozen=True)
class CutList:
    """All pieces in the order of the lines; ``notes`` say what holds for all of them.

    ``newtons_per_unit`` [N/mm] is one unit of the model's stiffness on tissue of ``tissue_stiffness`` [N/m].
    """

    rows: tuple[CutRow, ...]
    tissue_stiffness: float
    newtons_per_unit: float
    notes: tuple[Message, ...]

    def as_data(self) -> dict[str, Any]:
        """Return the list ready for JSON."""
        data: dict[str, Any] = plain(self)
        return data


def cut_list_of(shown: ShownState) -> CutList:
    """Compute the cut list of the active lines of all regions of a body as it is shown.

    Raises LineError for control points that are not a valid shape.
    """
    lists = [cut_list(*each) for each in zip(shown.stages.regions, shown.region_points, strict=True)]
    rows = _joined(shown.stages.design, [row for each in lists for row in each.rows])
    notes = tuple(dict.fromkeys(note for each in lists if each.rows for note in each.notes))
    return replace(lists[0], rows=rows, notes=notes or lists[0].notes)


def _joined(design: Design, rows: list[CutRow]) -> tuple[CutRow, ...]:
    """Return the rows with one for each band over both regions, if both parts are of one elastic."""
    by_line = {row.line: row for row in rows}
    bands = [[by_line[name] for name in design.band_of(row.line) if name in by_line] for row in rows]
    whole = {
        band[0].line: _band(*band) for band in bands if len(band) == 2 and band[0].elastic == band[1].elastic
    }
    parts = {name for upper in whole for name in design.band_of(upper)[1:]}
    return tuple(whole.get(row.line, row) for row in rows if row.line not in parts)


def _band(upper: CutRow, lower: CutRow) -> CutRow:
    """Return the row of a band from those of its parts, between which nothing is sewn."""
    reached = upper.reached_front_mm + lower.reached_front_mm
    note = Message(
        "One band: {upper} above and {lower} below the under-bust.",
        upper=Length(upper.reached_front_mm),
        lower=Length(lower.reached_front_mm),
    )
    band = replace(
        upper,
        reached_front_mm=reached,
        reached_whole_mm=upper.reached_whole_mm + lower.reached_whole_mm,
        notes=tuple(dict.fromkeys((note, *upper.notes, *lower.notes))),
        front_only=upper.front_only or lower.front_only,
        far=upper.far or lower.far,
        slack=upper.slack or lower.slack,
        push_n=max(upper.push_n, lower.push_n),
        refused=upper.refused or lower.refused,
        elongation=None,
        cut_mm=None,
        parts=(lower.line,),
    )
    if upper.tension_n is not None and lower.tension_n is not None:
        pulls = upper.tension_n * upper.reached_front_mm + lower.tension_n * lower.reached_front_mm
        band = replace(band, tension_n=pulls / reached)
    if upper.cut_mm is None or lower.cut_mm is None:
        return band
    allowance = upper.allowance_mm or 0.0
    cut = upper.cut_mm + lower.cut_mm - allowance
    return replace(band, cut_mm=cut, elongation=max(reached / (cut - allowance) - 1.0, 0.0))


def cut_list(stages: RegionStages, control_points: Points) -> CutList:
    """Compute the cut list of the active lines at ``control_points``, shape (n, 3) [mm].

    Raises LineError for control points that are not a valid shape.
    """
    design = stages.design
    tensions = line_tensions(stages, control_points)
    bust = stages.bust_height(control_points)
    rows = tuple(
        replace(
            _row(stages, line, line.length(control_points), tensions),
            height_mm=_middle(line.places(control_points)) - bust,
        )
        for line in stages.model.lines
        if line.name in design.active_lines()
    )
    unit = newtons_per_unit(stages.model, design.tissue_stiffness)
    return CutList(rows, design.tissue_stiffness, unit, (*_of_newtons(design, rows), *_notes(rows)))


def _middle(places: Points) -> float:
    """Return the height of the middle of a path, shape (k, 3) [mm]."""
    along = arc_length(places)
    return float(np.interp(0.5 * along[-1], along, places[:, 2]))


def _row(stages: RegionStages, line: Line, reached: float, tensions: Mapping[str, LineTension]) -> CutRow:
    design = stages.design
    traits, elastic = design.line_settings(line.name), design.active_elastics().get(line.name)
    row = CutRow(
        line.name,
        traits.title or line.name,
        elastic.name if elastic else "",
        elastic.width_mm if elastic else traits.width,
        line.back_length > 0.0 or line.closed,
        reached,
        reached + line.back_length,
    )
    tail = stages.tails.get(line.name)
    if tail is not None and tail.length > 0.0:
        row = _noted(
            row,
            Message(
                "From the lower end of the line over the shoulder to the under-bust band at the "
                "back; {mm} of the length is on the fixed part of the body.",
                mm=Length(tail.length),
            ),
        )
    elif goes_on(stages, line):
        why = (tail.problem,) if tail is not None and tail.problem else ()
        row = replace(row, front_only=True, notes=(*why, FRONT_ONLY))
    tension = tensions.get(line.name)
    if tension is not None:
        slack = tension.compression > 0.0
        notes = (*row.notes, *([SLACK] if slack else _uneven(tension)))
        row = replace(row, tension_n=tension.tension, slack=slack, push_n=tension.compression, notes=notes)
    if elastic is None:
        return _noted(row, UNCHOSEN)
    if design.line_hold == "held":
        return _held(row, elastic)
    natural = design.ratio(line.name) * line.rest_length
    elongation = mean_elongation(stages, elastic, tension, reached / natural - 1.0)
    return _stretched(row, elastic, natural, elongation, elastic.force(elongation))


def goes_on(stages: RegionStages, line: Line) -> bool:
    """Return whether an open line has an end where nothing moves any more, and no band to be sewn to.

    A strap that is led over the shoulder has a band at the back.
    """
    if line.back_length > 0.0 or line.closed or line.tail_length > 0.0:
        return False
    rest, fixed = stages.control.mesh.vertices, line.weights @ stages.control.held > 1.0 - 1e-9
    bands = [each.places(rest)[1:-1] for each in stages.model.lines if each.back_length > 0.0]
    ends = line.places(rest)[[0, -1]]
    sewn = [any(max_deviation(end[None], band) < SEWN_ON for band in bands) for end in ends]
    if (joint := _joint(stages.design, line.name, ends)) is not None:
        sewn[joint] = True
    return any(held and not sewed for held, sewed in zip(fixed[[0, -1]], sewn, strict=True))


def _joint(design: Design, name: str, ends: Points) -> int | None:
    """Return at which of its ``ends`` (2, 3) [mm] a line runs on in the other region, if it does."""
    own = next((line for line in design.own_lines if line.name == name), None)
    if own is not None and own.continues:
        return int(ends[:, 2].argmax())
    return int(ends[:, 2].argmin()) if len(design.band_of(name)) > 1 else None


def is_strap(stages: RegionStages, line: Line) -> bool:
    """Return whether a line goes on over the shoulder, or would if the body were modelled there."""
    return line.tail_length > 0.0 or goes_on(stages, line)


def _held(row: CutRow, elastic: Elastic) -> CutRow:
    """Return the row of a line whose length is held: its tension tells how far its elastic is stretched."""
    if row.tension_n is None:
        return _noted(
            row,
            Message("Tension of a line on fixed points is unknown: make lines elastic to compute it."),
        )
    if row.tension_n > elastic.max_force:
        return _refused(row, elastic.overload_error(row.tension_n, LineName(row.line, row.title)).text)
    if row.slack:
        return row
    elongation = elastic.elongation(row.tension_n)
    return _stretched(row, elastic, row.reached_front_mm / (1.0 + elongation), elongation, row.tension_n)


def _stretched(row: CutRow, elastic: Elastic, front: float, elongation: float, tension: float) -> CutRow:
    """Return the row with what is cut: ``front`` [mm] unstretched, and its back stretched as it is."""
    if elongation > elastic.max_elongation:
        return _refused(row, elastic.overstretch_error(elongation, LineName(row.line, row.title)).text)
    row = replace(
        row,
        elongation=max(elongation, 0.0),
        tension_n=tension,
        allowance_mm=elastic.allowance_mm,
        cut_mm=front
        + (row.reached_whole_mm - row.reached_front_mm) / (1.0 + elongation)
        + elastic.allowance_mm,
        estimate=elastic.estimate,
    )
    if elongation < 0.0:
        return row if row.slack else _noted(replace(row, slack=True), SLACK)
    if elongation <= FAR * elastic.max_elongation:
        return row
    end = 100.0 * elastic.max_elongation
    note = Message(
        "High elongation (the table ends at {end} %): 30 to 50 % is usual (estimate).", end=f"{end:g}"
    )
    return _noted(replace(row, far=True), note)


def _refused(row: CutRow, why: Message) -> CutRow:
    return replace(_noted(row, why), refused=why)


def _noted(row: CutRow, note: Message) -> CutRow:
    return replace(row, notes=(*row.notes, note))


def _uneven(tension: LineTension) -> tuple[Message, ...]:
    low, high = max(float(tension.segments.min()), 0.0), max(float(tension.segments.max()), 0.0)
    if high - low <= UNEVEN * abs(tension.mean):
        return ()
    return (
        Message(
            "The tension varies from {low} to {high} N along the line.", low=f"{low:.1f}", high=f"{high:.1f}"
        ),
    )


def _of_newtons(design: Design, rows: tuple[CutRow, ...]) -> Iterator[Message]:
    """Yield what the newtons of the list rest on."""
    if design.tissue == "net":
        yield Message(
            "Forces in N are estimates: skin and tissue stiffness is assumed to be {tissue} N "
            "per m of width and unit strain; measured values of skin alone are about 160 to 1150.",
            tissue=f"{design.tissue_stiffness:.0f}",
        )
    elif any(not row.elastic and row.tension_n is not None for row in rows):
        yield Message(
            "Forces in N of lines without an elastic are estimates: they depend on the softness of "
            "the tissue, a sag of {sag}.",
            sag=Length(design.sag, 0),
        )


def _notes(rows: tuple[CutRow, ...]) -> tuple[Message, ...]:
    """Return in sentences what holds for the whole list."""
    notes = []
    guessed = sorted({row.elastic for row in rows if row.elastic and row.estimate and row.cut_mm})
    if guessed:
        notes.append(
            Message(
                "The force of {elastics} is an estimate: measure your own material before cutting.",
                elastics=tuple(map(ElasticName, guessed)),
            )
        )
    if any(row.closed and row.cut_mm for row in rows):
        notes.append(Message("The back of a band is assumed to have the same elongation as its front."))
        notes.append(
            Message("Lengths follow the line, which may not be horizontal: a girth measured by tape differs.")
        )
    allowances = {row.allowance_mm for row in rows if row.cut_mm}
    if len(allowances) == 1:
        notes.append(
            Message(
                "Each cut length includes {allowance} seam allowance; hooks and eyes, rings and "
                "slides are not deducted.",
                allowance=length_of(allowances.pop() or 0.0),
            )
        )
    elif allowances:
        notes.append(
            Message(
                "Cut lengths include the seam allowance; hooks and eyes, rings and slides are not deducted."
            )
        )
    return tuple(notes)
