"""Cure: a change of a design that was run, and what remains to be checked with it."""

from __future__ import annotations

from dataclasses import dataclass

from core.analysis.diagnosis.candidate_changes import Change
from core.analysis.diagnosis.trial_run import TrialResult
from core.garment.assessment import GOOD, LEVELS, Finding, assess

FIXABLE = ("convergence", "shape", "band", "pressure")
"""Topics of findings that a change of lines or model can end."""


@dataclass(frozen=True, eq=False)
class Fix:
    """A change, and how the design stands with it: run from rest, and on from where it was.

    ``remaining_problem`` is the worse of what is wrong with the run then, empty if nothing is; ``remains``
    are all findings on the changed design that a change can end, the worst first. Of a change that is two,
    ``option_result`` is what would be wrong without the other choice, ``lengths_result`` without the lengths.
    """

    change: Change
    trial: TrialResult
    ends: bool
    remaining_problem: str = ""
    option_result: str = ""
    lengths_result: str = ""
    remains: tuple[Finding, ...] = ()

    @property
    def level(self) -> str:
        """The level of what remains."""
        return self.remains[0].level if self.remains else GOOD

    @property
    def rank(self) -> tuple[int, int, float]:
        """How it compares to other changes, the best first: what remains, how many changes, how large [%]."""
        change = self.change
        of_lines = {"together": max(len(change.lines), 2), "off": 2, "length": 1, "width": 1, "gain": 1}.get(
            change.kind, 0
        )
        return LEVELS.index(self.level), of_lines + bool(change.setting[0]), change.size


def fixable_findings(standing: TrialResult) -> tuple[Finding, ...]:
    """Return what is found on a design that was run and that a change of it can end, the worst first."""
    found = (each for each in assess(standing).findings if each.topic in FIXABLE)
    # No length, width or choice makes a pressure known.
    return tuple(each for each in found if each.topic != "pressure" or each.value)
