"""Format the overall verdict: its headline and reasons, the same in window, report and command line."""

from __future__ import annotations

from dataclasses import dataclass

from app.i18n.catalog import colon, joined, tr
from app.presenters.messages import render
from core.document.design import Design
from core.garment.assessment import BAD, CAUTION, GOOD, PENDING, Assessment

IDLE = "idle"
"""The level of a design without an active line, as long as nothing else is wrong: there is no result yet."""


@dataclass(frozen=True)
class AssessmentView:
    """An overall verdict: ``level`` is IDLE or one of ``LEVELS``, ``headline`` its words.

    ``reasons`` are ranked, the worst first: what is wrong, and what to do, which may be empty.
    ``waiting`` names what is being computed, or is empty.
    """

    level: str
    headline: str
    reasons: tuple[tuple[str, str], ...] = ()
    waiting: str = ""

    @property
    def first(self) -> str:
        """Return the current computation, else the first reason with its fix."""
        return self.waiting or (joined(self.reasons[0]) if self.reasons else "")


def headline(level: str) -> str:
    """Return the words for a level."""
    return {
        GOOD: tr("No problems found"),
        PENDING: tr("Computing…"),
        CAUTION: tr("Check before use"),
        BAD: tr("Do not use"),
        IDLE: tr("No active lines"),
    }[level]


def tone(level: str) -> str:
    """Return the tone of a notice about a design of a level."""
    return {GOOD: "ok", CAUTION: "warn", BAD: "bad"}.get(level, "info")


def assessment_view(assessment: Assessment, design: Design | None = None) -> AssessmentView:
    """Return an assessment in words, with lines as they are called in a ``design``, if it is known."""
    level = IDLE if assessment.level == GOOD and not assessment.active else assessment.level
    reasons = tuple((render(each.message, design), render(each.action)) for each in assessment.findings)
    waiting = {"convergence": tr("Converging…"), "pressure": tr("Computing contact pressure…")}
    return AssessmentView(
        level, headline(level), reasons, waiting.get(assessment.pending, "") if level == PENDING else ""
    )


def assessment_lines(assessment: Assessment, design: Design) -> list[str]:
    """Return an assessment as lines of plain text: the headline, then each reason with what to do."""
    view = assessment_view(assessment, design)
    return [
        f"{tr('Verdict')}{colon()}{view.headline}",
        *(f"  {joined(reason)}" for reason in view.reasons),
    ]
