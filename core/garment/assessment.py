"""Assessment: one overall verdict on a solved design, the worst of all that was checked (ours).

Checked are convergence and shape of the run, contact pressure, bands that cannot do what they are set to or
enlarge the hips, scan, landmarks and the fit of the control mesh.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from core.garment.cut_list import CutList, CutRow, cut_list_of
from core.garment.pressure import AMBER, GREEN, pressure_limits
from core.garment.pressure_list import PressureList, PressureRow, pressure_list_of
from core.landmarks.warnings import collect_warnings
from core.measurements.lower_trunk import lower_before_after
from core.mechanics.convergence import Convergence
from core.messages import EMPTY, Length, LineName, Message, join, plain
from core.pipeline.build import Stages
from core.pipeline.warnings import ShownState, warnings

GOOD, PENDING, CAUTION, BAD = LEVELS = ("good", "pending", "caution", "bad")
"""Levels from the best to the worst; one that is still being computed is better than none that is known."""

TOPICS = ("convergence", "shape", "band", "pressure", "fit", "landmarks")
"""What is checked, in the order in which findings of one level are ranked."""

PUSHES = 0.5
"""A line that would have to push with more than this carries part of the shape [N]; an estimate."""

HIP_BANDS, GROWS = ("high-hip", "hip", "under-hip"), 5.0
"""Closed bands that are to reduce the hips, and what the largest hip girth may grow by under them [mm]."""

FIT_LIMITS = (20.0, 10.0, 20.0)
"""Largest and 95 % deviation of the skin from the control mesh, and of its fold row from the landmark of the
fold, beyond which a fit is doubtful [mm]; ours.
"""


@dataclass(frozen=True)
class Finding:
    """One reason for an assessment.

    ``topic`` is one of TOPICS, ``level`` CAUTION or BAD. ``message`` states in a sentence what is wrong,
    ``action`` what to do, empty where the message includes it. ``lines`` are the lines concerned,
    ``value`` the pressure [kPa] of one on that, the elongation [1] of an elastic that is stretched far, 0
    where neither is known.
    """

    topic: str
    level: str
    message: Message
    action: Message = EMPTY
    lines: tuple[str, ...] = ()
    value: float = 0.0

    @property
    def is_unwearable(self) -> bool:
        """Return whether it is a pressure above all that were measured under garments."""
        return self.topic == "pressure" and self.value >= pressure_limits().beyond[-1][0]


UNKNOWN_PRESSURE = Finding(
    *("pressure", CAUTION, Message("The contact pressure was not computed.")),
    Message("Change a line length to start the computation."),
)


@dataclass(frozen=True)
class Assessment:
    """The overall verdict: ``findings`` are ranked, the worst first.

    ``pending`` names what is not known yet, "convergence" or "pressure", or is empty. ``active`` tells
    whether anything reshapes the body.
    """

    findings: tuple[Finding, ...]
    pending: str = ""
    active: bool = True

    @property
    def level(self) -> str:
        """Return the worst level: one of LEVELS."""
        worst = self.findings[0].level if self.findings else GOOD
        return PENDING if self.pending and worst != BAD else worst

    def as_data(self) -> dict[str, Any]:
        """Return the assessment ready for JSON."""
        return {"level": self.level, "findings": plain(self.findings)}


def assess(shown: ShownState) -> Assessment:
    """Return the assessment of a run that has ended; cut list and pressures are computed for it."""
    if not shown.verdict.is_valid:
        return assess_with(shown, None, None)
    return assess_with(shown, cut_list_of(shown), pressure_list_of(shown))


def assess_with(
    shown: ShownState,
    cuts: CutList | None,
    pressed: PressureList | None,
    *,
    running: bool = False,
    failed: bool = False,
) -> Assessment:
    """Return the assessment of a run, with its cut list and pressures as far as they are known.

    While it is ``running`` it may still converge; ``failed``: computing its pressures did, and they stay
    unknown. A run without a valid shape has neither.
    """
    stages, verdict, active = shown.stages, shown.verdict, not shown.stages.design.is_bare
    found = [*_run(shown, running), *_foundations(stages)]
    if verdict.is_valid:
        found += [*_bands(cuts), *(_growth(shown) if pressed is not None and not running else ())]
        found += [*([UNKNOWN_PRESSURE] if failed else _pressures(pressed))]
    ranked = sorted(found, key=lambda each: (-LEVELS.index(each.level), TOPICS.index(each.topic)))
    awaited = active and verdict.is_valid and pressed is None and not failed
    pending = "convergence" if running else "pressure" if awaited else ""
    return Assessment(tuple(ranked), pending, active)


def _run(shown: ShownState, running: bool) -> Iterator[Finding]:
    """Yield what is wrong with the run and its shape."""
    verdict = shown.verdict
    if verdict.motion == "diverging":
        yield Finding(
            *("convergence", BAD, Message("The solver diverged: there is no valid shape.")),
            Message("Make the lines longer or softer."),
        )
    elif verdict.motion == "vibrating":
        below = shown.bust_verdict.motion != "vibrating"
        message = (
            Message("The solver does not converge: waist and hips oscillate.")
            if below
            else Message("The solver does not converge: it oscillates.")
        )
        yield Finding("convergence", BAD, message, Message("Use “Diagnose design” to find fixes."))
    elif verdict.motion == "settling" and not running:
        yield Finding(
            "convergence",
            BAD,
            Message("The solver has not converged."),
            Message("Use “Diagnose design” to find fixes."),
        )
    if verdict.motion not in ("diverging", "vibrating"):
        yield from _shape(verdict)


def _shape(verdict: Convergence) -> Iterator[Finding]:
    condition, action = verdict.condition, Message("Use “Diagnose design” to find fixes.")
    if condition is None:
        return
    ends = (100.0 * (each - 1.0) for each in (condition.shortest, condition.longest))
    low, high = (f"{each:+.0f}".replace("-", "\N{MINUS SIGN}") for each in ends)
    if condition.folded:
        yield Finding("shape", BAD, Message("The mesh is folded: this shape is not valid."), action)
    elif condition.overstrained:
        message = Message(
            "Skin is compressed or stretched by over 30 % ({low} to {high} %).", low=low, high=high
        )
        yield Finding("shape", BAD, message, action)
    elif condition.strained:
        message = Message(
            "Skin is compressed or stretched by over 20 % ({low} to {high} %).", low=low, high=high
        )
        yield Finding("shape", CAUTION, message, action)


def _bands(cuts: CutList | None) -> Iterator[Finding]:
    """Yield lines whose band cannot do what it is set to."""
    for row in cuts.rows if cuts is not None else ():
        if row.refused:
            yield Finding("band", BAD, row.refused, lines=(row.line,))
        if row.slack:
            yield _slack(row)
        elif row.far and row.elongation is not None:
            message = Message(
                "The elongation of {line} is high ({percent} %).",
                line=LineName(row.line, row.title),
                percent=f"{100.0 * row.elongation:.0f}",
            )
            action = Message("Increase the cut length, or choose another elastic.")
            yield Finding("band", CAUTION, message, action, (row.line,), row.elongation)


def _growth(shown: ShownState) -> Iterator[Finding]:
    """Yield that the largest hip girth grows although closed bands reduce the hips."""
    lower = shown.stages.lower
    if lower is None:
        return
    bands = [line.name for line in lower.design.lines if line.name in HIP_BANDS and line.ratio < 1.0]
    girths = lower_before_after(lower, shown.region_points[1]) if bands else {}
    if "hip" not in girths:
        return
    before, after = girths["hip"]
    grown = after.tape_mm - before.tape_mm
    if grown > GROWS:
        message = Message("The largest hip girth grows by {mm} beside the bands.", mm=Length(grown))
        action = Message("Add or shorten a band at its height, such as Under hip.")
        yield Finding("band", CAUTION, message, action, tuple(bands))


def _slack(row: CutRow) -> Finding:
    level = BAD if row.push_n > PUSHES else CAUTION
    message = Message("{line} is slack (no tension).", line=LineName(row.line, row.title))
    if row.push_n:
        message = Message(
            "{line} is slack: the computed force is a compression of {newtons} N, which a band cannot carry.",
            line=LineName(row.line, row.title),
            newtons=f"{row.push_n:.1f}",
        )
    return Finding("band", level, message, Message("Shorten or deactivate the line."), (row.line,))


def _pressures(pressed: PressureList | None) -> Iterator[Finding]:
    """Yield lines and cups that press more than the green light allows, the hardest first, and unknown."""
    rows = [row for row in pressed.rows if row.light != GREEN] if pressed is not None else []
    for row in sorted(rows, key=lambda row: -(row.max_kpa or 0.0)):
        yield _pressure(row)


def _pressure(row: PressureRow) -> Finding:
    if row.max_kpa is None:
        message = Message("The contact pressure of {line} is unknown.", line=LineName(row.line, row.title))
        return Finding("pressure", CAUTION, message, join(row.notes), (row.line,))
    kpa, mmhg = row.max_kpa or 0.0, row.max_mmhg or 0.0
    message = Message(
        "{line}: contact pressure {kpa} kPa ({mmhg} mmHg).",
        line=LineName(row.line, row.title),
        kpa=f"{kpa:.1f}",
        mmhg=f"{mmhg:.0f}",
    )
    if row.light == AMBER:
        action = Message("Test the garment while sitting and breathing in.")
        return Finding("pressure", CAUTION, message, action, (row.line,), kpa)
    found = Finding(
        "pressure", BAD, message, Message("Make the line longer, wider or softer."), (row.line,), kpa
    )
    much = Message("Not wearable: make the line much longer, wider or softer.")
    if row.is_cup:
        found = replace(found, action=Message("Lift the cups less, or make them larger."))
        much = Message("Not wearable: lift the cups much less, or make them much larger.")
    return replace(found, action=much) if found.is_unwearable else found


def _foundations(stages: Stages) -> Iterator[Finding]:
    """Yield what is doubtful about the scan, its landmarks and the control mesh."""
    for sentence in collect_warnings(stages.body, stages.landmarks):
        yield Finding("landmarks", CAUTION, sentence)
    yield from _fit(stages)
    for sentence in warnings(stages):
        yield Finding("fit", CAUTION, sentence)


def _fit(stages: Stages) -> Iterator[Finding]:
    """Yield how far the control mesh is off the body, where that is more than on any body that was tried."""
    quality, action = stages.control.quality, Message("Check the bust points and inframammary folds.")
    if quality is None:
        return
    largest, most, fold = FIT_LIMITS
    if quality.deviation_max > largest or quality.deviation_95 > most:
        message = Message(
            "The control mesh deviates from the skin by up to {mm}.", mm=Length(quality.deviation_max)
        )
        yield Finding("fit", CAUTION, message, action)
    if quality.fold_off > fold:
        message = Message(
            "The fold row of the control mesh deviates from the inframammary fold by {mm}.",
            mm=Length(quality.fold_off),
        )
        yield Finding("fit", CAUTION, message, action)
