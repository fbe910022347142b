"""Compare statements of the paper, and of ours, with the lower trunk: every number is measured here."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from app.research.cases import Study
from app.research.claims import LENGTHS, Claim, agreement, percents
from app.research.lower_cases import LAST, RATIOS, Course, LowerStudy
from core.pipeline.stages import GAIN_SHARE

OURS = "ours"
CALM_PARTS, EXCESSIVE_PARTS = (0.97, 0.99), (1.01, 1.05)
"""Gains just below and just beyond the limit, in parts of it."""

WAISTED = 0.9

SPAN = 60
"""Iterations over which a swing is told to grow or to fade: it is still small at their end."""


def lower_claims(study: Study) -> list[Claim]:
    """Return what holds on waist, hips and seat, which the paper names as a future extension."""
    return [claim(study.lower) for claim in STATEMENTS]


def _excess(lower: LowerStudy) -> Claim:
    motions = {ratio: lower.course(ratio, "conventional", _default(lower, ratio)).motion for ratio in LENGTHS}
    bad = [ratio for ratio, motion in motions.items() if motion in ("vibrating", "diverging")]
    calm = [ratio for ratio in LENGTHS if ratio not in bad]
    return Claim(
        "5",
        "it vibrates or diverges when the line is too short, not when it is a little shorter",
        f"with the default gain the waist line vibrates at {percents(bad)}, not at {percents(calm)}",
        agreement(bool(bad), LENGTHS[0] in calm),
    )


def _default(lower: LowerStudy, ratio: float) -> float:
    """Return the default gain of the conventional control in parts of the limit at a length ratio [1]."""
    return GAIN_SHARE * lower.stages(ratio).gain_limit / lower.gain_limit(ratio)


def _beyond_limit(lower: LowerStudy) -> Claim:
    growth = {
        part: [_growth(lower.course(ratio, "conventional", part)) for ratio in RATIOS]
        for part in (*CALM_PARTS, *EXCESSIVE_PARTS)
    }
    found = ", ".join(
        f"{100 * (min(each, key=lambda one: abs(one - 1.0)) - 1.0):+.1f} % at {part:g}"
        for part, each in growth.items()
    )
    limits = ", ".join(f"{lower.gain_limit(ratio):.3f}" for ratio in RATIOS)
    return Claim(
        OURS,
        "the conventional force vibrates beyond a gain limit that can be computed, and not below it",
        f"limit with the waist line at {percents(RATIOS)}: {limits}; the swing changes per "
        f"iteration by {found} of the limit",
        agreement(
            *(each < 1.0 for part in CALM_PARTS for each in growth[part]),
            *(each > 1.0 for part in EXCESSIVE_PARTS for each in growth[part]),
        ),
    )


def _growth(course: Course) -> float:
    """Return by which factor the swing of a course changes per iteration, after its beginning [1]."""
    first, last = course.swings[SPAN // 2], course.swings[SPAN // 2 + SPAN]
    return float((last / first) ** (1.0 / SPAN))


def _never_without(lower: LowerStudy) -> Claim:
    motions = [lower.course(ratio, "none").motion for ratio in LENGTHS]
    calm = sum(motion in ("settled", "settling") for motion in motions)
    return Claim(
        "5",
        "no vibration if the volume constraint is not applied",
        f"stable at {calm} of {len(LENGTHS)} lengths ({percents(LENGTHS)})",
        agreement(calm == len(LENGTHS)),
    )


def _calm(lower: LowerStudy) -> Claim:
    courses = [lower.course(ratio, "adaptive") for ratio in RATIOS]
    swing = max(float(np.ptp(course.zones[-LAST:], axis=0).max()) for course in courses)
    away = max(float(course.away[-1]) for course in courses)
    return Claim(
        "6, Fig. 7",
        "the adaptive force makes no vibration",
        f"at {percents(RATIOS)} no zone changes by more than {swing:.1g} % of its volume in the last {LAST} "
        f"of {len(courses[0].zones) - 1} iterations, and no control point is further than {away:.1g} mm "
        "from the exact solution",
        agreement(swing < 0.001, away < 0.1),
    )


def _smaller(lower: LowerStudy) -> Claim:
    ends = {
        control: float(np.abs(lower.course(RATIOS[0], control, part).zones[-1]).max())
        for control, part in (("adaptive", 1.0), ("conventional", _default(lower, RATIOS[0])))
    }
    return Claim(
        "6, Fig. 7",
        "the adaptive error is significantly smaller",
        f"line at {100 * RATIOS[0]:.0f} %, the waist zone: {ends['adaptive']:.1g} % of its volume against "
        f"{ends['conventional']:.2g} %",
        agreement(10 * ends["adaptive"] < ends["conventional"]),
    )


def _zones(lower: LowerStudy) -> Claim:
    one, five = (
        float(lower.outward(WAISTED, together=together)[lower.at_seat()].max()) for together in (True, False)
    )
    return Claim(
        OURS,
        "one volume for the whole trunk lets a waist line push out the seat, a volume for each zone does not",
        f"line at {100 * WAISTED:.0f} %, exact, all volume kept: hip and seat move out by up to {one:.1f} mm "
        f"with one volume, {five:.1f} mm with five",
        agreement(one > 1.5, five < 0.5 * one),
    )


STATEMENTS: tuple[Callable[[LowerStudy], Claim], ...] = (
    *(_excess, _beyond_limit, _never_without, _calm, _smaller, _zones),
)
