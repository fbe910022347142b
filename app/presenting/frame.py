"""What the window says about a design and its frame: plain values for the panels, worked out in one place."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from app.panels.result import MeasureView
from app.presenting.lines import band_width, line_colours, line_title
from app.seeing.bands import Band
from app.seeing.ribbon import NO_BACK
from app.showing.verdict_chip import state_title
from app.wording.words import number, say, tr
from core.design import Design
from core.doubts import ESSENTIAL, weak_sides
from core.lines import Line
from core.live import Frame
from core.pipeline import Stages
from core.report import blamed_line, warnings


@dataclass(frozen=True)
class _Drawn:
    """How a line is drawn; as long as all are the same, nothing has to be laid on the body anew."""

    name: str
    path: tuple[int, ...]
    colour: str
    width: float


def drawn(stages: Stages) -> tuple[_Drawn, ...]:
    """Return how the lines of a body are drawn, in the order of the list."""
    paths, design = {line.name: line.path for line in stages.model.lines}, stages.design
    return tuple(
        _Drawn(name, tuple(paths[name].tolist()), colour, band_width(name, design))
        for name, colour in line_colours(paths, design).items()
    )


def bands(stages: Stages, hidden: Collection[str]) -> list[Band]:
    """Return what is drawn of the lines that are not ``hidden``.

    Those with a back are drawn as whole bands; the others end where they end.
    """
    rest, backs = stages.control.mesh.vertices, stages.backs
    return [
        Band(
            line.name,
            rest[list(line.path)],
            line.colour,
            line.width,
            backs[line.name].path if line.name in backs else NO_BACK,
        )
        for line in drawn(stages)
        if line.name not in hidden
    ]


def band_label(design: Design, frame: Frame, name: str) -> tuple[str, str]:
    """Return what stands beside a line on the body: its name and length, and how much shorter that is."""
    line = next(line for line in frame.stages.model.lines if line.name == name)
    title = line_title(name, design)
    if not line.constrains:
        return title, f"{number(line.rest_length)} mm"
    ratio = design.ratio(name)
    change = (ratio - 1.0) * line.rest_length
    return f"{title} {number(100.0 * ratio)} %", f"{number(change, 1, signed=True)} mm"


@dataclass(frozen=True)
class StripVerdict:
    """What the strip says of a run."""

    state: str
    numbers: list[tuple[str, str]]
    hint: str
    pace: str
    settling: bool


def strip_verdict(frame: Frame) -> StripVerdict:
    """Return how the run of a frame stands, with the figures that matter then."""
    verdict = frame.verdict
    return StripVerdict(
        verdict.state,
        _headline(frame),
        _hint(frame),
        _pace(frame),
        verdict.motion == "settling",
    )


def _pace(frame: Frame) -> str:
    """Return what it took: turns, or Newton's steps to the exact answer, and seconds."""
    exact = frame.stages.design.volume == "exact"
    text = tr("{turns} Newton steps · {seconds} s") if exact else tr("{turns} turns · {seconds} s")
    return text.format(turns=number(frame.verdict.turns, 0), seconds=number(frame.seconds))


def kept_volume(frame: Frame) -> tuple[float, float]:
    """Return how far the volume that is kept is from the one at rest, of that of the control mesh [%, ml].

    It is the body's own where the exact answer keeps that, else that of the control mesh.
    """
    design = frame.stages.design
    own = design.dense_volume and design.volume == "exact"
    error = frame.stages.moving.volume_change(frame.points) / 1000.0 if own else frame.error_ml
    return 1e5 * error / frame.stages.model.volume.rest_volume, error


def _headline(frame: Frame) -> list[tuple[str, str]]:
    verdict = frame.verdict
    lift = frame.marks.apex_z - frame.stages.rest_marks.apex_z
    if verdict.state == "vibrating":
        percent = f"{number(100.0 * verdict.error, 2)} ± {number(100.0 * verdict.amplitude, 2)} %"
        return [
            (tr("Period"), tr("{turns} turns").format(turns=number(verdict.period, 0))),
            (tr("Volume error"), percent),
            (tr("Growth per turn"), f"{number(100.0 * (verdict.growth - 1.0), 1, signed=True)} %"),
        ]
    if verdict.state == "diverging":
        return []  # the figures would be those of the body shown, as it was before
    error, ml = kept_volume(frame)
    kept = (tr("Volume error"), f"{number(error, 2, signed=True)} % · {number(ml, 1, signed=True)} ml")
    if verdict.condition and verdict.state == "folded":
        return [kept, (tr("Turned skin"), f"{number(verdict.condition.largest_turn, 0)}°")]
    if verdict.condition and verdict.state == "overstrained":
        low, high = (number(100.0 * r, 0) for r in (verdict.condition.shortest, verdict.condition.longest))
        return [kept, (tr("Strained skin"), tr("{low} to {high} %").format(low=low, high=high))]
    return [kept, (tr("Lift of apex"), f"{number(lift, 1, signed=True)} mm")]


def _hint(frame: Frame) -> str:
    """Return what to do about a shape that is no body any more."""
    what = {
        "folded": tr("The skin folds over: this is no body any more."),
        "overstrained": tr("The skin strains by more than 30 %: hardly a body."),
    }.get(frame.verdict.state, "")
    if frame.verdict.state == "diverging":
        return tr("The turns run away: the body is shown as it was before. Lengthen or soften the lines.")
    if frame.verdict.state == "settled":
        if any(weak_sides(frame.stages.landmarks, kind) for kind in ESSENTIAL):
            return tr("It rests on landmarks that want a look: see the Landmarks step.")
        return "".join(map(say, warnings(frame.stages)[:1]))  # the others stand in the notice
    line = blamed_line(frame.stages)
    if not what or line is None:
        return what
    wish = tr("Set {line} longer.") if line.ratio < 1.0 else tr("Set {line} shorter.")
    return f"{what} {wish.format(line=line_title(line.name, frame.stages.design))}"


def measure_views(frame: Frame) -> list[MeasureView]:
    """Return the table of what changed."""
    rest, now = frame.stages.rest_marks, frame.marks
    volume = frame.stages.model.volume.rest_volume / 1000.0
    # The body has no volume of its own there: what its skin gains is counted from the same rest volume.
    skin = frame.stages.moving.volume_change(frame.points) / 1000.0
    rows: Sequence[tuple[str, str, float, float]] = (
        (tr("Apex height"), "mm", rest.apex_z, now.apex_z),
        (tr("Apex protrusion"), "mm", rest.apex_protrusion, now.apex_protrusion),
        (tr("Bust point left, height"), "mm", rest.nipple_left_z, now.nipple_left_z),
        (tr("Bust point right, height"), "mm", rest.nipple_right_z, now.nipple_right_z),
        (tr("Volume of control mesh"), "ml", volume, volume + frame.error_ml),
        (tr("Volume on the skin"), "ml", volume, volume + skin),
        *(
            (_measured_part(line, frame.stages.design), "mm", line.rest_length, reached)
            for line, reached in zip(frame.stages.model.lines, frame.lengths.values(), strict=True)
        ),
    )
    return [MeasureView(*row) for row in rows]


def _measured_part(line: Line, design: Design) -> str:
    title = line_title(line.name, design)
    return tr("{line}, front part").format(line=title) if line.back_length else title


def facts(frame: Frame) -> list[str]:
    """Return the plain facts of the status bar."""
    return [
        "mm",
        tr("{count} triangles").format(count=number(len(frame.stages.body.mesh.faces), 0)),
        tr("control mesh of {count} polygons").format(count=len(frame.stages.control.mesh.faces)),
        state_title(frame.verdict.state),
    ]
