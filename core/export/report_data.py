"""The sheet to work from: everything of one fitting as plain data, for paper and for tables."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from core import __version__
from core.deformation.tffd import deform
from core.garment.assessment import Assessment, assess_with
from core.garment.cut_list import CutList, cut_list_of
from core.garment.pressure import LEFT_OUT
from core.garment.pressure_list import PressureRow, pressure_list_of
from core.geometry.mesh import Floats, Mesh, Points
from core.geometry.planar_curves import AXES, Curve, Plane, Slicer, nearest
from core.landmarks.warnings import collect_warnings
from core.measurements.definitions import DEFINITIONS
from core.measurements.sizes import GIRTHS_OF_SIZES, sizes, sizes_text, with_neighbours
from core.measurements.table import Measures, before_after, measure_rows
from core.measurements.uncertain_value import BEFORE, SOURCES, OutputUncertainties
from core.mechanics.convergence import SOUND
from core.mechanics.iteration import Observables, Record
from core.messages import EMPTY, Message, plain
from core.pipeline.build import Stages
from core.pipeline.solve import divergence_error
from core.pipeline.warnings import ShownState, controlled_volume, immovable_lines, shape_warnings, warnings
from core.progress import Progress, quiet

AROUND = 12.0
"""What a section shows beside the part that can move [mm]."""

NEAR_LEVEL = 40.0
"""Control points this near to a level tell how wide its section is [mm]."""

NOT_MODELLED = (
    Message(
        "Friction between garment and skin, breathing and movement are not modelled; gravity and posture "
        "only with solid tissue."
    ),
    Message("Only lines and cups shape the body: fabric between them, seams and hooks are not modelled."),
)
"""What no figure of a sheet takes into account."""


@dataclass(frozen=True)
class Heading:
    """What stands over a sheet: whose it is, of what, and the ``date`` as year-month-day.

    ``system`` is the key of the table whose size comes first, ``allowance_mm`` what a tape that is worn tight
    takes off the under-bust.
    """

    project: str
    date: str
    customer: str = ""
    variant: str = ""
    system: str = "jp"
    allowance_mm: float = 0.0


@dataclass(frozen=True)
class Lift:
    """How far the bust points went from where they are at rest [mm]: up and forward, the mean of both too."""

    left_up: float
    right_up: float
    left_forward: float
    right_forward: float
    up: float
    forward: float


@dataclass(frozen=True)
class VolumeKept:
    """The volume inside the reshaped part at rest [ml], and how far it is from that now [ml, %]."""

    rest_ml: float
    error_ml: float
    error_percent: float


Pair = tuple[float, float]
Line2 = tuple[Pair, ...]
"""A flat curve, place by place: across and up [mm], as ``core.geometry.planar_curves.Plane`` has them."""


@dataclass(frozen=True)
class SectionCurves:
    """A cut of the body across ``axis`` at ``at_mm``, before and after; ``box`` is the part that can move.

    ``bust_point`` is where that lies on the cut before, ``bust_point_after`` after; of a level cut the middle
    of both. A side is cut through its bust point, which moves aside: ``after_at_mm`` is where it is after.
    ``off_mm`` is how far the skin may be off at each place of the curves after, ``off_before_mm`` before;
    both are nothing where that was not worked out.
    """

    name: str
    axis: str
    at_mm: float
    after_at_mm: float
    box: tuple[Pair, Pair]
    bust_point: Pair
    bust_point_after: Pair
    before: tuple[Line2, ...]
    after: tuple[Line2, ...]
    off_mm: tuple[tuple[float, ...], ...] = ()
    off_before_mm: float = 0.0


@dataclass(frozen=True)
class IterationCurve:
    """What is plotted of a run, turn by turn: volume error and how far the bust points are up [mm]."""

    control: str
    turn: tuple[int, ...] = ()
    error_percent: tuple[float, ...] = ()
    up_mm: tuple[float, ...] = ()


@dataclass(frozen=True)
class Report:
    """Everything of a report; sentences are those of the core, in English.

    ``state`` is the word of the verdict ("strained" where skin strains though all has settled); ``lift`` is
    None in any state that is not ``SOUND``. ``measures`` are rows of ``measure_rows``,
    ``sizes`` those of ``sizes_text``, the chosen system first, or none and ``no_size`` says why;
    ``pressures`` follow the cut list row by row, those of ``cups`` are apart, ``limits`` are those of their
    lights; ``doubts`` say what should be looked at before landmarks are trusted; ``assessment`` is the
    overall verdict. ``off`` is how far figures may be off, by the keys of ``uncertain_value``, in their
    units: nothing where that was not worked out; see ``with_uncertainty``. ``off_factor`` tells of others how
    many times smaller or larger they may be [1], ``off_notes`` where all of this says less than it seems to,
    ``off_sources`` what any of it comes from. ``strain`` is that of the verdict. ``lower_sections`` are the
    levels of waist and hip, where the design has the lower trunk.
    """

    heading: Heading
    scan: str
    state: str
    settled: bool
    lift: Lift | None
    volume: VolumeKept
    measures: tuple[dict[str, Any], ...]
    sizes: tuple[dict[str, Any], ...]
    no_size: Message
    cuts: CutList
    pressures: tuple[PressureRow, ...]
    cups: tuple[PressureRow, ...]
    limits: Mapping[str, Any]
    sections: tuple[SectionCurves, ...]
    turns: IterationCurve
    doubts: tuple[Message, ...]
    warnings: tuple[Message, ...]
    left_out: tuple[Message, ...]
    model: Mapping[str, Any]
    versions: Mapping[str, str]
    assessment: Assessment
    definitions: tuple[dict[str, Any], ...] = field(
        default_factory=lambda: tuple(map(plain, DEFINITIONS.values()))
    )
    off: Mapping[str, float] = field(default_factory=dict)
    off_factor: Mapping[str, float] = field(default_factory=dict)
    off_notes: tuple[Message, ...] = ()
    off_sources: tuple[str, ...] = ()
    strain: Pair | None = None
    lower_sections: tuple[SectionCurves, ...] = ()

    @property
    def is_valid(self) -> bool:
        """Return whether its figures can be worked with."""
        return self.state in SOUND

    def as_data(self) -> dict[str, Any]:
        """Return the sheet ready for JSON."""
        told = {name: dict(getattr(self, name)) for name in ("limits", "model", "off", "off_factor")}
        return {**plain(self), **told, "assessment": self.assessment.as_data()}


def make_report(
    shown: ShownState, records: Sequence[Record], heading: Heading, progress: Progress = quiet
) -> Report:
    """Return the sheet of a body as it is ``shown``; ``records`` are those of its turns.

    Raises Cancelled, and LineError if the turns ran away: they leave no body.
    """
    stages, points, verdict = shown.stages, shown.region_points, shown.verdict
    if verdict.motion == "diverging":
        raise divergence_error()
    progress("measuring", 0.1)
    before, after = before_after(stages, *points)
    found, why = _sizes(before, heading)
    progress("pressing", 0.8)
    cuts, pressed = cut_list_of(shown), pressure_list_of(shown)
    return Report(
        heading=heading,
        scan=stages.design.scan.name,
        state=verdict.display_state,
        settled=verdict.state == "settled",
        lift=lift_of(stages.rest_marks, stages.watch(points[0])) if verdict.is_valid else None,
        volume=VolumeKept(stages.model.volume.rest_volume / 1000.0, *reversed(controlled_volume(shown))),
        measures=tuple(measure_rows(before, after)),
        sizes=found,
        no_size=why,
        cuts=cuts,
        pressures=tuple(row for row in pressed.rows if not row.is_cup),
        cups=tuple(row for row in pressed.rows if row.is_cup),
        limits=pressed.as_data()["limits"],
        sections=_sections(stages, points[0]),
        turns=_turns(stages, records),
        doubts=tuple(collect_warnings(stages.body, stages.landmarks)),
        warnings=(*shape_warnings(shown), *immovable_lines(stages), *warnings(stages)),
        left_out=(*NOT_MODELLED, *LEFT_OUT),
        model=_model(stages),
        strain=verdict.strain,
        lower_sections=_lower_sections(stages, points),
        assessment=assess_with(shown, cuts, pressed),
        versions={"busk": __version__, "python": platform.python_version(), "numpy": np.__version__},
    )


def with_uncertainty(
    sheet: Report, stages: Stages, control_points: Points, spread: OutputUncertainties
) -> Report:
    """Return a sheet of ``control_points``, shape (n, 3) [mm], with how far its figures may be off."""
    rest, places = stages.body.mesh, deform(stages.binding, control_points)
    sections = []
    for cut in sheet.sections:
        slicer = Slicer(rest, Plane(cut.axis, cut.after_at_mm))
        offs = slicer.interpolate(places, spread.sds * spread.skin)
        rounded = tuple(tuple(np.round(each, 3).tolist()) for each in offs)
        sections.append(replace(cut, off_mm=rounded, off_before_mm=spread.sds * spread.rest))
    off = {key: off for key in spread.by_output if (off := spread.plus_minus(key)) is not None}
    factors = {key: factor for key in spread.by_output if (factor := spread.factor(key)) is not None}
    told = with_neighbours(sheet.sizes, *(off.get(f"{BEFORE}:{key}") for key in GIRTHS_OF_SIZES))
    within = {name for doubt in spread.by_output.values() for name in doubt.by_source}
    sheet = replace(sheet, off=off, off_factor=factors, sections=tuple(sections), sizes=told)
    return replace(sheet, off_notes=spread.cautions, off_sources=tuple(s for s in SOURCES if s in within))


def _sizes(before: Measures, heading: Heading) -> tuple[tuple[dict[str, Any], ...], Message]:
    """Return the sizes of the body at rest, the chosen system first, or none and why."""
    underbust, bust = (before[key] for key in GIRTHS_OF_SIZES)
    if underbust.value is None or bust.value is None:
        return (), underbust.note or bust.note
    answers = sizes(underbust.value, bust.value, heading.allowance_mm)
    keys = sorted(answers, key=lambda key: key != heading.system)
    return tuple(sizes_text(answers[key]) for key in keys), EMPTY


def lift_of(rest: Observables, now: Observables) -> Lift:
    """Return how far the bust points moved from the original body."""
    up = now.bust_point_left_z - rest.bust_point_left_z, now.bust_point_right_z - rest.bust_point_right_z
    forward = (
        now.bust_point_left_out - rest.bust_point_left_out,
        now.bust_point_right_out - rest.bust_point_right_out,
    )
    return Lift(*up, *forward, 0.5 * sum(up), 0.5 * sum(forward))


def _sections(stages: Stages, control_points: Points) -> tuple[SectionCurves, ...]:
    """Return the side through a bust point and the level of the bust."""
    control, marks = stages.control, stages.landmarks.points
    laid = control.mesh.vertices[list(control.bust_points)]  # a side without a breast has these
    both = [marks[name].position for name in ("bust_point_left", "bust_point_right") if name in marks]
    left, middle = (both[0], np.mean(both, axis=0)) if both else (laid[0], laid.mean(axis=0))
    rest, places = stages.body.mesh, deform(stages.binding, control_points)
    free = control.mesh.vertices[~control.fixed]
    vertex = int(np.linalg.norm(rest.vertices - left, axis=1).argmin())
    move = places[vertex] - rest.vertices[vertex]
    found = []
    for name, axis, mark, moved in (("side", "x", left, left + move), ("bust", "z", middle, middle)):
        flat = Plane(axis, 0.0).flat(free)
        box = _pair(flat.min(axis=0) - AROUND), _pair(flat.max(axis=0) + AROUND)
        at, point, before = _cut(rest, rest.vertices, axis, mark)
        after_at, point_after, after = _cut(rest, places, axis, moved)
        found.append(SectionCurves(name, axis, at, after_at, box, point, point_after, before, after))
    return tuple(found)


def _lower_sections(stages: Stages, region_points: Sequence[Points]) -> tuple[SectionCurves, ...]:
    """Return the levels of waist and hip, counted from the middle of their outlines."""
    lower = stages.lower
    if lower is None or len(region_points) < 2:
        return ()
    rest, places = stages.body.mesh, deform(lower.binding, region_points[1])
    points, found = lower.control.mesh.vertices, []
    for name in ("waist", "hip"):
        mark = lower.landmarks.position(name)
        near = points[np.abs(points[:, 2] - mark[2]) < NEAR_LEVEL]
        flat = Plane("z", 0.0).flat(near if len(near) else points)
        low, high = flat.min(axis=0), flat.max(axis=0)
        box, middle = (_pair(low - AROUND), _pair(high + AROUND)), _pair(0.5 * (low + high))
        at, _, before = _cut(rest, rest.vertices, "z", mark)
        _, _, after = _cut(rest, places, "z", mark)
        found.append(SectionCurves(name, "z", at, at, box, middle, middle, before, after))
    return tuple(found)


def _cut(rest: Mesh, places: Points, axis: str, mark: Floats) -> tuple[float, Pair, tuple[Line2, ...]]:
    """Return where a cut through a bust point lies, where that is in it, and its curves.

    The landmark of a side may stand a hair off the skin: what is told lies on it.
    """
    plane = Plane(axis, float(mark[AXES.index(axis)]))
    curves = Slicer(rest, plane).curves(places)
    foot = nearest(curves, plane.flat(mark)) if axis == "x" else None
    return plane.at, _pair(plane.flat(mark) if foot is None else foot.place), tuple(map(_line, curves))


def _line(curve: Curve) -> Line2:
    return tuple(_pair(place) for place in curve.places)


def _pair(place: Floats) -> Pair:
    return round(float(place[0]), 2), round(float(place[1]), 2)


def _turns(stages: Stages, records: Sequence[Record]) -> IterationCurve:
    """Return the turns of a run; Newton's steps to the exact answer are none."""
    rest, made = stages.rest_marks, () if stages.design.volume == "exact" else records
    rows = [(row, row.marks) for row in made if row.marks is not None]
    return IterationCurve(
        stages.design.volume,
        tuple(row.iteration for row, _ in rows),
        tuple(100.0 * row.error for row, _ in rows),
        tuple(lift_of(rest, marks).up for _, marks in rows),
    )


def _model(stages: Stages) -> dict[str, Any]:
    names = (
        "template",
        "volume",
        "line_contact",
        "line_hold",
        "member_law",
        "tissue",
        "sag",
        "tissue_stiffness",
    )
    return {name: getattr(stages.design, name) for name in names}
